//! How the following of a reference changed between two logs, for whoever shows it with elements of its own.

use super::turns;
use stiction_number::{counted, four_digits as short};
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

/// What changed on a linear or rotary axis.
pub fn changed(change: &TrackingChange, kind: &str) -> Changed {
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
        row("rms error of the motion", |log| log.rms),
        row("largest error", |log| log.largest),
    ];
    let same = change.differs.is_empty();
    let reversals = counted(after.peaks.len(), "reversal");
    let (verdict, good) = match worst(change, kind) {
        Some(worst) => (format!("Worse {worst}"), Some(false)),
        None if same => (format!("Worse at none of {reversals}"), Some(true)),
        None => ("The motions differ".into(), None),
    };
    let mut notes = Vec::new();
    if let Some(rate) = change.thinned_to_hz {
        notes.push(format!(
            "the rates differ, {} and {} Hz: peaks and largest error of the finer log are those at the rows that {} Hz show",
            short(before.rate_hz),
            short(after.rate_hz),
            short(rate)
        ));
    }
    notes.extend(limits(before, kind));
    notes.extend(limits(after, kind));
    if !same {
        notes.push(format!(
            "the motions differ ({}): the same program before and after shows what changed",
            change.differs.join(", ")
        ));
    }
    Changed {
        verdict,
        good,
        rows,
        notes,
    }
}

/// At how many reversals the error has grown, and where most; `None` where at none.
pub(super) fn worst(change: &TrackingChange, kind: &str) -> Option<String> {
    let (time, a, b) = change.grown.first()?;
    let reversals = counted(change.after.peaks.len(), "reversal");
    Some(format!(
        "at {} of {reversals}, most at {} s: {} before, {} after",
        change.grown.len(),
        short(*time),
        micro(*a, kind),
        micro(*b, kind)
    ))
}

/// An error in micrometres or microradians.
pub(super) fn micro(x: f64, kind: &str) -> String {
    let unit = match kind {
        "rotary" => "urad",
        _ => "um",
    };
    format!("{} {unit}", short(1e6 * x))
}

/// What limits the figures of a log.
fn limits(own: &Tracking, kind: &str) -> Vec<String> {
    let log = &own.log;
    let mut out = Vec::new();
    if own.offset.abs() > own.largest {
        let why = match turns(own.offset).filter(|_| kind == "rotary") {
            Some(turns) => format!(
                "{turns} between position and reference, of which one wraps; wrap = \"360 deg\" under [log] in the axis file puts both together"
            ),
            None => "an encoder whose zero is elsewhere".into(),
        };
        let median = micro(own.offset, kind);
        out.push(format!(
            "the errors of {log} are without their median of {median}: {why}"
        ));
    }
    if own.left_out > 0 {
        out.push(format!(
            "{} of {} reversals of {log} are left out: beside a gap, or in rows that are frozen or missing",
            own.left_out,
            own.left_out + own.peaks.len()
        ));
    }
    if own.rows_left_out > 0 {
        let rows = counted(own.rows_left_out, "row");
        out.push(format!(
            "{rows} of the motion of {log} left out: frozen, or without a position or reference"
        ));
    }
    if let Some(step) = own.step.filter(|step| *step > own.largest_peak()) {
        let steps = micro(step, kind);
        out.push(format!(
            "the encoder of {log} has steps of {steps}, larger than its peaks: they limit what the figures show"
        ));
    }
    if own.largest > 0.5 * own.range {
        out.push(format!(
            "the errors of {log} are as large as its motion: look at sign and unit of the reference, and whether the position wraps (wrap under [log] in the axis file)"
        ));
    }
    out
}
