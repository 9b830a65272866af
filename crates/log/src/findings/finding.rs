//! What a check says of a recording, and what the checks share.

use crate::log::Log;
use std::fmt;
use stiction_codes::Code;
use stiction_say::{Found, Sample};

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
    /// What it is, with its numbers.
    pub kind: Found,
    /// How much it matters.
    pub severity: Severity,
    /// First sample of the log concerned, counted from 0, where there is one.
    pub at: Option<usize>,
    /// Name of the axis file, where it is not `axis.toml`.
    axis_file: Option<String>,
}

impl Finding {
    fn new(kind: Found, severity: Severity) -> Self {
        Self {
            kind,
            severity,
            at: None,
            axis_file: None,
        }
    }

    pub(crate) fn note(kind: Found) -> Self {
        Self::new(kind, Severity::Note)
    }

    pub(crate) fn warning(kind: Found) -> Self {
        Self::new(kind, Severity::Warning)
    }

    /// A warning where a test holds, else a note.
    pub(crate) fn graded(kind: Found, is_warning: bool) -> Self {
        match is_warning {
            true => Self::warning(kind),
            false => Self::note(kind),
        }
    }

    /// The code, which has a page in `docs/codes/`.
    pub fn code(&self) -> Code {
        self.kind.code()
    }

    /// Name of the axis file that the text tells to change.
    pub fn axis_file(&self) -> &str {
        self.axis_file.as_deref().unwrap_or("axis.toml")
    }

    /// Names the axis file in the text.
    pub fn name_axis_file(&mut self, name: String) {
        self.axis_file = Some(name);
    }

    pub(crate) fn at(mut self, sample: usize) -> Self {
        self.at = Some(sample);
        self
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.kind.words(self.axis_file()))
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

/// A sample with its time.
pub(crate) fn place(log: &Log, number: usize) -> Sample {
    let seconds = log.time.get(number).copied().unwrap_or(0.0);
    Sample { number, seconds }
}
