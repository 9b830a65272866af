//! What to do next, as data: made where the fact is known, turned into a sentence and a command where it is shown.

use serde::{Deserialize, Serialize};

/// What to do next with a log or a result.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Action {
    /// Write the compensator.
    #[default]
    Export,
    /// Identify these logs by themselves; without names those at hand.
    Identify {
        /// Their paths.
        logs: Vec<String>,
    },
    /// Identify the first of the logs by itself, then the others likewise.
    FirstLog,
    /// Identify all logs that the axis file lists.
    Listed,
    /// Identify again and let the data choose the law.
    LetTheDataChoose,
    /// Identify again with this law.
    Law {
        /// Its family.
        law: String,
        /// Whether each direction has parameters of its own.
        asymmetric: bool,
    },
    /// Identify by simulation of the axis.
    Simulate,
    /// See what these logs show; without names those at hand.
    Check {
        /// Their paths.
        logs: Vec<String>,
    },
    /// Write a line into the axis file, then identify again.
    Line {
        /// The table it belongs to, such as `terms`.
        table: String,
        /// The line, such as `coulomb_temperature = true`.
        line: String,
        /// Whether it takes the place of the line with this key, which the axis file has.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        replaces: bool,
    },
    /// Leave a line out of the axis file, then identify again.
    Remove {
        /// The table it stands in.
        table: String,
        /// The line, or its key.
        line: String,
    },
    /// Correct the axis file as the reasons say, then identify again.
    AxisFile,
    /// Record the motion that is missing.
    Record,
    /// Give the same command again, and let it end.
    Again,
    /// Give the same command with the least squares after the search.
    Finish,
}

impl Action {
    /// Looks at the logs at hand.
    pub const CHECK: Self = Self::Check { logs: Vec::new() };
    /// Identifies the logs at hand.
    pub const IDENTIFY: Self = Self::Identify { logs: Vec::new() };

    /// The key of the line that is written.
    pub fn key(line: &str) -> &str {
        line.split(' ').next().unwrap_or_default()
    }
}

/// Reads an action, also as it was written before it had data: a name alone, a line or a law.
pub(super) fn read<'de, D: serde::Deserializer<'de>>(from: D) -> Result<Action, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Form {
        Whole(Action),
        Line {
            table: String,
            line: String,
            #[serde(default)]
            replaces: bool,
        },
        Law {
            law: String,
            #[serde(default)]
            asymmetric: bool,
        },
        Name(String),
    }
    Ok(match Form::deserialize(from)? {
        Form::Whole(action) => action,
        Form::Line {
            table,
            line,
            replaces,
        } => Action::Line {
            table,
            line,
            replaces,
        },
        Form::Law { law, asymmetric } => Action::Law { law, asymmetric },
        Form::Name(name) => match name.as_str() {
            "check" | "check-the-other" => Action::CHECK,
            "identify-the-other" => Action::IDENTIFY,
            "another-law" => Action::LetTheDataChoose,
            _ => return Err(serde::de::Error::custom("an action")),
        },
    })
}

/// The same where there may be none.
pub(super) fn read_some<'de, D: serde::Deserializer<'de>>(
    from: D,
) -> Result<Option<Action>, D::Error> {
    read(from).map(Some)
}
