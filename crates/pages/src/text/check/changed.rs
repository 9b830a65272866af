//! How the following of a reference changed between two logs, for whoever shows it with elements of its own.

use stiction_files::shell::shown;
use stiction_number::{counted, quantity, sig};
use stiction_workflows::check::{Tracking, TrackingChange};

/// What changed from one log to another.
#[derive(Clone, Debug, PartialEq)]
pub struct Changed {
    /// The verdict in a sentence.
    pub verdict: String,
    /// Whether it is a good one; `None` where the motions cannot be compared reversal by reversal.
    pub good: Option<bool>,
    /// Errors of both, the largest at a reversal first.
    pub rows: Vec<ChangedRow>,
    /// What limits the comparison.
    pub notes: Vec<String>,
}

/// An error of both logs, m or rad.
#[derive(Clone, Debug, PartialEq)]
pub struct ChangedRow {
    /// Which.
    pub name: &'static str,
    /// In the earlier log.
    pub before: f64,
    /// In the later one.
    pub after: f64,
    /// Change, percent; not a number where there was none before.
    pub change_percent: f64,
}

/// What changed; `unit` is that of positions, m or rad.
pub fn changed(change: &TrackingChange, unit: &str) -> Changed {
    let (before, after) = (&change.before, &change.after);
    let row = |name, of: fn(&Tracking) -> f64| ChangedRow {
        name,
        before: of(before),
        after: of(after),
        change_percent: 100.0 * (of(after) / of(before) - 1.0),
    };
    let rows = vec![
        row("largest peak at a reversal", Tracking::largest_peak),
        row("median peak", Tracking::median_peak),
        row("rms error", |log| log.rms),
        row("largest error", |log| log.largest),
    ];
    let same = change.differs.is_empty();
    let reversals = counted(after.peaks.len(), "reversal");
    let (verdict, good) = match change.grown.first() {
        Some((time, a, b)) => (
            format!(
                "Worse at {} of {reversals}, most at {} s: {} before, {} after",
                change.grown.len(),
                sig(*time, 3),
                quantity(*a, unit),
                quantity(*b, unit)
            ),
            Some(false),
        ),
        None if same => (format!("Worse at none of {reversals}"), Some(true)),
        None => ("The motions differ".into(), None),
    };
    let mut notes = Vec::new();
    if !same {
        notes.push(format!(
            "The motions differ in {}. Run the same program before and after to see what changed.",
            change.differs.join(", ")
        ));
    }
    if let Some(rate) = change.thinned_to_hz {
        notes.push(format!(
            "The sample rates differ: peaks of the finer log are taken at {} Hz.",
            sig(rate, 3)
        ));
    }
    for log in [before, after] {
        notes.extend(limits(log, unit));
    }
    Changed {
        verdict,
        good,
        rows,
        notes,
    }
}

/// What limits the figures of a log.
fn limits(log: &Tracking, unit: &str) -> Vec<String> {
    let name = shown(&log.log);
    let mut out = Vec::new();
    if log.largest > 0.5 * log.range {
        out.push(format!(
            "{name}: the error is as large as the motion. Check sign and unit of the reference, and whether the position wraps."
        ));
    }
    if log.offset.abs() > log.largest {
        out.push(format!(
            "{name}: errors are without a constant offset of {}.",
            quantity(log.offset, unit)
        ));
    }
    if log.left_out > 0 {
        out.push(format!(
            "{name}: {} skipped, at a gap or in frozen or missing rows.",
            counted(log.left_out, "reversal")
        ));
    }
    if log.rows_left_out > 0 {
        out.push(format!(
            "{name}: {} skipped, frozen or without position or reference.",
            counted(log.rows_left_out, "row")
        ));
    }
    if let Some(step) = log.step.filter(|step| *step > log.largest_peak()) {
        out.push(format!(
            "{name}: encoder steps of {} are larger than the peaks.",
            quantity(step, unit)
        ));
    }
    out
}
