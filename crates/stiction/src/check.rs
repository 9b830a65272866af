//! What logs can and cannot determine.

use serde_json::Value;
use stiction_pages::text;
use stiction_workflows::{Verdict, check};

/// What was read of each log, and what it can and cannot determine; made by [`Identification::check`](crate::Identification::check).
#[derive(Clone, Debug)]
pub struct Check(pub(crate) check::Check);

impl Check {
    /// Whether each log determines a law that may be trusted, and no log follows its reference worse than the first.
    pub fn is_trustworthy(&self) -> bool {
        self.0.verdict() == Verdict::Trustworthy
    }

    /// As the command line prints it.
    pub fn text(&self) -> String {
        text::check(&self.0)
    }

    /// All of it, as `stiction check --json` writes it.
    pub fn result(&self) -> Value {
        serde_json::to_value(&self.0).expect("plain data")
    }
}
