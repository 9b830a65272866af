//! Single steps of a moving position that no motion makes: counts that an encoder lost or a transmission garbled.

use super::finding::{Finding, place};
use crate::log::Log;
use stiction_policy::position;
use stiction_say::{Found, Jump, Value};
use stiction_signal::noise_deviation;

/// Steps to either side that one is compared with.
const NEIGHBOURS: usize = 5;

/// Finds such steps and splits the record there.
pub(super) fn strays(log: &mut Log) {
    let Some(x) = &log.position else { return };
    let noise = noise_deviation(log.segments.iter().filter_map(|s| x.get(s.clone())));
    let unit = log.quantum.unwrap_or(0.0).max(noise);
    if unit.is_nan() || unit <= 0.0 {
        return;
    }
    let mut found = Vec::new();
    for segment in &log.segments {
        let Some(x) = x.get(segment.clone()) else {
            continue;
        };
        let times = log.time[segment.clone()].windows(2);
        // Over a few lost rows it moves on for as long as the time says.
        let samples = times.map(|t| ((t[1] - t[0]) * log.rate_hz).max(1.0));
        let steps = x.windows(2).zip(samples).map(|(x, n)| (x[1] - x[0]) / n);
        let steps: Vec<f64> = steps.collect();
        let middles = NEIGHBOURS..steps.len().saturating_sub(NEIGHBOURS);
        found.extend(
            middles
                .filter(|&i| stray(&steps, i, unit))
                .map(|i| segment.start + i),
        );
        if found.len() > position::MAX_STRAYS {
            return;
        }
    }
    let Some(&first) = found.first() else { return };
    let jumps = Found::Jumps {
        jumps: found.len(),
        size: Value::new(x[first + 1] - x[first], log.motion.position().si_text()),
        after: place(log, first),
        cause: Jump::Stray,
    };
    log.findings.push(Finding::warning(jumps).at(first));
    log.split(&found.iter().map(|i| i + 1).collect::<Vec<_>>());
}

/// Whether a step is off its neighbours by more than they differ among each other.
fn stray(steps: &[f64], i: usize, unit: f64) -> bool {
    let near = &steps[i - NEIGHBOURS..=i + NEIGHBOURS];
    let mut others = [0.0; 2 * NEIGHBOURS];
    others[..NEIGHBOURS].copy_from_slice(&near[..NEIGHBOURS]);
    others[NEIGHBOURS..].copy_from_slice(&near[NEIGHBOURS + 1..]);
    others.sort_by(f64::total_cmp);
    let usual = 0.5 * (others[NEIGHBOURS - 1] + others[NEIGHBOURS]);
    let mut differences = others.map(|step| (step - usual).abs());
    differences.sort_by(f64::total_cmp);
    // All but one: a single sample that is off makes two such steps, there and back.
    let spread = differences[2 * NEIGHBOURS - 2];
    let off = (steps[i] - usual).abs();
    usual.abs() >= position::MIN_STRAY_MOTION * unit
        && off > position::MIN_STRAY_COUNTS * unit
        && off > position::MIN_STRAY_OF_USUAL * usual.abs()
        && off > position::MIN_STRAY_OF_NEIGHBOURS * spread.max(unit)
}
