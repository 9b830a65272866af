//! Motion logs: column mapping, time stamps, and what is wrong with a recording.
//!
//! Data flows one way: bytes -> [`Table`] (columns as in the file, by `stiction_formats`) -> [`Mapping`] and units -> [`Log`] (SI,
//! checked). What cannot be decided is an [`Error`] that lists the choices.
//!
//! ```
//! use stiction_formats::text;
//! use stiction_log::{Log, Mapping};
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

pub mod findings;
mod join;
pub mod log;
pub mod mapping;
mod republished;

pub use findings::{Finding, Found, Severity};
pub use join::{Elsewhere, Joined, Offset};
pub use log::{Excluded, Gap, Log, NotEnabled};
pub use mapping::{
    Assumed, Channel, Detected, Drive, Enable, Mapping, Motion, OwnStamps, Parts, Rests, Role,
    Selector, Sign, Understood, Wrap,
};
pub use republished::{Republished, republished};
pub use stiction_codes::Code;
pub use stiction_formats::{Column, Dimension, Error, Kind, Limits, Place, Table, Unit, Value};
