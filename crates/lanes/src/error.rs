//! Errors of tracks and batches.

use stiction_friction::ParamError;

/// Why a track or a batch could not be made.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A candidate with a parameter out of its range.
    #[error("candidate {index}: {source}")]
    Candidate {
        /// Which, counted from 0.
        index: usize,
        /// What is wrong with it.
        source: ParamError,
    },
    /// A sample with a value that is not allowed.
    #[error("segment {segment}, {channel}, sample {sample}: {found}; allowed: {allowed}")]
    Sample {
        /// Which segment, counted from 0.
        segment: usize,
        /// `time`, `velocity`, `force`, `position` or `column`.
        channel: &'static str,
        /// Which sample, counted from 0.
        sample: usize,
        /// The value found, SI.
        found: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A time step that is not finite and above zero.
    #[error("segment {segment}: time step = {found} s; allowed: finite and > 0")]
    Step {
        /// Which segment, counted from 0.
        segment: usize,
        /// The value found, s.
        found: f64,
    },
    /// A channel with another number of values than it needs.
    #[error("segment {segment}: {channel} with {found} entries; allowed: {expected}")]
    Length {
        /// Which segment, counted from 0.
        segment: usize,
        /// `time`, `force`, `keep`, `columns`, a `column` or the `measured` motion.
        channel: &'static str,
        /// How many were found.
        found: usize,
        /// How many are needed.
        expected: usize,
    },
}
