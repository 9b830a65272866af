//! Motion logs: readers for the formats that drives write, units, column mapping, and what is wrong with
//! a recording.
//!
//! Start with [`read_table`] for a file, or [`text::read`] for text in memory, then [`Log::from_table`].
//! Data flows one way: bytes -> [`Table`] (columns as in the file) -> [`Mapping`] and units -> [`Log`] (SI, checked). A
//! reader never guesses silently: what it detected is in [`Table::detected`], what it cannot decide is an
//! [`Error`] that lists the choices.
//!
//! ```
//! use stiction_log::{Log, Mapping, text};
//!
//! let file = "time [s],position [mm],force [N]\n0.000,1.00,2.0\n0.001,1.02,2.1\n0.002,1.05,2.0\n";
//! let table = text::read(file.as_bytes(), &text::TextOptions::default())?;
//! let log = Log::from_table(&table, &Mapping::default())?; // everything detected
//! assert_eq!(log.rate_hz, 1000.0);
//! assert_eq!(log.force_unit, "N");
//! assert!(log.position.is_some_and(|x| (x[0] - 1e-3).abs() < 1e-15)); // in m
//! assert!(log.findings.iter().any(|finding| finding.code().as_str() == "few-samples"));
//! # Ok::<(), stiction_log::Error>(())
//! ```

#[cfg(feature = "arrow")]
mod arrow;
mod binary;
mod error;
#[cfg(feature = "ethercat")]
pub mod ethercat;
pub mod findings;
#[cfg(feature = "hdf5")]
mod hdf5;
mod join;
#[cfg(feature = "json")]
mod json;
#[cfg(feature = "parquet")]
mod lerobot;
mod limits;
pub mod log;
pub mod mapping;
#[cfg(feature = "matlab")]
mod matlab4;
#[cfg(feature = "matlab")]
mod matlab5;
#[cfg(feature = "mcap")]
mod mcap;
#[cfg(feature = "mdf")]
mod mdf;
#[cfg(feature = "numpy")]
mod numpy;
mod open;
#[cfg(feature = "parquet")]
mod parquet;
mod regular;
mod republished;
#[cfg(feature = "mcap")]
mod ros;
#[cfg(feature = "rosbag")]
mod rosbag;
mod sniff;
mod stamps;
#[cfg(feature = "svb")]
mod svb;
mod table;
#[cfg(feature = "tdms")]
mod tdms;
pub mod text;
pub mod unit;
mod watch;
#[cfg(feature = "xlsx")]
mod xlsx;

pub use error::{Counted, Error, Kind, Place};
pub use findings::{Finding, Found, Severity};
pub use join::{Elsewhere, Joined, Offset};
#[cfg(feature = "parquet")]
pub use lerobot::data_set_of;
pub use limits::{Limits, allow_memory, allowed_memory, within_memory};
pub use log::{Excluded, Gap, Log, NotEnabled};
pub use mapping::{
    Assumed, Channel, Detected, Drive, Enable, Mapping, Motion, OwnStamps, Parts, Rests, Role,
    Selector, Sign, Understood, Wrap,
};
#[cfg(feature = "rosbag")]
pub use open::bag_of;
pub use open::{
    ReadOptions, is_binary_recording, is_recording_folder, read_table, read_table_with, read_wanted,
};
#[cfg(feature = "parquet")]
pub use parquet::{Cells, read_cells};
pub use regular::{Irregular, is_of_kernel, is_regular, regular};
pub use republished::{Republished, republished};
pub use stiction_codes::Code;
pub use table::{Column, Passed, Scalar, Table};
pub use unit::{Dimension, Unit, Value};
pub use watch::{Reading, watch};
