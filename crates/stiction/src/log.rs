//! A recording of an axis, read and brought to SI.

use crate::{Axis, Error};
use std::path::Path;
use stiction_identify::Samples;
use stiction_log::Motion;
use stiction_workflows::source::{self, Source};

pub use stiction_formats::Column;
pub use stiction_log::{Finding, Severity};

/// A recording in SI units, checked, with what was detected and what is wrong with it.
#[derive(Clone, Debug)]
pub struct Log {
    pub(crate) source: Source,
}

impl Log {
    /// Reads a recording whose columns and units the file itself names.
    ///
    /// # Errors
    /// Where the file cannot be read, or can be read in two ways: with file, row, column, what was found and what is
    /// allowed.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        Self::open_with(path, &Axis::default())
    }

    /// Reads a recording whose columns, units and scales an axis file states.
    ///
    /// # Errors
    /// As [`Log::open`].
    pub fn open_with(path: impl AsRef<Path>, axis: &Axis) -> Result<Self, Error> {
        let source = source::load(path, axis)?;
        Ok(Self { source })
    }

    /// Takes columns that are in memory, named and in any unit, as a file with these columns would be read.
    /// `name` stands for the file in messages and results.
    ///
    /// ```
    /// use stiction::{Axis, Column, Log};
    ///
    /// let column = |name: &str, unit: &str, f: fn(f64) -> f64| Column {
    ///     name: name.into(),
    ///     unit: Some(unit.into()),
    ///     values: (0..1000).map(|i| f(1e-3 * f64::from(i))).collect(),
    ///     ..Column::default()
    /// };
    /// let columns = vec![
    ///     column("time", "s", |t| t),
    ///     column("position", "mm", |t| 5.0 * (6.0 * t).sin()),
    ///     column("force", "N", |t| 20.0 * (6.0 * t).cos().signum()),
    /// ];
    /// let log = Log::from_columns("run 3", columns, &Axis::default())?;
    /// assert_eq!(log.samples(), 1000);
    /// assert_eq!(log.force_unit(), "N");
    /// assert!((log.rate_hz() - 1000.0).abs() < 1e-6);
    /// # Ok::<(), stiction::Error>(())
    /// ```
    ///
    /// # Errors
    /// Where a column is missing, too short, or can be understood in two ways.
    pub fn from_columns(name: &str, columns: Vec<Column>, axis: &Axis) -> Result<Self, Error> {
        let source = source::in_memory(name, columns, axis)?;
        Ok(Self { source })
    }

    /// Path or name as given.
    pub fn path(&self) -> &Path {
        &self.source.path
    }

    /// SHA-256 of the file, or of the columns in memory, hexadecimal.
    pub fn sha256(&self) -> &str {
        &self.source.sha256
    }

    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.source.log.time.len()
    }

    /// Sampling rate, Hz.
    pub fn rate_hz(&self) -> f64 {
        self.source.log.rate_hz
    }

    /// Linear (m, m/s) or rotary (rad, rad/s).
    pub fn motion(&self) -> Motion {
        self.source.log.motion
    }

    /// Time from the first sample, s.
    pub fn time(&self) -> &[f64] {
        &self.source.log.time
    }

    /// Position, m (rad), where it was recorded.
    pub fn position(&self) -> Option<&[f64]> {
        self.source.log.position.as_deref()
    }

    /// Velocity as recorded, m/s (rad/s).
    pub fn velocity(&self) -> Option<&[f64]> {
        self.source.log.velocity.as_deref()
    }

    /// Force in [`force_unit`](Self::force_unit), positive towards positive positions.
    pub fn force(&self) -> Option<&[f64]> {
        self.source.log.force.as_deref()
    }

    /// Unit of the force: `N`, `N*m`, `A`, `V`, or `1` for a share of the rated force.
    pub fn force_unit(&self) -> &str {
        &self.source.log.force_unit
    }

    /// Position that was asked for, m (rad).
    pub fn reference(&self) -> Option<&[f64]> {
        self.source.log.reference.as_deref()
    }

    /// What is wrong with the recording or worth knowing.
    pub fn findings(&self) -> &[Finding] {
        &self.source.log.findings
    }

    /// How file and columns were understood, for people.
    pub fn detected(&self) -> &[String] {
        &self.source.detected
    }

    /// The channels as the engine of `stiction-identify` takes them, where one wants to go on from there by hand.
    ///
    /// # Errors
    /// When the log has no force, or neither position nor velocity.
    pub fn channels(&self) -> Result<Samples, Error> {
        self.source.samples()
    }
}
