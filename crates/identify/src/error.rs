//! Why a record cannot be identified at all.

use crate::conditioning::losses::Losses;
use stiction_number::short;
use stiction_signal::SignalError;

/// Input from which nothing can be identified. A search that ends badly is a
/// [`Status`](crate::Status), not an error.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// Channels of one recording differ in length.
    #[error("log {log}: {channel} has {found} samples, time has {expected}")]
    Length {
        /// Which log, counted from 1.
        log: usize,
        /// Which channel.
        channel: &'static str,
        /// Samples found.
        found: usize,
        /// Samples expected.
        expected: usize,
    },
    /// Neither position nor velocity is known.
    #[error("log {log}: neither position nor velocity is given; one of them is needed")]
    NoMotionChannel {
        /// Which log, counted from 1.
        log: usize,
    },
    /// A term needs a channel that a log does not have.
    #[error("log {log}: {term} needs a {channel} channel, and there is none")]
    MissingChannel {
        /// Which log, counted from 1.
        log: usize,
        /// Which channel.
        channel: &'static str,
        /// Which term.
        term: &'static str,
    },
    /// A number that is not finite.
    #[error("log {log}: {channel}, sample {index} is not a finite number")]
    NotFinite {
        /// Which log, counted from 1.
        log: usize,
        /// Which channel.
        channel: &'static str,
        /// Sample, counted from 1.
        index: usize,
    },
    /// Time stamps do not increase.
    #[error("log {log}: time does not increase at sample {index}")]
    Time {
        /// Which log, counted from 1.
        log: usize,
        /// Sample, counted from 1.
        index: usize,
    },
    /// Fewer usable samples than the law needs.
    #[error(
        "{found} usable samples after conditioning, at least {needed} are needed for this law: {losses}"
    )]
    TooFewSamples {
        /// Usable samples.
        found: usize,
        /// Needed samples.
        needed: usize,
        /// Why the others cannot be used.
        losses: Losses,
    },
    /// The axis does not move.
    #[error(
        "the axis does not move in this log ({}): friction cannot be identified from it", slow(*bound, unit)
    )]
    NoMotion {
        /// Largest speed seen.
        bound: f64,
        /// Unit of speed.
        unit: &'static str,
    },
    /// The force is zero throughout.
    #[error("the force is {} throughout: there is nothing to identify", full(nine_digits(*value)))]
    NoForce {
        /// The constant value.
        value: f64,
    },
    /// Fewer constant-velocity runs than the static map needs.
    #[error(
        "{found} constant-velocity stretches{direction}, at least {needed} are needed for this map; \
         12 speeds each way, spaced evenly in their logarithm, are better"
    )]
    TooFewSpeeds {
        /// Stretches found.
        found: usize,
        /// Stretches needed.
        needed: usize,
        /// Of which direction of motion, in words; empty for both together.
        direction: &'static str,
    },
    /// The force does not step, or the axis does not answer as it does in presliding.
    #[error("log {log}: {reason}")]
    NoStep {
        /// Which log, counted from 1.
        log: usize,
        /// What is missing.
        reason: &'static str,
    },
    /// No jump of the force stands out from its noise.
    #[error(
        "log {log}: the force has no step above its noise: the highest between the means of {stretch} samples before \
         and {stretch} after is {}, and {} would be clear",
        short(*highest), short(*needed)
    )]
    FaintStep {
        /// Which log, counted from 1.
        log: usize,
        /// The highest jump between two means, in the unit of the force.
        highest: f64,
        /// How high it would have to be.
        needed: f64,
        /// Samples in each mean.
        stretch: usize,
    },
    /// The force does not rise in a line, or the axis does not break away under it.
    #[error(
        "log {log}: {reason}; a ramp is a force that rises steadily from zero, on an axis at rest, until that moves, one in each log"
    )]
    NoBreakAway {
        /// Which log, counted from 1.
        log: usize,
        /// What was found, or is missing.
        reason: String,
    },
    /// A setting outside its range.
    #[error("{name} = {}: {allowed}", full(*found))]
    Setting {
        /// Which setting.
        name: &'static str,
        /// What was given.
        found: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A filter could not be made.
    #[error("{name}: {source}")]
    Filter {
        /// Which filter.
        name: &'static str,
        /// Why.
        source: SignalError,
    },
    /// A controller under which the simulated axis leaves its path and does not come back.
    #[error(
        "log {log}: under the controller given, with position_gain {} 1/s and speed_gain {}, the simulated axis leaves its \
         path at {} s and does not come back, whatever its friction; give the gains of the drive, its control rate and \
         its force limit", full(*position_gain), full(*speed_gain), short(*time)
    )]
    Diverged {
        /// Which log, counted from 1.
        log: usize,
        /// When the axis leaves the path, s.
        time: f64,
        /// Position gain, 1/s.
        position_gain: f64,
        /// Speed gain, N s/m (N m s/rad).
        speed_gain: f64,
    },
    /// A recording that cannot be simulated.
    #[error("log {log}: {found}; simulating the axis needs {allowed}")]
    NotSimulated {
        /// Which log, counted from 1.
        log: usize,
        /// What was found.
        found: &'static str,
        /// What is needed.
        allowed: &'static str,
    },
}

impl Error {
    /// Which log it is about, counted from 1, where it is about one.
    pub fn log(&self) -> Option<usize> {
        match self {
            Error::Length { log, .. }
            | Error::NoMotionChannel { log }
            | Error::MissingChannel { log, .. }
            | Error::NotFinite { log, .. }
            | Error::Time { log, .. }
            | Error::NoStep { log, .. }
            | Error::FaintStep { log, .. }
            | Error::NoBreakAway { log, .. }
            | Error::Diverged { log, .. }
            | Error::NotSimulated { log, .. } => Some(*log),
            _ => None,
        }
    }
}

/// How slow an axis stays that does not move.
fn slow(bound: f64, unit: &str) -> String {
    if bound > 0.0 {
        format!("|v| stays below {} {unit}", short(bound))
    } else {
        "the velocity is zero throughout".into()
    }
}

/// A number without the rounding of a filter.
fn nine_digits(x: f64) -> f64 {
    format!("{x:.8e}").parse().unwrap_or(x)
}

/// A number in all its digits; very large and small ones with a power of ten.
pub(crate) fn full(x: f64) -> String {
    if x == 0.0 || (1e-9..1e16).contains(&x.abs()) {
        format!("{x}")
    } else {
        format!("{x:e}")
    }
}
