//! Why a law should not be used for compensation.

use std::fmt;
use stiction_codes::Code;
use stiction_number::{Percent, counted, short};

/// The samples on which an error was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum On {
    /// Samples of the fitted logs that were left out in turn.
    HeldOut,
    /// Other logs.
    Validation,
    /// The fitted samples.
    Fitted,
}

/// A reason against using a law for compensation. Parts are dimensionless, 1 is all.
#[allow(missing_docs)] // A field is what its name says; the variant says of what.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// A finding about a log or an axis file, in its own words.
    Finding(String),
    /// The logs have different signs of the force.
    MixedSigns { inverted: String, others: String },
    /// A parameter differs too much between logs of one fit.
    SeveralAxes { parameter: String, ratio: f64 },
    /// Mass, Coulomb and viscous friction would be negative.
    InvertedForce,
    /// The force comes from another file, with time stamps of its own.
    UnalignedClocks,
    /// The search ended without converging.
    NotConverged { status: &'static str },
    /// The user stopped the search.
    Interrupted,
    /// A search was not followed by least squares.
    NoIntervals,
    /// The law explains too little of the variance.
    PoorFit {
        explained: f64,
        least: f64,
        signal: &'static str,
    },
    /// The steady curve explains too little of the variance.
    PoorCurve { least: f64 },
    /// The axis moves in one direction only.
    OneDirection,
    /// Too few reversals for a Coulomb level that is not determined.
    FewReversals { reversals: usize },
    /// Coulomb friction is zero.
    NoCoulomb,
    /// The axis stays in presliding.
    NeverSlides,
    /// A simulated axis never exceeds static friction.
    NeverBreaksAway,
    /// The force is at its limit too often.
    Saturated { part: f64, most: f64 },
    /// The drive gave less than the force that was logged.
    ForceNotGiven { part: f64 },
    /// Another law has a far smaller held-out error.
    BetterLaw {
        law: String,
        asymmetric: bool,
        error: f64,
        own: f64,
    },
    /// The law predicts a validation log worse than the fitted logs.
    ValidationFails {
        log: String,
        error: f64,
        fitted: f64,
        inverted: bool,
    },
    /// The law leaves too much of the friction.
    FrictionLeft { error: f64, most: f64, on: On },
    /// No samples could be held out.
    NothingHeldOut,
    /// A level of friction is far above the largest force of the logs.
    Extrapolated { level: &'static str, ratio: f64 },
    /// Too many points lie off the steady curve.
    OutlyingPoints { part: f64 },
    /// The motion has other friction than the static parameters that were given.
    StaticsDiffer,
    /// The second step does not determine `sigma0`.
    OpenStiffness { why: Option<String> },
    /// The steady curve of force steps was assumed.
    AssumedCurve,
    /// The simulated law jumps where elements begin to stick.
    SimulationJumps,
    /// The simulated position determines no parameter.
    NothingDetermined { closed_loop: bool },
    /// The residual of an open loop has too few independent samples.
    CorrelatedResidual { samples: f64, unknowns: usize },
    /// The simulated position of an unseen log is off by far more than that of the fit.
    PositionFails {
        log: String,
        seconds: Option<f64>,
        ratio: f64,
        of_encoder: bool,
        most: f64,
    },
    /// The simulated law explains too little of the position of an unseen log.
    PositionUnexplained {
        log: String,
        explained: f64,
        least: f64,
    },
}

fn percent(part: f64) -> String {
    Percent::error(100.0 * part).digits(2)
}

impl Reason {
    /// The code of the warning that says the same.
    pub fn code(&self) -> Code {
        match self {
            Self::NotConverged { .. } => Code::NotConverged,
            Self::Interrupted => Code::Interrupted,
            Self::OneDirection => Code::OneDirection,
            Self::MixedSigns { .. } => Code::ForceSign,
            _ => Code::PoorFit,
        }
    }
}

impl fmt::Display for Reason {
    #[rustfmt::skip] // One line a sentence.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Finding(text) => f.write_str(text),
            Self::MixedSigns { inverted, others } => write!(f, "the force of {inverted} has the opposite sign of that of {others}: invert that column in the file, or fit {inverted} alone with an axis file that has invert = true beside the force under [columns]"),
            Self::SeveralAxes { parameter, ratio } => write!(f, "the logs do not belong to one axis with one load: {parameter} is {} times as large in one as in another", short(*ratio)),
            Self::InvertedForce => f.write_str("inverted force sign: the fit needs negative mass and friction; set invert = true beside its column under [columns]"),
            Self::UnalignedClocks => f.write_str("the force comes from another file, whose clock may differ: set offset = \"estimate\" beside its file under [columns]"),
            Self::NotConverged { status } => write!(f, "the search did not converge (status {status})"),
            Self::Interrupted => f.write_str("the search was interrupted; the best values so far are given, without intervals"),
            Self::NoIntervals => f.write_str("a search alone gives no intervals: the least squares after it were left out"),
            Self::PoorFit { explained, least, signal } => write!(f, "the law explains {:.0} % of the variance of the {signal}; at least {:.0} % are needed", 100.0 * explained.max(0.0), 100.0 * least),
            Self::PoorCurve { least } => write!(f, "the curve explains less than {:.0} % of the variance of the forces", 100.0 * least),
            Self::OneDirection => f.write_str("the axis moves in one direction only: friction cannot be separated from a constant force"),
            Self::FewReversals { reversals: 0 } => f.write_str("the log has no reversal: the Coulomb level is not determined"),
            Self::FewReversals { reversals } => write!(f, "the log has {}, too few to determine the Coulomb level", counted(*reversals, "reversal")),
            Self::NoCoulomb => f.write_str("its Coulomb friction is zero"),
            Self::NeverSlides => f.write_str("the axis never slides: its stroke is shorter than the presliding travel"),
            Self::NeverBreaksAway => f.write_str("the axis never breaks away: static friction and sliding are not seen"),
            Self::Saturated { part, most } => write!(f, "the force is saturated in {:.0} % of the samples (at most {:.0} % can be left out)", 100.0 * part, 100.0 * most),
            Self::ForceNotGiven { part } => write!(f, "in {} of the samples the drive gave less than the logged force", percent(*part)),
            Self::BetterLaw { law, asymmetric, error, own } => write!(f, "the held-out error of the law {law}{} is {}, that of this law {}", if *asymmetric { ", asymmetric," } else { "" }, Percent::error(*error).decimals(2), Percent::error(*own).decimals(2)),
            Self::ValidationFails { log, error, fitted, inverted } => write!(f, "on {log} the law leaves {} of the friction, on the fitted logs {}: {}", percent(*error), percent(*fitted), if *inverted { "its force sign is inverted" } else { "friction, load or motion differ there" }),
            Self::FrictionLeft { error, most, on } => write!(f, "the law leaves {} of the friction on {}; compensation needs at most {}", percent(*error), match on { On::HeldOut => "held-out samples", On::Validation => "the validation data", On::Fitted => "the fitted samples" }, percent(*most)),
            Self::NothingHeldOut => f.write_str("the log is too short to hold samples out: what the law predicts is not tested"),
            Self::Extrapolated { level, ratio } => write!(f, "its {level} is an extrapolation ({} times the largest force in the log)", short(*ratio)),
            Self::OutlyingPoints { part } => write!(f, "{} of the points lie far off the curve", percent(*part)),
            Self::StaticsDiffer => f.write_str("friction in this motion differs from the static parameters: identify the motion alone"),
            Self::OpenStiffness { why: None } => f.write_str("sigma0 is not determined, which is the purpose of the second step"),
            Self::OpenStiffness { why: Some(why) } => write!(f, "sigma0 is not determined by these steps: {why}"),
            Self::AssumedCurve => f.write_str("the steady curve is assumed, and no interval includes its error: record constant velocities and give them with --static speeds.csv, or a model of them with --model DIR/model.toml"),
            Self::SimulationJumps => f.write_str("the simulated law jumps where elements begin to stick: the search may miss the optimum, and the intervals do not show it. Take maxwell-slip, or fit the force"),
            Self::NothingDetermined { closed_loop: true } => f.write_str("the position determines no parameter: behind a stiff controller it hardly shows the axis"),
            Self::NothingDetermined { closed_loop: false } => f.write_str("the position determines no parameter: many axes would move alike under this force. Record reversals at several speeds"),
            Self::CorrelatedResidual { samples, unknowns } => write!(f, "the residual has {samples:.0} independent samples for {unknowns} unknowns, starts included: noise of the logged force biases the parameters beyond their intervals"),
            Self::PositionFails { log, seconds, ratio, of_encoder, most } => write!(f, "on {log}, simulated {}, the position error is {} times {} (at most {most})", match seconds { None => "whole".to_string(), Some(seconds) => format!("over {} s at a time", short(*seconds)) }, short(*ratio), if *of_encoder { "that of encoder steps" } else { "that of the fit" }),
            Self::PositionUnexplained { log, explained, least } => write!(f, "on {log}, simulated whole, the law explains {:.0} % of the variance of the position; at least {:.0} % are needed", 100.0 * explained.max(0.0), 100.0 * least),
        }
    }
}
