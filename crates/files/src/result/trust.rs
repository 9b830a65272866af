//! What a result may be used for, and what to do next.

use super::Action;
use serde::{Deserialize, Serialize};
use stiction_codes::Code;

/// What a result may be used for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trust {
    /// Whether the law may be used for compensation on motion like that of the logs. False makes exit code 1.
    pub trustworthy: bool,
    /// Why not; empty if it may.
    pub reasons: Vec<String>,
    /// What the law leaves systematically, where its cause was found and nothing else has to be set right first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cause: Option<CauseEntry>,
    /// How well the law predicts friction, and where; absent where the method does not predict the force of a record.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compensation: Option<Compensation>,
    /// Parameters that the logs determine: constants of the machine, within their intervals.
    #[serde(default)]
    pub constants: Vec<String>,
    /// Parameters that the logs leave open: the law may need them to predict friction, but they are no constants of the
    /// machine.
    #[serde(default)]
    pub open: Vec<String>,
    /// A law that holds better on held-out samples than the one that was asked for, and that a compensator may rely on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub better: Option<BetterLaw>,
    /// What to do next.
    #[serde(default, deserialize_with = "super::action::read")]
    pub next: Action,
}

/// A law beside the one that was asked for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BetterLaw {
    /// Its family.
    pub law: String,
    /// Whether each direction has parameters of its own.
    pub asymmetric: bool,
}

/// The strongest cause of what a law leaves systematically.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CauseEntry {
    /// The code of the warning that tells all of it.
    pub code: Code,
    /// What it is, in a part of a sentence.
    pub text: String,
    /// How much it is.
    pub size: String,
    /// What takes it into the fit; absent where neither a line of the axis file nor another law does.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "super::action::read_some"
    )]
    pub cure: Option<Action>,
}

/// How well a law predicts friction, and on which motion that was seen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Compensation {
    /// What the law leaves of the friction: `100 rms(residual) / rms(friction)`, friction being the measured force without
    /// inertia and the other terms beside the law.
    pub friction_left_percent: f64,
    /// On which samples: `held-out`, `validation`, or `fitted` where none could be held out.
    pub judged_on: String,
    /// Largest speed seen, m/s or rad/s.
    pub top_speed: f64,
    /// Stroke seen, m or rad; absent without a position.
    #[serde(default)]
    pub stroke: Option<f64>,
    /// How often the direction changed.
    pub reversals: usize,
}
