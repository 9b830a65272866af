//! A recording of an axis, read and brought to SI.

use crate::{Axis, Error, Notice};
use std::fmt;
use std::path::Path;
use stiction_formats::Column;
use stiction_workflows::source::{self, Source};

/// Whether an axis moves along a line or turns.
// There is no third kind: a match may be exhaustive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Motion {
    /// Position in m, velocity in m/s, force in N.
    Linear,
    /// Position in rad, velocity in rad/s, torque in N m.
    Rotary,
}

impl Motion {
    pub(crate) fn of(motion: stiction_log::Motion) -> Self {
        match motion {
            stiction_log::Motion::Linear => Motion::Linear,
            stiction_log::Motion::Rotary => Motion::Rotary,
        }
    }
}

impl fmt::Display for Motion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Motion::Linear => "linear",
            Motion::Rotary => "rotary",
        })
    }
}

/// A recording in SI units, checked, with what was detected and what is wrong with it.
#[derive(Clone, Debug)]
pub struct Log(pub(crate) Source);

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
        source::load(path, &axis.0).map(Self).map_err(Error::of)
    }

    /// Takes columns that are in memory under their headers, as a file with these columns would be read: `Position [mm]` is the
    /// position in mm, and a sample that is missing is NaN. `name` stands for the file in messages and results.
    ///
    /// ```
    /// use stiction::{Axis, Log};
    ///
    /// let samples = |f: fn(f64) -> f64| -> Vec<f64> { (0..1000).map(|i| f(1e-3 * f64::from(i))).collect() };
    /// let columns = [
    ///     ("time [s]", samples(|t| t)),
    ///     ("position [mm]", samples(|t| 5.0 * (6.0 * t).sin())),
    ///     ("force [N]", samples(|t| 20.0 * (6.0 * t).cos().signum())),
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
    pub fn from_columns<H: AsRef<str>>(
        name: &str,
        columns: impl IntoIterator<Item = (H, Vec<f64>)>,
        axis: &Axis,
    ) -> Result<Self, Error> {
        let columns = columns.into_iter();
        let columns = columns.map(|(header, values)| Column::headed(header.as_ref(), values));
        let source = source::in_memory(name, columns.collect(), &axis.0);
        source.map(Self).map_err(Error::of)
    }

    /// Path or name as given.
    pub fn path(&self) -> &Path {
        &self.0.path
    }

    /// SHA-256 of the file, or of the columns in memory, hexadecimal.
    pub fn sha256(&self) -> &str {
        &self.0.sha256
    }

    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.0.log.time.len()
    }

    /// Sampling rate, Hz.
    pub fn rate_hz(&self) -> f64 {
        self.0.log.rate_hz
    }

    /// Linear (m, m/s) or rotary (rad, rad/s).
    pub fn motion(&self) -> Motion {
        Motion::of(self.0.log.motion)
    }

    /// Time from the first sample, s.
    pub fn time(&self) -> &[f64] {
        &self.0.log.time
    }

    /// Position, m (rad), where it was recorded.
    pub fn position(&self) -> Option<&[f64]> {
        self.0.log.position.as_deref()
    }

    /// Velocity as recorded, m/s (rad/s).
    pub fn velocity(&self) -> Option<&[f64]> {
        self.0.log.velocity.as_deref()
    }

    /// Force in [`force_unit`](Self::force_unit), positive towards positive positions.
    pub fn force(&self) -> Option<&[f64]> {
        self.0.log.force.as_deref()
    }

    /// Unit of the force: `N`, `N*m`, `A`, `V`, or `1` for a share of the rated force.
    pub fn force_unit(&self) -> &str {
        &self.0.log.force_unit
    }

    /// Position that was asked for, m (rad).
    pub fn reference(&self) -> Option<&[f64]> {
        self.0.log.reference.as_deref()
    }

    /// What is wrong with the recording or worth knowing.
    pub fn findings(&self) -> impl Iterator<Item = Notice> {
        self.0.log.findings.iter().map(Notice::of_finding)
    }

    /// How file and columns were understood, for people.
    pub fn detected(&self) -> &[String] {
        &self.0.detected
    }
}
