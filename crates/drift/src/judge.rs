//! What became of the number on one machine.

use crate::course::{Measure, Point};
use crate::limits::{Limits, WINDOWS};
use crate::noise::{Noise, scaled};
use crate::robust::weighted_median;

/// Whether a number went from one level to another at once, or bit by bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// From one log to the next.
    Step,
    /// Over many.
    Creep,
}

/// A change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// Place of the log with which it was found.
    pub found: usize,
    /// Place of the first log after it, or where the creep began.
    pub since: usize,
    /// What it looked like when it was found.
    pub kind: Kind,
    /// Level before it, in the unit of the number.
    pub before: f64,
    /// By how much the last logs differ from that: a part of it, or in its unit.
    pub size: f64,
    /// 95 % interval of the size: intervals, scatter and wandering.
    pub low: f64,
    /// Its upper end.
    pub high: f64,
    /// Window that showed it, logs.
    pub window: usize,
    /// Its median over the limit, 1 or more.
    pub over: f64,
}

/// What became of a number on a machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// How changes are counted.
    pub measure: Measure,
    /// Level of the first logs, in the unit of the number.
    pub reference: f64,
    /// Each log without what temperature does, in the unit of the number.
    pub corrected: Vec<f64>,
    /// Half of the 95 % interval of each log with the scatter between logs, on the scale of the measure.
    pub half: Vec<f64>,
    /// Level of the last logs, in the unit of the number.
    pub last: f64,
    /// Changes, in the order of time; after each the level begins anew.
    pub changes: Vec<Change>,
}

impl Judged {
    /// The 95 % interval of each log without what temperature does, with the scatter between logs, in the unit of the number.
    pub fn intervals(&self) -> impl Iterator<Item = (f64, f64)> {
        let each = self.corrected.iter().zip(&self.half);
        each.map(|(value, half)| {
            let half = match self.measure {
                Measure::Relative => value * half,
                Measure::Absolute => *half,
            };
            (value - half, value + half)
        })
    }
}

/// A course of too few logs to follow, or whose noise is not known: the logs as they stand, each with its own interval.
pub fn plain(course: &[Point]) -> Judged {
    let median = |points: &[Point]| {
        crate::robust::median(&mut points.iter().map(|p| p.value).collect::<Vec<f64>>())
    };
    Judged {
        measure: Measure::Absolute,
        reference: median(course),
        corrected: course.iter().map(|p| p.value).collect(),
        half: course.iter().map(|p| HALF * p.std).collect(),
        last: median(&course[course.len().saturating_sub(WINDOWS[0])..]),
        changes: Vec::new(),
    }
}

/// Standard deviations of half a 95 % interval.
const HALF: f64 = 1.959_963_984_540_054;

/// Follows a number on one machine, in the order of time; `None` where there are not more logs than the reference takes.
pub fn judge(course: &[Point], noise: &Noise, limits: &Limits) -> Option<Judged> {
    let measure = noise.measure;
    let points = scaled(course, measure, noise.by_temperature);
    if points.len() < limits.reference + WINDOWS[0] {
        return None;
    }
    let weighted: Vec<(f64, f64)> = points
        .iter()
        .map(|(_, value, std)| (*value, noise.weight(*std)))
        .collect();
    let level = |from: usize, to: usize| weighted_median(&mut weighted[from..to].to_vec());
    let mut changes = Vec::new();
    let mut start = 0;
    while let Some(change) = next_change(&points, noise, limits, start, &level) {
        start = change.since.max(start + 1);
        changes.push(change);
    }
    let recent = points.len() - WINDOWS[0];
    Some(Judged {
        measure,
        reference: measure.value(level(0, limits.reference)),
        corrected: points
            .iter()
            .map(|(_, value, _)| measure.value(*value))
            .collect(),
        half: points
            .iter()
            .map(|(.., std)| HALF * libm::sqrt(noise.variance(*std)))
            .collect(),
        last: measure.value(level(recent, points.len())),
        changes,
    })
}

