//! Whether the motion is informative: too short, none, noise, one direction, one speed.

use super::finding::{Finding, extremes};
use crate::log::Log;
use std::borrow::Cow;
use stiction_policy::{rest, signal};
use stiction_say::{Found, Value};
use stiction_signal::{Travel, noise_deviation};

/// Windows whose mean velocities are compared to see whether the axis moves at one speed ...
const SPEED_WINDOWS: usize = 50;

pub(super) fn few_samples(log: &mut Log) {
    let samples = log.time.len();
    if samples < signal::MIN_USEFUL_SAMPLES {
        log.findings.push(Finding::warning(Found::FewSamples {
            samples,
            least: signal::MIN_USEFUL_SAMPLES,
        }));
    }
}

/// At most one of: no motion, noise only, one direction (perhaps at one speed).
pub(super) fn kind_of_motion(log: &mut Log) {
    let found = judge(log);
    log.findings.extend(found.into_iter().map(Finding::warning));
}

fn judge(log: &Log) -> Vec<Found> {
    let (x, channel): (Cow<[f64]>, _) = match (&log.position, &log.velocity) {
        (Some(position), _) => (Cow::Borrowed(position), "position"),
        (None, Some(velocity)) => (Cow::Owned(integral(&log.time, velocity)), "velocity"),
        (None, None) => return Vec::new(),
    };
    let Some((low, high)) = extremes(&x) else {
        return Vec::new();
    };
    let range = high - low;
    let step = log.quantum.unwrap_or(0.0);
    let unit = log.motion.position().si_text();
    if range <= rest::MAX_STEPS * step {
        let range = Value::new(range, unit);
        return vec![Found::NoMotion { channel, range }];
    }
    let judged = log.position.as_ref().or(log.velocity.as_ref());
    if judged.is_some_and(|values| {
        values.len() >= signal::MIN_USEFUL_SAMPLES / 2
            && neighbour_correlation(values) < signal::MIN_NEIGHBOUR_CORRELATION
    }) {
        return vec![Found::Noise { channel }];
    }
    let mut found = Vec::new();
    if travel(log, &x, step).is_one_way() {
        let range = Value::new(range, unit);
        found.push(Found::OneDirection { range });
    }
    if let Some(speed) = one_speed(&log.time, &x) {
        let speed = Value::new(speed, log.motion.velocity().si_text());
        found.push(Found::OneSpeed { speed });
    }
    found
}

fn integral(time: &[f64], velocity: &[f64]) -> Vec<f64> {
    let mut x = 0.0;
    let steps = time.windows(2).zip(velocity.windows(2)).map(|(t, v)| {
        x += 0.5 * (v[0] + v[1]) * (t[1] - t[0]);
        x
    });
    std::iter::once(0.0).chain(steps).collect()
}

/// Correlation of each sample with the next.
fn neighbour_correlation(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let power: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    let next: f64 = values
        .windows(2)
        .map(|w| (w[0] - mean) * (w[1] - mean))
        .sum();
    if power > 0.0 { next / power } else { 1.0 }
}

/// How far the axis travels each way, from jump to jump of the position.
fn travel(log: &Log, x: &[f64], step: f64) -> Travel {
    let stretches = || log.segments.iter().filter_map(|s| x.get(s.clone()));
    let shortest = match &log.velocity {
        Some(velocity) if log.position.is_none() => {
            // White noise of the velocity makes the position that it is integrated to walk at random.
            let seconds = log.time[velocity.len() - 1] - log.time[0];
            let noise = noise_deviation(std::iter::once(&velocity[..]));
            Travel::shortest_integrated(noise, seconds, velocity.len())
        }
        _ => Travel::shortest_movement(step, noise_deviation(stretches())),
    };
    let travel = stretches().map(|x| Travel::of(x.iter().copied(), shortest));
    travel.fold(Travel::default(), Travel::and)
}

/// The speed, where windows over the whole record all have nearly the same.
fn one_speed(time: &[f64], x: &[f64]) -> Option<f64> {
    let windows = SPEED_WINDOWS.min((x.len() - 1) / 4);
    if windows < 4 {
        return None;
    }
    let edge = |k: usize| k * (x.len() - 1) / windows;
    let speeds: Vec<f64> = (0..windows)
        .map(|k| (x[edge(k + 1)] - x[edge(k)]) / (time[edge(k + 1)] - time[edge(k)]))
        .collect();
    let (low, high) = extremes(&speeds)?;
    let mean = speeds.iter().sum::<f64>() / windows as f64;
    (high - low < signal::MAX_SPEED_SPREAD * mean.abs()).then_some(mean)
}

/// Columns that never change though something moves.
pub(super) fn constant_columns(log: &mut Log) {
    let columns = [
        ("velocity", &log.velocity),
        ("force", &log.force),
        ("reference", &log.reference),
    ];
    let mut found = Vec::new();
    for (channel, values) in columns {
        let Some((low, high)) = values.as_deref().and_then(extremes) else {
            continue;
        };
        if low == high {
            let constant = Found::Constant {
                channel,
                value: low,
            };
            found.push(Finding::graded(constant, channel != "reference"));
        }
    }
    log.findings.extend(found);
}
