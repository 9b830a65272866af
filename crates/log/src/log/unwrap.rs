//! Unwrapping a position.

use crate::findings::{Finding, Severity, count, full, quantum, short};
use crate::mapping::{Source, Wrap};
use crate::{Dimension, Error, Kind};
use stiction_codes::Code;

/// Fewest encoder steps of a wrap, so that a step forward is none back.
const LEAST_STEPS: f64 = 2.0;
/// Part of a counter that an axis may move within a sample, where a jump is taken for its overflow.
const NEARLY_WHOLE: f64 = 0.1;

/// The travel after which a position from this column repeats, m or rad.
pub(crate) fn period(wrap: Wrap, source: Option<&Source>) -> Result<f64, Error> {
    let counts = match wrap {
        Wrap::Travel(travel) => return Ok(travel),
        Wrap::Counts(counts) => counts,
    };
    let unit = source.map(|source| &source.unit);
    match source {
        Some(source) if source.unit.dimension() == Dimension::COUNTS => {
            Ok(source.si_difference(counts).abs())
        }
        _ => {
            let unit = unit.map_or(String::from("no unit"), ToString::to_string);
            let found = format!(
                "wrap is {} counts, and the position is in {unit}",
                full(counts)
            );
            let allowed = "counts for a position in counts with a scale, such as { column = \"NAME\", unit = \"counts\", scale = \"0.1 um/count\" }; else the travel itself, such as wrap = \"360 deg\"";
            Err(Error::new(Kind::Unit, found, allowed)
                .in_column("position")
                .of_setting("log.wrap"))
        }
    }
}

/// The bits of a counter that makes jumps of this size: the last step before a jump belongs to it too.
pub(crate) fn bits(jump: f64, count: f64) -> Option<u32> {
    let counts = (jump / count).abs();
    (8..=48).find(|bits| {
        let whole = (1_u64 << bits) as f64;
        (counts / whole - 1.0).abs() <= NEARLY_WHOLE
    })
}

/// Refuses a period that the encoder does not resolve: its step is as given, or as the data show it.
pub(super) fn resolved(
    position: &[f64],
    period: f64,
    given: Option<f64>,
    unit: &str,
) -> Result<(), Error> {
    let shown = || quantum(position, &vec![false; position.len()]);
    let Some(step) = given
        .or_else(shown)
        .filter(|step| period < LEAST_STEPS * step)
    else {
        return Ok(());
    };
    let (period, step) = (short(period), short(step));
    let found = format!("wrap is {period} {unit}, and the position has steps of {step} {unit}");
    let allowed = "the travel after which the position begins again, at least two steps of the encoder; without [log] wrap \
                   nothing is unwrapped";
    Err(Error::new(Kind::Value, found, allowed)
        .in_column("position")
        .of_setting("log.wrap"))
}

/// Adds whole periods to a position so that no step is longer than half a period, and to its reference the same way, which ends up
/// within half a period of the position; missing samples are passed over. Turns made within a gap cannot be known.
pub(super) fn unwrap(
    position: &mut [f64],
    reference: Option<&mut [f64]>,
    period: f64,
    unit: &str,
) -> Finding {
    let wraps = straighten(position, period);
    let likewise = reference.is_some_and(|reference| {
        let followed = straighten(reference, period).is_some();
        let moved = beside(position, reference, period);
        followed || moved
    });
    let likewise = match likewise {
        true => "; the reference likewise",
        false => "",
    };
    let period = short(period);
    let Some((wraps, first)) = wraps else {
        let message = format!(
            "position never wraps: no step is longer than half the wrap of {period} {unit}; nothing was unwrapped{}",
            likewise.replace("likewise", "was")
        );
        return Finding::new(Code::PositionWrap, Severity::Note, message);
    };
    let message = format!(
        "position wrapped {}, first at sample {first}; unwrapped with a period of {period} {unit}{likewise}",
        count(wraps, "time")
    );
    Finding::new(Code::PositionWrap, Severity::Note, message).at(first)
}

/// How often a column wrapped, and at which sample first; `None` where it never did.
fn straighten(column: &mut [f64], period: f64) -> Option<(usize, usize)> {
    let mut turns = 0.0;
    let mut before: Option<f64> = None;
    let mut wraps: Option<(usize, usize)> = None;
    let known = column.iter_mut().enumerate();
    for (index, x) in known.filter(|(_, x)| x.is_finite()) {
        if let Some(before) = before {
            let passed = ((*x - before) / period).round();
            if passed != 0.0 {
                turns -= passed;
                let (many, first) = wraps.unwrap_or((0, index));
                wraps = Some((many + 1, first));
            }
        }
        before = Some(*x);
        *x += turns * period;
    }
    wraps
}

/// Moves a reference by the whole periods that it is away from the position, in the middle of all samples.
fn beside(position: &[f64], reference: &mut [f64], period: f64) -> bool {
    let both = position.iter().zip(reference.iter());
    let mut apart: Vec<f64> = both.map(|(x, r)| x - r).filter(|d| d.is_finite()).collect();
    if apart.is_empty() {
        return false;
    }
    let middle = apart.len() / 2;
    let (_, median, _) = apart.select_nth_unstable_by(middle, f64::total_cmp);
    let turns = (*median / period).round();
    reference.iter_mut().for_each(|r| *r += turns * period);
    turns != 0.0
}