/// The first change after a level that begins at `start`.
fn next_change(
    points: &[(f64, f64, f64)],
    noise: &Noise,
    limits: &Limits,
    start: usize,
    level: &dyn Fn(usize, usize) -> f64,
) -> Option<Change> {
    let begin = start + limits.reference;
    if begin >= points.len() {
        return None;
    }
    let before = level(start, begin);
    for end in begin + WINDOWS[0]..=points.len() {
        let mut worst: Option<(f64, usize)> = None;
        for (logs, limit) in WINDOWS.into_iter().zip(limits.of_window) {
            if end < begin + logs {
                continue;
            }
            let off = (level(end - logs, end) - before).abs();
            let over = if limit > 0.0 {
                off / limit
            } else if off > 0.0 {
                f64::INFINITY
            } else {
                0.0
            };
            if over >= 1.0 && worst.is_none_or(|(most, _)| over > most) {
                worst = Some((over, logs));
            }
        }
        if let Some((over, window)) = worst {
            let (kind, since) = shape(&points[start..end], limits.reference);
            let since = start + since;
            // Of a step within the reference only what comes before it is the level before it.
            let begin = begin.min(since);
            let before = level(start, begin);
            let recent = match kind {
                Kind::Step => since.min(end - 3),
                Kind::Creep => end - WINDOWS[0].min(end - since).max(3),
            };
            let difference = level(recent, end) - before;
            let error = difference_error(noise, points, (start, begin), (recent, end));
            let change = |x: f64| noise.measure.change(x);
            return Some(Change {
                found: end - 1,
                since,
                kind,
                before: noise.measure.value(before),
                size: change(difference),
                low: change(difference - HALF * error),
                high: change(difference + HALF * error),
                window,
                over,
            });
        }
    }
    None
}

/// Standard deviation of the difference of two medians: each log by itself, and the wandering at two times far from each other.
fn difference_error(
    noise: &Noise,
    points: &[(f64, f64, f64)],
    before: (usize, usize),
    after: (usize, usize),
) -> f64 {
    // Of normal numbers, a median has pi/2 times the variance of a mean.
    let of = |(from, to): (usize, usize)| {
        let weights: f64 = points[from..to]
            .iter()
            .map(|(.., std)| 1.0 / noise.variance(*std))
            .sum();
        0.5 * std::f64::consts::PI / weights
    };
    libm::sqrt(of(before) + of(after) + 2.0 * noise.wandering * noise.wandering)
}

/// What a course that has changed looks like: two levels or a level and a line, whichever leaves less (sums of absolute
/// deviations); and where the second begins: a line at the earliest after the first `reference` logs, which are taken for one
/// level, a step after so many that their median is the level before it.
fn shape(points: &[(f64, f64, f64)], reference: usize) -> (Kind, usize) {
    let all = points.len();
    let values: Vec<f64> = points.iter().map(|(_, value, _)| *value).collect();
    let middle = |from: usize, to: usize| crate::robust::median(&mut values[from..to].to_vec());
    let cost = |from: usize, to: usize, at: &dyn Fn(usize) -> f64| -> f64 {
        (from..to).map(|i| (values[i] - at(i)).abs()).sum()
    };
    let mut best = (f64::INFINITY, Kind::Step, all - 1);
    let first = WINDOWS[0].min(all - 1);
    // A course of thousands of logs is looked at in some hundred places.
    let stride = ((all - first) / 256).max(1);
    for at in (first..all).step_by(stride) {
        let before = middle(0, at);
        let so_far = cost(0, at, &|_| before);
        let after = middle(at, all);
        let step = so_far + cost(at, all, &|_| after);
        if step < best.0 {
            best = (step, Kind::Step, at);
        }
        // A line from the level on, up to the median of its last third; one of three logs is no line.
        if at < reference || all - at < 2 * WINDOWS[0] {
            continue;
        }
        let (from, span) = (points[at].0, points[all - 1].0 - points[at].0);
        let third = at + (all - at) * 2 / 3;
        let mut rates: Vec<f64> = (third..all)
            .filter(|i| points[*i].0 > from)
            .map(|i| (values[i] - before) / (points[i].0 - from))
            .collect();
        let rate = crate::robust::median(&mut rates);
        if span > 0.0 && rate.is_finite() {
            let line = so_far + cost(at, all, &|i| before + rate * (points[i].0 - from));
            if line < best.0 {
                best = (line, Kind::Creep, at);
            }
        }
    }
    (best.1, best.2)
}
