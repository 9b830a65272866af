//! What a batch of logs gives: `results.parquet`, a row for each parameter of each log, and `batch.json` beside it.
//!
//! A table of one row for each log and parameter has the same columns whatever the laws are, so that results of several batches,
//! laws and versions can be put below each other; what is known of the log is repeated in each of its rows. A log of which nothing
//! was identified has one row, with the code and the text of its error and no parameter.

mod apart;
mod list;
mod read;
mod row;
mod summary;
mod table;
mod time;

pub use apart::{Apart, Levels};
pub use list::{Listed, is_address, is_list, read_list};
pub use read::{read_results, read_results_while, rows_while};
pub use row::{LogRow, ParameterRow};
pub use summary::{BatchFile, Failure, Named, SCHEMA};
pub use table::{COLUMNS, Results};
pub use time::{date_of, seconds_in_name, seconds_of, seconds_of_file};

/// Name of the table in the folder of a batch.
pub const RESULTS: &str = "results.parquet";
/// Name of the file that says what the batch was.
pub const SUMMARY: &str = "batch.json";
