//! What a check says of a recording, and what the checks share.

use crate::log::Log;
use stiction_codes::Code;
use stiction_number::short;

/// How much a finding matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// May change what is identified.
    Warning,
}

/// One thing found about a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// What it is; each code has a page in `docs/codes/`.
    pub code: Code,
    /// How much it matters.
    pub severity: Severity,
    /// What was found, with counts and the first place, for people.
    pub message: String,
    /// First sample of the log concerned, counted from 0, where there is one.
    pub at: Option<usize>,
}

impl Finding {
    pub(crate) fn new(code: Code, severity: Severity, message: String) -> Self {
        Self {
            code,
            severity,
            message,
            at: None,
        }
    }

    pub(crate) fn at(mut self, sample: usize) -> Self {
        self.at = Some(sample);
        self
    }
}

/// The median, by selection in linear time; `None` for nothing. The upper one of an even count.
pub(crate) fn median(values: &mut [f64]) -> Option<f64> {
    if values.is_empty() {
        return None;
    }
    let middle = values.len() / 2;
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Smallest and largest of finite values; `None` for nothing.
pub(crate) fn extremes(values: &[f64]) -> Option<(f64, f64)> {
    let first = *values.first()?;
    Some(
        values
            .iter()
            .fold((first, first), |(low, high), &x| (low.min(x), high.max(x))),
    )
}

/// `sample 12 (0.012 s)`.
pub(crate) fn place(log: &Log, sample: usize) -> String {
    format!(
        "sample {sample} ({} s)",
        short(log.time.get(sample).copied().unwrap_or(0.0))
    )
}
