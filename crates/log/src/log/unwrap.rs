//! Unwrapping a position.

use super::overflow;
use crate::findings::{Finding, extremes, full, median, quantum, short};
use crate::mapping::{Source, Wrap};
use crate::{Dimension, Error, Kind};
use stiction_policy::position;
use stiction_say::{Found, Value, WrongWrap};

/// Part of the wrap by which the numbers of a position may go beyond it by rounding.
const ROUNDING: f64 = 1e-3;

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
        (counts / whole - 1.0).abs() <= position::MAX_OVERFLOW_MOTION
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
        .filter(|step| period < position::MIN_WRAP_STEPS * step)
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
/// within half a period of the position; missing samples are passed over. `counts` is the period in counts, where it is given so. Turns made within a gap cannot be known.
pub(super) fn unwrap(
    position: &mut [f64],
    reference: Option<&mut [f64]>,
    (period, counts): (f64, Option<f64>),
    unit: &str,
) -> Finding {
    let wrong = counts
        .and_then(|counts| wrong_counts(position, period, counts))
        .or_else(|| wrong(position, period, unit));
    let wraps = straighten(position, period);
    let reference = reference.is_some_and(|reference| {
        let followed = straighten(reference, period).is_some();
        let moved = beside(position, reference, period);
        followed || moved
    });
    let is_wrong = wrong.is_some();
    let found = Found::Wrapped {
        wraps,
        period: Value::new(period, unit),
        reference,
        wrong,
    };
    let finding = Finding::graded(found, is_wrong);
    match wraps {
        Some((_, first)) => finding.at(first),
        None => finding,
    }
}

/// Why a counter does not begin again after so many counts, if so: it shows more, or is one short of those of its bits.
fn wrong_counts(position: &[f64], period: f64, counts: f64) -> Option<WrongWrap> {
    let (low, high) = extremes(position)?;
    let shown = ((high - low) * counts / period).round() + 1.0;
    let bits = (8..=48).find(|bits| counts + 1.0 == (1_u64 << bits) as f64);
    if bits.is_none() && shown <= counts {
        return None;
    }
    let right = overflow::counts(
        &position
            .iter()
            .map(|x| x * counts / period)
            .collect::<Vec<_>>(),
    );
    Some(match bits {
        Some(bits) => WrongWrap::Bits {
            bits,
            right: right.unwrap_or(1 << bits),
        },
        None => WrongWrap::Counts { shown, right },
    })
}

/// Why a position as it is logged does not begin again after this period, if so.
fn wrong(position: &[f64], period: f64, unit: &str) -> Option<WrongWrap> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    // Steps where it wraps, as they are logged and as they are left, and the longest of the others.
    let (mut logged, mut left, mut longest) = (Vec::new(), Vec::new(), 0.0_f64);
    let mut before: Option<f64> = None;
    for x in position.iter().copied().filter(|x| x.is_finite()) {
        (low, high) = (low.min(x), high.max(x));
        if let Some(before) = before {
            let turns = ((x - before) / period).round();
            if turns != 0.0 {
                logged.push((x - before).abs());
                left.push((x - before - turns * period).abs());
            } else {
                longest = longest.max((x - before).abs());
            }
        }
        before = Some(x);
    }
    let covers_more = high - low > period * (1.0 + ROUNDING);
    let covers = Value::new(high - low, unit);
    let Some(left) = median(&mut left) else {
        return covers_more.then_some(WrongWrap::Beyond { covers });
    };
    let jump = Value::new(median(&mut logged).unwrap_or(0.0), unit);
    if covers_more {
        return Some(WrongWrap::Jumps { covers, jump });
    }
    let left = (left > position::MAX_UNWRAPPED_STEP * longest).then(|| Value::new(left, unit));
    left.map(|left| WrongWrap::Left { left, jump })
}

/// How often a column wrapped, and at which sample first; `None` where it never did.
pub(super) fn straighten(column: &mut [f64], period: f64) -> Option<(usize, usize)> {
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
