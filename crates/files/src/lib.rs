//! The files that users keep, as forms: what may stand in them, how it is checked, how it is written.
//!
//! - [`Axis`]: `axis.toml`, what is known of a machine and its log, resolved to the types of the log and the engine.
//! - [`ModelFile`]: `model.toml`, an identified law with its intervals and covariance.
//! - [`ResultFile`](result::ResultFile): `result.json`, everything an identification found.
//! - [`Study`](study::Study): `study.toml`, resolved to the types of the simulation; [`study::result`]: `study.json`.
//! - [`CompareFile`](compare_file::CompareFile): `compare.json`. [`ReproduceFile`](reproduce_file::ReproduceFile):
//!   `reproduce.json`.
//! - [`batch`]: lists of logs, `results.parquet` and `batch.json`.
//! - [`DriftFile`](drift_file::DriftFile): `drift.json`.
//! - [`Robot`]: `robot.toml`, what is known of a robot and its logs.
//! - [`Bundle`]: files that are written together, whole or not at all.
//!
//! Begin with [`Axis::read`] or [`ModelFile::read`]. An error names file, line, column, key, what was found and what is allowed:
//!
//! ```
//! use stiction_files::Axis;
//! let axis = Axis::parse("kind = \"linear\"\nmass = \"4.6 kg\"\n").unwrap();
//! assert_eq!(axis.name, None);
//! let refused = Axis::parse("kind = \"round\"\n").unwrap_err();
//! assert!(refused.to_string().starts_with("axis: line 1, column 8, kind: "));
//! ```
//!
//! Nothing here runs a workflow, and nothing prints.

pub mod axis;
pub mod batch;
pub mod compare_file;
mod config;
pub mod drift_file;
mod error;
mod hash;
pub mod model;
mod output;
pub mod plan;
pub mod reproduce_file;
pub mod result;
pub mod robot;
pub mod shell;
pub mod study;
pub mod symbols;
pub mod visible;

pub use axis::Axis;
pub use config::{Looks, looks, refuse_as_log};
pub use error::{Error, Warning};
pub use hash::{Hash, sha256, sha256_of};
pub use model::ModelFile;
pub use output::{
    Bundle, Journal, Kept, Runs, Work, check_apart, check_folder, check_folder_of, check_inputs,
    check_writable, has_runs, write_atomic, write_folder, write_keeping,
};
pub use robot::Robot;
