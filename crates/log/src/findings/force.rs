//! A force that saturates, and a force with the wrong sign.

use super::encoder::quantum;
use super::finding::{Finding, extremes, place};
use crate::log::Log;
use crate::mapping::Mapping;
use std::ops::Range;
use stiction_codes::Code;
use stiction_policy::force;
use stiction_say::{Found, Turn, Value};

/// Most values of a force that are told apart.
const MOST_LEVELS: usize = 64;

/// Finds stretches where the force saturates and excludes them.
pub(super) fn saturation(log: &mut Log, mapping: &Mapping) {
    let Some(force) = &log.force else { return };
    let (runs, limit) = match mapping.force_limit {
        Some(limit) => {
            let saturated = |x: f64| x.abs() >= force::MIN_SATURATED * limit;
            (runs_where(force, 1, saturated), limit)
        }
        None => match extremes(force) {
            Some((low, high)) if low < high => {
                (saturated_runs(force, low, high), low.abs().max(high.abs()))
            }
            _ => return,
        },
    };
    let Some(first) = runs.first().cloned() else {
        return;
    };
    let found = Found::Saturated {
        limit: Value::new(limit, &log.force_unit),
        samples: runs.iter().map(Range::len).sum(),
        stretches: runs.len(),
        first: place(log, first.start),
    };
    log.findings.push(Finding::warning(found).at(first.start));
    for run in runs {
        log.exclude(run, Code::Saturation);
    }
}

/// Flat stretches at the extremes of a signal that is not a staircase.
fn saturated_runs(force: &[f64], low: f64, high: f64) -> Vec<Range<usize>> {
    let at = |level: f64| runs_where(force, force::MIN_FLAT_SAMPLES, move |x| x == level);
    let (lows, highs) = (at(low), at(high));
    let held: usize = lows.iter().chain(&highs).map(Range::len).sum();
    if held == 0 {
        return Vec::new();
    }
    // A commanded staircase rests at other levels as well; a signal that rests at 0 is switched off.
    let elsewhere: usize = flat_elsewhere(force, low, high)
        .filter(|(x, _)| *x != 0.0)
        .map(|(_, n)| n)
        .sum();
    if elsewhere > held / 2 {
        return Vec::new();
    }
    let steps = || {
        force
            .windows(2)
            .map(|w| (w[1] - w[0]).abs())
            .filter(|d| *d > 0.0)
    };
    let smallest = steps().fold(f64::INFINITY, f64::min);
    let held_long = held as f64 > force::MIN_HELD_SHARE * force.len() as f64
        && (high - low) / smallest >= force::MIN_LEVELS;
    let steep = |run: &Range<usize>| {
        let enters = run.start > 0
            && (force[run.start] - force[run.start - 1]).abs()
                > force::MIN_SATURATION_STEPS * smallest;
        let leaves = run.end < force.len()
            && (force[run.end] - force[run.end - 1]).abs() > force::MIN_SATURATION_STEPS * smallest;
        enters || leaves
    };
    // Zero as an extreme is a force that is off, or one that only ever pushes.
    let mut runs: Vec<_> = [(low, lows), (high, highs)]
        .into_iter()
        .filter(|(level, _)| *level != 0.0)
        .flat_map(|(_, runs)| runs)
        .filter(|run| held_long || steep(run))
        .collect();
    runs.sort_by_key(|run| run.start);
    runs
}

/// Stretches of at least `shortest` samples where a test holds.
fn runs_where(values: &[f64], shortest: usize, test: impl Fn(f64) -> bool) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let mut start = None;
    for i in 0..=values.len() {
        let inside = values.get(i).is_some_and(|x| test(*x));
        match (inside, start) {
            (true, None) => start = Some(i),
            (false, Some(from)) => {
                if i - from >= shortest {
                    runs.push(from..i);
                }
                start = None;
            }
            _ => {}
        }
    }
    runs
}

/// Level and length of flat stretches that are not at an extreme.
fn flat_elsewhere(force: &[f64], low: f64, high: f64) -> impl Iterator<Item = (f64, usize)> {
    force
        .chunk_by(|a, b| a == b)
        .filter(move |run| run.len() >= force::MIN_FLAT_SAMPLES && run[0] != low && run[0] != high)
        .map(|run| (run[0], run.len()))
}

/// The values that a force takes, rising, as far as there are at most some tens.
pub(crate) fn levels(force: &[f64]) -> Vec<f64> {
    let mut levels: Vec<f64> = Vec::new();
    for x in force.iter().filter(|x| x.is_finite()) {
        if levels.len() > MOST_LEVELS {
            break;
        }
        // No two zeros.
        let x = x + 0.0;
        if let Err(at) = levels.binary_search_by(|level| level.total_cmp(&x)) {
            levels.insert(at, x);
        }
    }
    levels
}

