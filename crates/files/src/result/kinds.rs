//! Entries that are one of a few words.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Where the value of a parameter comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Origin {
    /// From the logs.
    #[default]
    Identified,
    /// From the axis file, an option or a model: taken as exact.
    Given,
}

impl Origin {
    /// As files have it.
    pub fn name(self) -> &'static str {
        match self {
            Origin::Identified => "identified",
            Origin::Given => "given",
        }
    }
}

/// How a search ended; the best that it found is kept in any case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Status {
    /// By its own criterion: nothing changes any more.
    #[default]
    Converged,
    /// Its own generations, rounds or restarts are over.
    Exhausted,
    /// No step lowers the cost although the gradient is not small.
    Stalled,
    /// The cost that was asked for is reached.
    Target,
    /// The evaluations that it was given are used up.
    Budget,
    /// The time that it was given is used up.
    Time,
    /// Stopped by the user.
    Interrupted,
}

impl Status {
    /// As files have it.
    pub fn name(self) -> &'static str {
        match self {
            Status::Converged => "converged",
            Status::Exhausted => "exhausted",
            Status::Stalled => "stalled",
            Status::Target => "target",
            Status::Budget => "budget",
            Status::Time => "time",
            Status::Interrupted => "interrupted",
        }
    }
}

impl From<stiction_search::Status> for Status {
    fn from(status: stiction_search::Status) -> Self {
        use stiction_search::Status as Of;
        match status {
            Of::Converged => Status::Converged,
            Of::Exhausted => Status::Exhausted,
            Of::Stalled => Status::Stalled,
            Of::Budget => Status::Budget,
            Of::Target => Status::Target,
            Of::Interrupted => Status::Interrupted,
        }
    }
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
