//! Motion logs: readers for the formats drives write, units, column mapping, and what is wrong with
//! a recording.
//!
//! Data flows one way: bytes -> [`Table`] (columns as they stand in the file) -> mapping and units ->
//! [`Log`] (SI, checked). A reader never guesses silently: what it detected is in
//! [`Table::detected`], what it cannot decide is an [`Error`] that lists the choices.

#[cfg(any(
    feature = "matlab",
    feature = "hdf5",
    feature = "numpy",
    feature = "parquet"
))]
mod binary;
mod error;
pub mod findings;
#[cfg(feature = "hdf5")]
mod hdf5;
pub mod log;
pub mod mapping;
#[cfg(feature = "matlab")]
mod matlab4;
#[cfg(feature = "matlab")]
mod matlab5;
#[cfg(feature = "numpy")]
mod numpy;
mod open;
#[cfg(feature = "parquet")]
mod parquet;
mod sniff;
mod table;
pub mod text;
pub mod unit;

pub use error::{Error, Kind, Place};
pub use findings::{Finding, Severity};
pub use log::{Excluded, Gap, Log};
pub use mapping::{Channel, Detected, Mapping, Motion, Role, Selector, Wrap};
pub use open::{Limits, ReadOptions, read_table};
pub use stiction_codes::Code;
pub use table::{Column, Scalar, Table};
pub use unit::{Dimension, Unit, Value};
