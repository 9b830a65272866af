//! A force that is cut off, and a force whose sign is turned round.

use super::{Finding, Severity, count, extremes, place, short};
use crate::log::Log;
use crate::mapping::Mapping;
use std::ops::Range;
use stiction_codes::Code;
use stiction_number::Percent;

/// Shortest stretch at an extreme that can be saturation, in samples.
const MIN_FLAT: usize = 5;
/// Entering or leaving a cut-off skips more than this many of the smallest steps; the crest of a
/// stepped sine does not.
const STEEP_STEPS: f64 = 1.5;
/// Or the extremes hold this share of all samples of a signal with at least this many levels.
const HELD_SHARE: f64 = 0.10;
const LEVELS: f64 = 100.0;
/// Net work below this share of the work in both directions is the wrong sign.
const NEGATIVE_WORK: f64 = -0.3;

/// Finds stretches where the force is cut off and excludes them.
pub(super) fn saturation(log: &mut Log, mapping: &Mapping) {
    let Some(force) = &log.force else { return };
    let (runs, limit) = match mapping.force_limit {
        // One part in a thousand of slack: a limit is stated in fewer digits than it is logged.
        Some(limit) => (runs_where(force, 1, |x| x.abs() >= 0.999 * limit), limit),
        None => match extremes(force) {
            Some((low, high)) if low < high => {
                (cut_off(force, low, high), low.abs().max(high.abs()))
            }
            _ => return,
        },
    };
    let Some(first) = runs.first().cloned() else {
        return;
    };
    let samples: usize = runs.iter().map(Range::len).sum();
    let message = format!(
        "force is cut off near {} {} for {} in {}, first from {}; these samples are excluded",
        short(limit),
        log.force_unit,
        count(samples, "sample"),
        count(runs.len(), "stretch").replace("stretchs", "stretches"),
        place(log, first.start)
    );
    log.findings
        .push(Finding::new(Code::Saturation, Severity::Warning, message).at(first.start));
    for run in runs {
        log.exclude(run, Code::Saturation);
    }
}

/// Flat stretches at the extremes of a signal that is not a staircase.
fn cut_off(force: &[f64], low: f64, high: f64) -> Vec<Range<usize>> {
    let at = |level: f64| runs_where(force, MIN_FLAT, move |x| x == level);
    let (lows, highs) = (at(low), at(high));
    let held: usize = lows.iter().chain(&highs).map(Range::len).sum();
    if held == 0 {
        return Vec::new();
    }
    // A commanded staircase rests on other levels as well; a signal that rests at 0 is switched off.
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
    let held_long =
        held as f64 > HELD_SHARE * force.len() as f64 && (high - low) / smallest >= LEVELS;
    let steep = |run: &Range<usize>| {
        let enters = run.start > 0
            && (force[run.start] - force[run.start - 1]).abs() > STEEP_STEPS * smallest;
        let leaves = run.end < force.len()
            && (force[run.end] - force[run.end - 1]).abs() > STEEP_STEPS * smallest;
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
        .filter(move |run| run.len() >= MIN_FLAT && run[0] != low && run[0] != high)
        .map(|run| (run[0], run.len()))
}

/// Compares work done along and against the motion: a force that drives an axis with friction
/// feeds it. Only for motion to and fro, since a weight may well brake one way.
pub(super) fn sign(log: &mut Log) {
    let Some(force) = &log.force else { return };
    let gap = |sample| log.gap_after(sample);
    let (mut net, mut gross, mut travel, mut way) = (0.0, 0.0, 0.0, 0.0);
    for i in 1..log.time.len() {
        let moved = match (&log.position, &log.velocity) {
            (Some(x), _) => x[i] - x[i - 1],
            (None, Some(v)) => 0.5 * (v[i] + v[i - 1]) * (log.time[i] - log.time[i - 1]),
            (None, None) => return,
        };
        if gap(i - 1) {
            continue;
        }
        let work = 0.5 * (force[i] + force[i - 1]) * moved;
        net += work;
        gross += work.abs();
        travel += moved;
        way += moved.abs();
    }
    if net < NEGATIVE_WORK * gross && travel.abs() < 0.5 * way {
        let turned =
            log.mapping.force.as_ref().is_some_and(|f| {
                f.invert != f.scale.as_ref().is_some_and(|scale| scale.number < 0.0)
            });
        let cure = if turned {
            "its sign is turned round already (invert or a negative scale): take that back"
        } else {
            "if it is the friction rather than the drive force, set invert = true"
        };
        let message = format!(
            "the force takes {} of the work it does out of the motion, as a force that opposes \
             motion does; {cure}",
            Percent::error(-100.0 * net / gross).short()
        );
        log.findings
            .push(Finding::new(Code::ForceSign, Severity::Warning, message));
    }
}
