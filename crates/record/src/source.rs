//! What a device gives: columns, and samples with its own time stamps.

use crate::error::Error;
use std::time::Duration;

/// A column of the log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name, as the device calls it.
    pub name: String,
    /// Unit, where it is known.
    pub unit: Option<String>,
}

/// All columns at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Time stamp of the device, s; finite.
    pub time: f64,
    /// A value for each column; NaN where there is none.
    pub values: Vec<f64>,
}

/// A device that is read from. Time stamps keep their zero over connections.
pub trait Source {
    /// Address, as `host:port`.
    fn address(&self) -> &str;

    /// The columns beside the time.
    fn columns(&self) -> &[Column];

    /// Rate that the device is asked for, Hz.
    fn rate(&self) -> f64;

    /// Connects, anew where there was a connection, and asks for samples. Returns within some seconds.
    ///
    /// # Errors
    /// Where the device cannot be reached, refuses, or breaks its protocol.
    fn connect(&mut self) -> Result<(), Error>;

    /// Adds samples that arrive within `wait`, perhaps none.
    ///
    /// # Errors
    /// Where the connection is lost or the device breaks its protocol; what was added before stays.
    fn next(&mut self, wait: Duration, samples: &mut Vec<Sample>) -> Result<(), Error>;

    /// Samples so far that had not all columns and were left out.
    fn incomplete(&self) -> u64;

    /// Ends what was asked for, as far as the device still listens.
    fn close(&mut self);
}

/// Samples that are handed on at once.
pub(crate) const MANY: usize = 10_000;
