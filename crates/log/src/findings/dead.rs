//! A force that is zero while the axis moves: the drive was off, and something else moved it.

use super::finding::{Finding, extremes, place};
use crate::log::Log;
use std::ops::Range;
use stiction_codes::Code;
use stiction_policy::force;
use stiction_say::Found;

/// Part of the samples that do not exceed that, and half of them.
const USUAL: f64 = 0.9;
const HALF: f64 = 0.5;
/// What is excluded to either side too, s: a drive that is switched on or off takes its time.
const BESIDE: f64 = 0.05;

/// Excludes stretches in which the axis moves under no force.
pub(super) fn dead(log: &mut Log) {
    let Some(force) = &log.force else { return };
    // Beside the largest forces, and where these are far above all others beside those.
    let sizes = [exceeded(force, USUAL), exceeded(force, HALF)].map(Option::unwrap_or_default);
    let found = sizes.map(|usual| stretches(log, usual, sizes[1]));
    let Some(runs) = found.into_iter().find(|runs| !runs.is_empty()) else {
        return;
    };
    let Some(first) = runs.first() else { return };
    let found = Found::ForceDead {
        stretches: runs.len(),
        samples: runs.iter().map(Range::len).sum(),
        first: place(log, first.start),
        until: log.time[first.end - 1],
    };
    log.findings.push(Finding::warning(found).at(first.start));
    let beside = (BESIDE * log.rate_hz).ceil() as usize;
    for run in runs {
        let last = log.time.len();
        let all = run.start.saturating_sub(beside)..(run.end + beside).min(last);
        log.exclude(all, Code::ForceDead);
    }
}

/// Those stretches beside a usual size of the force, `half` being that of half of the samples.
fn stretches(log: &Log, usual: f64, half: f64) -> Vec<Range<usize>> {
    let (Some(force), Some(position)) = (&log.force, &log.position) else {
        return Vec::new();
    };
    let Some((low, high)) = extremes(position).filter(|_| usual > 0.0) else {
        return Vec::new();
    };
    let is_near = |sample: &usize| force[*sample].abs() <= force::MAX_NEAR_DEAD * usual;
    let mut runs: Vec<Range<usize>> = Vec::new();
    for segment in &log.segments {
        let mut from = segment.start;
        while let Some(start) = (from..segment.end).find(is_near) {
            let end = (start..segment.end).find(|i| !is_near(i));
            let end = end.unwrap_or(segment.end);
            runs.push(start..end);
            from = end;
        }
    }
    let is_off = |run: &Range<usize>| {
        let force = &force[run.clone()];
        let none = force
            .iter()
            .filter(|f| f.abs() <= force::MAX_DEAD * usual)
            .count();
        let mean = force.iter().sum::<f64>() / force.len() as f64;
        none as f64 >= force::MIN_DEAD_SHARE * force.len() as f64
            && mean.abs() <= force::MAX_DEAD_MEAN * usual
            && is_noise(force, force::MAX_DEAD_RMS * half, log.rate_hz)
    };
    let moves = |run: &Range<usize>| {
        let travel = extremes(&position[run.clone()]).map_or(0.0, |(low, high)| high - low);
        let lasts = log.time[run.end - 1] - log.time[run.start];
        run.len() >= force::MIN_DEAD_SAMPLES
            && lasts >= force::MIN_DEAD_TIME
            && travel >= force::MIN_DEAD_TRAVEL * (high - low)
    };
    runs.retain(|run| moves(run) && is_off(run));
    runs
}

/// Whether a force is hardly any, or changes too fast to follow a motion.
fn is_noise(force: &[f64], hardly: f64, rate: f64) -> bool {
    let count = force.len() as f64;
    let square = force.iter().map(|f| f * f).sum::<f64>() / count;
    let later = ((force::NOISE_TIME * rate).round() as usize).max(1);
    let changes = force.iter().zip(force.iter().skip(later));
    let changes = changes.map(|(a, b)| (b - a).powi(2)).sum::<f64>() / count;
    square <= hardly * hardly || 0.5 * changes >= force::MIN_NOISE_CHANGE * square
}

/// What that part of the samples does not exceed in size.
fn exceeded(force: &[f64], part: f64) -> Option<f64> {
    let mut sizes: Vec<f64> = force.iter().map(|f| f.abs()).collect();
    let at = (part * sizes.len() as f64) as usize;
    if at >= sizes.len() {
        return None;
    }
    let size = *sizes.select_nth_unstable_by(at, f64::total_cmp).1;
    Some(size).filter(|size| *size > 0.0)
}
