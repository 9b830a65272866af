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

/// Adds whole periods so that no step is longer than half a period; missing samples are passed
/// over. Turns made within a gap cannot be known.
pub(super) fn unwrap(position: &mut [f64], period: f64, unit: &str) -> Finding {
    let mut turns = 0.0;
    let mut before: Option<f64> = None;
    let (mut wraps, mut first) = (0_usize, 0);
    for (index, x) in position
        .iter_mut()
        .enumerate()
        .filter(|(_, x)| x.is_finite())
    {
        if let Some(before) = before {
            let passed = ((*x - before) / period).round();
            if passed != 0.0 {
                turns -= passed;
                if wraps == 0 {
                    first = index;
                }
                wraps += 1;
            }
        }
        before = Some(*x);
        *x += turns * period;
    }
    let period = short(period);
    if wraps == 0 {
        let message = format!(
            "position never wraps: no step is longer than half the wrap of {period} {unit}; nothing was unwrapped"
        );
        return Finding::new(Code::PositionWrap, Severity::Note, message);
    }
    let message = format!(
        "position wrapped {}, first at sample {first}; unwrapped with a period of {period} {unit}",
        count(wraps, "time")
    );
    Finding::new(Code::PositionWrap, Severity::Note, message).at(first)
}
