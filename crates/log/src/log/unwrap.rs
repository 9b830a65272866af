//! Unwrapping a position.

use crate::findings::{Finding, Severity, count, quantum, short};
use crate::{Error, Kind};
use stiction_codes::Code;

/// Fewest encoder steps of a wrap, so that a step forward is none back.
const LEAST_STEPS: f64 = 2.0;

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
