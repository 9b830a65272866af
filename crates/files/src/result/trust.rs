//! What a result may be used for, and what to do next.

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
    /// The logs that it was validated on and that contradict it, where the next step is about them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub other: Vec<String>,
    /// What to do next.
    #[serde(default)]
    pub next: Next,
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
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cure: Option<Cure>,
}

/// What takes the cause of what a law leaves into the fit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Cure {
    /// A line of the axis file.
    Line {
        /// The table it belongs to, such as `terms`.
        table: String,
        /// The line, such as `coulomb_temperature = true`.
        line: String,
        /// Whether it takes the place of the line with this key, which the axis file has.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        replaces: bool,
    },
    /// A law that may have that shape.
    Law {
        /// Its name.
        law: String,
    },
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

/// What to do next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Next {
    /// Write the compensator.
    #[default]
    Export,
    /// Identify again and let the data choose the law.
    LetTheDataChoose,
    /// Identify again with the law that holds better on held-out samples.
    AnotherLaw,
    /// Identify the logs that it was validated on by themselves, and compare.
    IdentifyTheOther,
    /// See what the logs that it was validated on show: from one of them nothing can be identified.
    CheckTheOther,
    /// Identify the first of the logs by itself, and the others likewise: together they are not of one axis.
    FirstLog,
    /// Identify again by simulation of the axis.
    Simulate,
    /// Correct the axis file as the reasons say, and identify again.
    AxisFile,
    /// See what the log shows, and record the motion that is missing.
    Check,
    /// Record the motion that is missing: no other fit of this log leads further.
    Record,
    /// Give the same command again, and let it end.
    Again,
    /// Give the same command with the least squares after the search.
    Finish,
}
