//! Encoder steps, and jumps of the position that no motion explains.

use super::finding::{Finding, extremes, place};
use crate::log::{Log, overflow};
use crate::mapping::{Mapping, Motion, Role, Selector};
use std::f64::consts::TAU;
use stiction_policy::position;
use stiction_say::{Found, Jump, Value};

/// The quantum of a quantised signal, in its own unit; `None` where it is continuous or too short to tell.
/// Samples where `skip` is true are left out.
pub(crate) fn quantum(values: &[f64], skip: &[bool]) -> Option<f64> {
    let (low, high) = extremes(values)?;
    // Differences below the rounding of the numbers themselves are not steps.
    let fuzz = 8.0 * f64::EPSILON * low.abs().max(high.abs());
    let steps = || {
        let pairs = values.windows(2).zip(skip.windows(2));
        pairs
            .filter(|(_, skipped)| !skipped[0] && !skipped[1])
            .map(|(w, _)| (w[1] - w[0]).abs())
            .filter(move |d| *d > fuzz)
    };
    let smallest = steps().min_by(f64::total_cmp)?;
    let limit = position::MAX_SMALL_DIFFERENCE * smallest;
    let mut quantum = smallest;
    for _ in 0..3 {
        let (mut kd, mut kk) = (0.0, 0.0);
        for d in steps().filter(|d| *d <= limit) {
            let k = (d / quantum).round();
            kd += k * d;
            kk += k * k;
        }
        quantum = kd / kk;
    }
    let (mut squares, mut seen) = (0.0, 0_usize);
    for d in steps().filter(|d| *d <= limit) {
        let ratio = d / quantum;
        squares += (ratio - ratio.round()) * (ratio - ratio.round());
        seen += 1;
    }
    let near = (squares / seen.max(1) as f64).sqrt() <= position::MAX_RMS_OFF_WHOLE;
    (seen >= position::MIN_SMALL_DIFFERENCES && near && quantum > 0.0).then_some(quantum)
}

/// Estimates the encoder step, or takes the one that is given.
pub(super) fn steps(log: &mut Log, mapping: &Mapping) {
    let Some(position) = &log.position else {
        return;
    };
    let Some((low, high)) = extremes(position) else {
        return;
    };
    let unit = log.motion.position().si_text();
    let range = high - low;
    log.quantum = mapping
        .resolution
        .or_else(|| quantum(position, &log.skipped()));
    let Some(step) = log.quantum else { return };
    log.findings.push(Finding::note(Found::Quantised {
        step,
        range,
        unit,
        given: mapping.resolution.is_some(),
    }));
    let degrees = in_degrees(log, step);
    log.findings.extend(degrees);
    if range > 0.0 && range / step < position::MIN_TRAVEL_STEPS {
        let steps = (range / step).round();
        log.findings
            .push(Finding::warning(Found::FewSteps { steps }));
    }
}

/// Bits of an encoder that turns.
const ENCODER_BITS: std::ops::RangeInclusive<u32> = 8..=32;

/// That an angle which is read in radians has the steps of an encoder in degrees, 360/2^n.
fn in_degrees(log: &Log, step: f64) -> Option<Finding> {
    let channel = log.mapping.position.as_ref()?;
    let unit = channel.unit.as_ref()?;
    let is_plain = log.motion == Motion::Rotary && unit.factor() == 1.0 && channel.scale.is_none();
    let bits = ENCODER_BITS
        .into_iter()
        .find(|bits| {
            (step * (1_u64 << bits) as f64 / 360.0 - 1.0).abs() <= position::MAX_BITS_ERROR
        })
        .filter(|_| is_plain)?;
    let of = log
        .columns
        .iter()
        .find(|c| c.role == Some(Role::Position))?;
    let column = match &channel.column {
        Selector::Name(name) => format!("\"{name}\""),
        Selector::Index(number) => number.to_string(),
    };
    Some(Finding::warning(Found::StepsOfDegrees {
        place: of.column.clone(),
        column,
        step,
        bits,
    }))
}

/// A position that begins again: after which travel, and why.
struct Again {
    period: f64,
    cause: Jump,
}

/// Where the position begins again though the axis file has no wrap: a counter that overflows, or an angle after each turn.
fn again(log: &Log, position: &[f64]) -> Option<Again> {
    if log.wrap.is_some() {
        return None;
    }
    if let Some(counts) = log.counts().as_deref().and_then(overflow::counts) {
        let count = log.mapping.position.as_ref()?.scale.as_ref()?.si().abs();
        return Some(Again {
            period: counts as f64 * count,
            cause: Jump::Counter(counts),
        });
    }
    let turns = log.motion == Motion::Rotary && overflow::begins_again(position, TAU);
    turns.then_some(Again {
        period: TAU,
        cause: Jump::Turn,
    })
}

/// Whether the position begins again though the axis file has no wrap.
pub(crate) fn begins_again(log: &Log, position: &[f64]) -> bool {
    again(log, position).is_some()
}

/// Finds jumps of the position and splits the record there.
pub(super) fn jumps(log: &mut Log) {
    let Some(position) = &log.position else {
        return;
    };
    let Some((low, high)) = extremes(position) else {
        return;
    };
    let again = again(log, position);
    let bound = position::MIN_JUMP * again.as_ref().map_or(high - low, |again| again.period);
    let steps = || {
        position
            .windows(2)
            .enumerate()
            .filter(|(i, _)| !log.gap_after(*i))
    };
    let (mut small, mut smalls) = (0.0, 0_usize);
    let mut jumps = Vec::new();
    for (index, w) in steps() {
        let size = (w[1] - w[0]).abs();
        if size > bound {
            jumps.push(index);
        } else {
            small += size;
            smalls += 1;
        }
    }
    let mean = small / smalls.max(1) as f64;
    let Some(&first) = jumps.first() else { return };
    // A record with few other samples has no usual step to compare with.
    let is_usual =
        bound <= position::MIN_JUMP_IN_MEAN_STEPS * mean || smalls < position::MIN_ORDINARY_STEPS;
    if is_usual && again.is_none() {
        return;
    }
    let unit = log.motion.position().si_text();
    let size = (position[first + 1] - position[first]).abs();
    let cause = match again {
        Some(again) => again.cause,
        None => log.counter(size).map_or(Jump::Unknown, Jump::Counter),
    };
    let found = Found::Jumps {
        jumps: jumps.len(),
        size: Value::new(size, unit),
        after: place(log, first),
        cause,
    };
    log.findings.push(Finding::warning(found).at(first));
    log.split(&jumps.iter().map(|jump| jump + 1).collect::<Vec<_>>());
}
