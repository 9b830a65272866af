//! What to beware of in a result.

use crate::Found;
use std::fmt;
use stiction_codes::Code;
use stiction_number::{Percent, four_digits, short};

/// The logs that a finding is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Whose {
    /// One that is fitted.
    Fitted,
    /// So many of all that are fitted.
    Many(usize, usize),
    /// One that is validated on.
    Validated,
}

/// Something a user should know although the work went on. Parts are dimensionless, 1 is all.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says; the variant says of what.
pub enum Notice {
    /// Something found in a log, or in many of which it is the first.
    InLog {
        log: String,
        whose: Whose,
        found: Box<Found>,
        axis_file: String,
    },
    /// Positions were sampled beside their time stamps.
    InaccurateStamps { seconds: f64, of_sample: f64 },
    /// No delay within the range fits.
    DelayOutOfRange,
    /// The delay of a step response is at the end of its range.
    DelayOfStep,
    /// The state of a search could not be kept.
    CheckpointLost { error: String },
    /// The user stopped the comparison of laws.
    ComparisonStopped,
    /// A law with fewer parameters has a smaller held-out error.
    SimplerLaw { law: String, error: f64, own: f64 },
    /// A law with more parameters has a much smaller held-out error.
    RicherLaw { law: String, error: f64, own: f64 },
    /// Encoder, filters and noise bias parameters: each by its name, percent.
    Biased { parameters: Vec<(String, f64)> },
    /// A static law is fitted to samples near rest.
    StaticLawAtRest {
        part: f64,
        speed: f64,
        unit: &'static str,
    },
    /// The residual of a simulated open loop has too few independent samples.
    CorrelatedResidual,
}

impl Notice {
    /// The code that its page is named by.
    pub fn code(&self) -> Code {
        match self {
            Self::InLog { found, .. } => found.code(),
            Self::InaccurateStamps { .. } => Code::Jitter,
            Self::DelayOutOfRange | Self::DelayOfStep => Code::DelayOutOfRange,
            Self::CheckpointLost { .. } => Code::BadCheckpoint,
            Self::ComparisonStopped => Code::Interrupted,
            Self::SimplerLaw { .. } => Code::SimplerLawHoldsBetter,
            Self::RicherLaw { .. } => Code::RicherLawHoldsBetter,
            Self::Biased { .. } => Code::LargeShift,
            Self::StaticLawAtRest { .. } => Code::StaticLawAtRest,
            Self::CorrelatedResidual => Code::CorrelatedResidual,
        }
    }
}

fn error(percent: f64) -> String {
    Percent::error(percent).decimals(2)
}

impl fmt::Display for Notice {
    #[rustfmt::skip] // One line a sentence.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::InLog { log, whose, found, axis_file } => {
                let found = found.words(axis_file);
                match whose {
                    Whose::Fitted => write!(f, "{log}: {found}"),
                    Whose::Many(alike, all) => write!(f, "in {alike} of {all} logs, the first {log}: {found}"),
                    Whose::Validated => write!(f, "{log}, which is not fitted: {found}"),
                }
            }
            Self::InaccurateStamps { seconds, of_sample } => write!(f, "time stamps are inaccurate: positions were sampled {} us rms ({:.0} % of a sample) away from their stamps. Intervals include this; a log with hardware time stamps narrows them", four_digits(1e6 * seconds), 100.0 * of_sample),
            Self::DelayOutOfRange => f.write_str("no delay of up to four samples fits and it is taken as zero: force or motion was logged late or filtered, or something acts that the law does not describe"),
            Self::DelayOfStep => f.write_str("the delay between force and position is at its search bound of two samples: it stands for something that the law does not describe, such as another force held before the step than that of the model"),
            Self::CheckpointLost { error } => write!(f, "the state of the search could not be kept: {error}"),
            Self::ComparisonStopped => f.write_str("the comparison of laws was interrupted and is left out; the fit is complete"),
            Self::SimplerLaw { law, error: least, own } => write!(f, "the law {law} has a smaller held-out error ({}) than this law ({}): the richer law is not supported by this log", error(*least), error(*own)),
            Self::RicherLaw { law, error: least, own } => write!(f, "the law {law} has a much smaller held-out error ({}) than this law ({}): this law is too simple for the axis, its parameters are biased", error(*least), error(*own)),
            Self::Biased { parameters } => {
                let each = parameters.iter().map(|(name, percent)| format!("{name} {}", Percent::error(*percent).signed(0)));
                write!(f, "encoder steps, filters and noise bias {}: the bias is subtracted, but one of this size is known only roughly", each.collect::<Vec<_>>().join(", "))
            }
            Self::StaticLawAtRest { part, speed, unit } => write!(f, "{:.0} % of the samples are slower than {} {unit}, where a static law does not hold and most of the residual is. Exclude them with [conditioning] min_speed in the axis file, or identify the law lugre", 100.0 * part, short(*speed)),
            Self::CorrelatedResidual => f.write_str("noise of the logged force drives the simulated axis and adds up to a slow position error that biases the parameters. Cut the log into shorter runs ([simulation] segment in the axis file), or record a closed loop and give its controller ([controller])"),
        }
    }
}
