//! Readers of measurement files: bytes in, a [`Table`] of named columns of plain numbers out.
//!
//! [`read_table`] looks at the first bytes of a file and calls the reader of its format; [`text::read`] takes a text in memory.
//! Columns keep the names and units of the file; [`Unit`] converts. A reader never guesses silently: what it detected is in
//! [`Table::detected`], what it cannot decide is an [`Error`] that lists the choices. Memory is bounded ([`Limits`]), whatever a
//! file claims.
//!
//! ```
//! use stiction_formats::{ReadOptions, Unit, read_table};
//!
//! let path = std::env::temp_dir().join(format!("stiction-formats-{}.csv", std::process::id()));
//! std::fs::write(&path, "time [s];position [mm]\n0,000;1,00\n0,001;1,02\n0,002;1,05\n")?;
//! let table = read_table(&path, &ReadOptions::default())?;
//! std::fs::remove_file(&path)?;
//!
//! let position = &table.columns[1];
//! assert_eq!((position.name.as_str(), position.unit.as_deref()), ("position", Some("mm")));
//! assert_eq!(position.values, [1.0, 1.02, 1.05]);
//! assert_eq!(Unit::parse("mm")?.to_si(position.values[0]), 1e-3);
//! assert!(table.detected.iter().any(|what| what.contains("decimal comma")), "{:?}", table.detected);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[cfg(feature = "arrow")]
mod arrow;
mod binary;
mod error;
#[cfg(feature = "ethercat")]
pub mod ethercat;
#[cfg(feature = "hdf5")]
mod hdf5;
#[cfg(feature = "json")]
mod json;
#[cfg(feature = "parquet")]
mod lerobot;
mod limits;
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
#[cfg(feature = "parquet")]
pub use lerobot::data_set_of;
pub use limits::{Limits, allow_memory, allowed_memory, within_memory};
#[cfg(feature = "rosbag")]
pub use open::bag_of;
pub use open::{
    ReadOptions, is_binary_recording, is_recording_folder, read_table, read_table_with, read_wanted,
};
#[cfg(feature = "parquet")]
pub use parquet::{Cells, read_cells};
pub use regular::{Irregular, is_of_kernel, is_regular, regular};
pub use stiction_codes::Code;
pub use table::{Column, Passed, Scalar, Table};
pub use unit::{Dimension, Unit, Value};
pub use watch::{Reading, watch};
