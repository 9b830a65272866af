//! What the process says with its exit code.

use stiction_workflows::Verdict;

/// The exit codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Done.
    Done = 0,
    /// Done, and the result is not trustworthy.
    NotTrustworthy = 1,
    /// Bad input or usage.
    BadInput = 2,
    /// A fault of stiction itself.
    Internal = 3,
    /// Interrupted; what was found so far is saved.
    Interrupted = 130,
}

impl From<Verdict> for Exit {
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Trustworthy => Exit::Done,
            Verdict::Interrupted => Exit::Interrupted,
            _ => Exit::NotTrustworthy,
        }
    }
}
