//! How a search or a run ends.

use serde::{Deserialize, Serialize};

/// How a search ended, or why a run came back. The best so far is kept in any case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// By its own criterion: nothing changes any more.
    Converged,
    /// Its own generations, rounds or restarts are over.
    Exhausted,
    /// No step lowers the cost although the gradient is not small, or no point has a finite cost.
    Stalled,
    /// The evaluations or steps that it was given are used up.
    Budget,
    /// The cost that was asked for is reached.
    Target,
    /// Stopped from outside.
    Interrupted,
}

impl Status {
    /// Name as written to files.
    pub fn name(self) -> &'static str {
        match self {
            Status::Converged => "converged",
            Status::Exhausted => "exhausted",
            Status::Stalled => "stalled",
            Status::Budget => "budget",
            Status::Target => "target",
            Status::Interrupted => "interrupted",
        }
    }
}
