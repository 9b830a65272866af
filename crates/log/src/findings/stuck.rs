//! An encoder that is frozen while the axis moves.
//!
//! A constant position alone is rest, and a constant position under a rising force is stiction: exactly
//! what is to be measured. A position is frozen where it contradicts another signal:
//!
//! 1. the velocity says that the axis travelled meanwhile: its integral covers more than 10 encoder steps
//!    and 1 % of the range, at more than 5 % of the rms speed, smoothly (neighbouring samples
//!    correlate above 0.5, which noise around rest does not);
//! 2. or the position continues with a jump of more than 3 times any ordinary step, which inertia
//!    does not allow after rest;
//! 3. or it is frozen to the end of the record while the reference still covers half its range,
//!    though the position had followed it before.

use super::finding::{Finding, extremes, place};
use crate::log::Log;
use std::ops::Range;
use stiction_codes::Code;
use stiction_policy::{position, signal};
use stiction_say::{Found, Moving, Value};

pub(super) fn stuck(log: &mut Log) {
    let found = frozen(log);
    let Some(first) = found.first() else { return };
    let stuck = Found::Stuck {
        stretches: found.len(),
        samples: found.iter().map(|(run, _)| run.len()).sum(),
        moving: first.1.clone(),
        first: place(log, first.0.start),
    };
    let finding = Finding::warning(stuck).at(first.0.start);
    log.findings.push(finding);
    for (run, _) in found {
        log.exclude(run, Code::StuckEncoder);
    }
}

fn frozen(log: &Log) -> Vec<(Range<usize>, Moving)> {
    let Some(position) = &log.position else {
        return Vec::new();
    };
    let Some((low, high)) = extremes(position) else {
        return Vec::new();
    };
    let range = high - low;
    let step = log.quantum.unwrap_or(0.0);
    let runs = flat_runs(position, log);
    let ordinary = ordinary_step(position, &runs, log);
    let rms = log.velocity.as_deref().map_or(0.0, rms);
    let unit = log.motion.position().si_text();
    let least = (position::MIN_FROZEN_TRAVEL_STEPS * step).max(position::MIN_FROZEN_TRAVEL * range);
    let mut found = Vec::new();
    for run in runs {
        if let Some(velocity) = &log.velocity {
            let travelled = travelled(&log.time[run.clone()], &velocity[run.clone()], rms);
            if let Some(x) = travelled.filter(|x| *x > least) {
                found.push((run, Moving::Velocity(Value::new(x, &unit))));
                continue;
            }
        }
        if run.end < position.len() && !log.gap_after(run.end - 1) {
            let jump = (position[run.end] - position[run.end - 1]).abs();
            if ordinary > 0.0 && jump > position::MIN_FROZEN_JUMP * ordinary.max(step) {
                found.push((run, Moving::Jump(Value::new(jump, &unit))));
            }
        } else if run.end == position.len()
            && let Some(reference) = &log.reference
        {
            let whole = span(reference);
            let meanwhile = span(&reference[run.clone()]);
            if whole > 0.0
                && meanwhile > position::MIN_FROZEN_REFERENCE * whole
                && range > position::MIN_FROZEN_REFERENCE * whole
            {
                found.push((run, Moving::Reference(Value::new(meanwhile, &unit))));
            }
        }
    }
    found
}

/// Stretches of equal positions, long enough, with no gap inside.
fn flat_runs(position: &[f64], log: &Log) -> Vec<Range<usize>> {
    let gap = |sample| log.gap_after(sample);
    let mut runs = Vec::new();
    let mut start = 0;
    for i in 1..=position.len() {
        let goes_on = i < position.len() && position[i] == position[i - 1] && !gap(i - 1);
        if !goes_on {
            if i - start >= position::MIN_FROZEN_SAMPLES {
                runs.push(start..i);
            }
            start = i;
        }
    }
    runs
}

/// The largest step of the position that does not end a flat stretch and spans no gap.
fn ordinary_step(position: &[f64], runs: &[Range<usize>], log: &Log) -> f64 {
    let gap = |sample| log.gap_after(sample);
    let mut ends = runs.iter().map(|r| r.end - 1).peekable();
    let mut largest: f64 = 0.0;
    for (i, w) in position.windows(2).enumerate() {
        let after_flat = ends.next_if_eq(&i).is_some();
        if !after_flat && !gap(i) {
            largest = largest.max((w[1] - w[0]).abs());
        }
    }
    largest
}

/// How far the velocity travels in a stretch; `None` where it is rest, noise or a constant offset.
fn travelled(time: &[f64], velocity: &[f64], usual: f64) -> Option<f64> {
    let n = velocity.len() as f64;
    let mean = velocity.iter().sum::<f64>() / n;
    let size = velocity.iter().map(|v| v.abs()).sum::<f64>() / n;
    let power: f64 = velocity.iter().map(|v| v * v).sum();
    let spread: f64 = velocity.iter().map(|v| (v - mean) * (v - mean)).sum();
    let neighbours: f64 = velocity.windows(2).map(|w| w[0] * w[1]).sum();
    let varies = spread > position::MAX_CONSTANT_VARIANCE * power;
    if size <= position::MIN_FROZEN_SPEED * usual
        || neighbours <= signal::MIN_NEIGHBOUR_CORRELATION * power
        || !varies
    {
        return None;
    }
    let (mut x, mut low, mut high) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (t, v) in time.windows(2).zip(velocity.windows(2)) {
        x += 0.5 * (v[0] + v[1]) * (t[1] - t[0]);
        low = low.min(x);
        high = high.max(x);
    }
    Some(high - low)
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

fn span(values: &[f64]) -> f64 {
    extremes(values).map_or(0.0, |(low, high)| high - low)
}
