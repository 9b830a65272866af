//! Errors of signals and settings.

use thiserror::Error;

/// Why a signal could not be processed. Indices count samples from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SignalError {
    /// A setting is outside its range.
    #[error("{parameter} is {}; allowed: {allowed}", full(*found))]
    Parameter {
        /// What was set.
        parameter: &'static str,
        /// The value given.
        found: f64,
        /// The allowed range.
        allowed: String,
    },
    /// The signal has fewer samples than the operation needs.
    #[error("{operation} needs at least {needed} samples, found {found}")]
    TooShort {
        /// The operation.
        operation: &'static str,
        /// Samples given.
        found: usize,
        /// Samples needed.
        needed: usize,
    },
    /// Two signals that belong together differ in length.
    #[error("{signal} has {found} samples, expected {expected}")]
    LengthMismatch {
        /// The signal that differs.
        signal: &'static str,
        /// Its length.
        found: usize,
        /// The length of the signal it belongs to.
        expected: usize,
    },
    /// A sample is NaN or infinite; one such sample would spoil a whole filtered record.
    #[error("sample {index} is {found}; only finite values can be processed (fill gaps first)")]
    NotFinite {
        /// Position of the first such sample.
        index: usize,
        /// Its value.
        found: f64,
    },
    /// Time stamps must strictly increase.
    #[error("time stamp {index} is {} s after {} s; time must increase", full(*found), full(*previous))]
    NotIncreasing {
        /// Position of the first stamp that does not come after its predecessor.
        index: usize,
        /// The stamp before it, s.
        previous: f64,
        /// The stamp, s.
        found: f64,
    },
}

/// A number in all its digits; very large and small ones with a power of ten.
fn full(x: f64) -> String {
    if x == 0.0 || (1e-9..1e16).contains(&x.abs()) {
        format!("{x}")
    } else {
        format!("{x:e}")
    }
}