/// Names a force whose steps are coarse beside its range: friction below a step does not show, and the error of a step has the
/// sign of the motion for as long as the force hardly changes.
pub(super) fn steps(log: &mut Log) {
    let Some(force) = &log.force else { return };
    let Some((low, high)) = extremes(force) else {
        return;
    };
    let levels = levels(force);
    // A force that goes to one level, and back, is a step as it was commanded: it has no rounding to see.
    let changes = force.windows(2).filter(|w| w[0] != w[1]).count();
    if levels.len() == 2 && changes <= force::MAX_STEP_CHANGES {
        return;
    }
    // A force that changes seldom shows too few steps to tell one by, but has few values.
    let few = (2..force::MIN_SELDOM_VALUES).contains(&levels.len());
    let closest = || {
        levels
            .windows(2)
            .map(|w| w[1] - w[0])
            .min_by(f64::total_cmp)
    };
    let step = quantum(force, &log.skipped()).or_else(|| closest().filter(|_| few));
    let Some(step) = step.filter(|step| (high - low) / step < force::MIN_RANGE_STEPS) else {
        return;
    };
    let found = Found::CoarseForce {
        step: Value::new(step, &log.force_unit),
        range: high - low,
        few: log.has_few_force_levels(),
    };
    log.findings.push(Finding::warning(found));
}

/// Says of a force that brakes, and comes from another file by time stamps whose offset nothing tells, that its clock may be the
/// cause.
pub(crate) fn sign_of_another_clock(findings: &mut [Finding]) {
    for finding in findings {
        if let Found::ForceBrakes { turn, .. } = &mut finding.kind {
            *turn = Turn::Clock;
        }
    }
}

/// Whether a force is the magnitude of one that changes its sign: it has one sign, falls to nearly nothing, and is the same both ways
/// but for this part. A stretch without force is a drive that was off.
fn is_magnitude(log: &Log, force: &[f64], difference: f64) -> bool {
    let one_sign = [1.0, -1.0].map(|sign| force.iter().all(|f| sign * f >= 0.0 || f.is_nan()));
    let sizes = || force.iter().map(|f| f.abs()).filter(|f| f.is_finite());
    let mean = sizes().sum::<f64>() / sizes().count().max(1) as f64;
    let alike = mean > 0.0 && difference <= force::MAX_UNSIGNED_DIFFERENCE;
    if !alike || !one_sign.contains(&true) {
        return false;
    }
    let off = (force::MIN_DEAD_TIME * log.rate_hz).max(1.0) as usize;
    let runs = runs_where(force, off, |f| f == 0.0);
    let mut driven = vec![true; force.len()];
    runs.into_iter().for_each(|run| driven[run].fill(false));
    let low = force.iter().zip(driven).filter(|(_, driven)| *driven);
    low.map(|(f, _)| f.abs()).fold(f64::INFINITY, f64::min) <= force::MAX_UNSIGNED_LOW * mean
}

/// Compares work done along and against the motion: a force that drives an axis with friction
/// puts energy in. Only for motion to and fro, since a weight may well brake one way; a jump of the position is no motion.
pub(super) fn sign(log: &mut Log) {
    let Some(force) = &log.force else { return };
    let (mut net, mut gross, mut travel, mut path) = (0.0, 0.0, 0.0_f64, 0.0);
    for i in log.segments.iter().flat_map(|part| part.clone().skip(1)) {
        let moved = match (&log.position, &log.velocity) {
            (Some(x), _) => x[i] - x[i - 1],
            (None, Some(v)) => 0.5 * (v[i] + v[i - 1]) * (log.time[i] - log.time[i - 1]),
            (None, None) => return,
        };
        if log.gap_after(i - 1) {
            continue;
        }
        let work = 0.5 * (force[i] + force[i - 1]) * moved;
        net += work;
        gross += work.abs();
        travel += moved;
        path += moved.abs();
    }
    let to_and_fro = travel.abs() < force::MAX_NET_TRAVEL * path;
    // Of a force that never changes its sign the work each way is its mean times the travel.
    let [ahead, back] = [1.0, -1.0].map(|way| (gross + way * net) / (path + way * travel));
    if to_and_fro && is_magnitude(log, force, (ahead - back).abs() / (ahead + back)) {
        let reference = log.reference.is_some();
        log.findings
            .push(Finding::warning(Found::Magnitude { reference }));
        return;
    }
    if net < force::MIN_NET_WORK * gross && to_and_fro {
        let inverted =
            log.mapping.force.as_ref().is_some_and(|f| {
                f.invert != f.scale.as_ref().is_some_and(|scale| scale.number < 0.0)
            });
        let found = Found::ForceBrakes {
            part: -net / gross,
            turn: if inverted { Turn::Undo } else { Turn::Invert },
        };
        log.findings.push(Finding::warning(found));
    }
}
