//! What to know although the work went on, and how well a model fits.

use stiction_codes::Code;
use stiction_files::Warning;
use stiction_files::result::FitEntry;
use stiction_identify as engine;

/// How much a notice matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Severity {
    /// Worth knowing: what was done or assumed.
    Note,
    /// May change what is found.
    Warning,
}

/// Something to know although the work went on.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Notice {
    /// What it is; each code has a page in `docs/codes/`.
    pub code: Code,
    /// How much it matters.
    pub severity: Severity,
    /// What was seen, with numbers, what it means, and what to do.
    pub message: String,
}

impl Notice {
    pub(crate) fn of(warning: &Warning) -> Self {
        let severity = match warning.is_note() {
            true => Severity::Note,
            false => Severity::Warning,
        };
        Self {
            code: warning.code,
            severity,
            message: warning.message.clone(),
        }
    }

    pub(crate) fn of_finding(finding: &stiction_log::Finding) -> Self {
        let severity = match finding.severity {
            stiction_log::Severity::Note => Severity::Note,
            stiction_log::Severity::Warning => Severity::Warning,
        };
        Self {
            code: finding.code(),
            severity,
            message: finding.to_string(),
        }
    }
}

/// How well a model explains a signal.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Quality {
    /// Root mean square of the residual, in the unit of the signal.
    pub rmse: f64,
    /// `100 rms(residual) / rms(measured)`, percent.
    pub relative_error_percent: f64,
    /// Part of the variance that is explained, at most 1; `None` of a signal that does not vary.
    pub r2: Option<f64>,
    /// Samples that count.
    pub samples: usize,
    /// Number of independent samples that the residual is worth.
    pub effective_samples: f64,
}

impl Quality {
    pub(crate) fn of(entry: &FitEntry) -> Self {
        Self {
            rmse: entry.rmse,
            relative_error_percent: entry.relative_error_percent,
            r2: entry.r2,
            samples: entry.samples,
            effective_samples: entry.effective_samples,
        }
    }
}

/// Signals at the samples that count, all of one length; position and velocity are empty after a method that has none.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Series {
    /// Which log each sample comes from, counted from 0.
    pub log: Vec<usize>,
    /// Time, s.
    pub time: Vec<f64>,
    /// Position, m (rad).
    pub position: Vec<f64>,
    /// Velocity, m/s (rad/s).
    pub velocity: Vec<f64>,
    /// Measured force, in the unit of the log's.
    pub measured: Vec<f64>,
    /// Force of the model.
    pub model: Vec<f64>,
    /// Part of that which is no friction: inertia, constant force, gravity, cogging.
    pub other: Vec<f64>,
}

impl Series {
    /// Measured minus model.
    pub fn residual(&self) -> Vec<f64> {
        let both = self.measured.iter().zip(&self.model);
        both.map(|(measured, model)| measured - model).collect()
    }

    pub(crate) fn of(own: engine::Series) -> Self {
        Self {
            log: own.log,
            time: own.time,
            position: own.position,
            velocity: own.velocity,
            measured: own.measured,
            model: own.model,
            other: own.other,
        }
    }
}

/// The force that a law predicts for a log that it was not fitted to.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Prediction {
    /// The signals.
    pub series: Series,
    /// How well the law predicts them.
    pub quality: Quality,
}
