//! How well an axis follows its reference, and what changed from one log to another: a recording before a compensation was
//! put into operation and one after.

use crate::turns::turned;
use serde::Serialize;
use std::ops::Range;
use stiction_log::{Gap, Log};
use stiction_signal::{Travel, noise_deviation};

/// A peak at a reversal is sought from so long before the reference turns, s.
const BEFORE: f64 = 0.02;
/// To so long after, s, or until just before the next turn.
const AFTER: f64 = 0.15;
/// Two motions are the same if range, top speed and duration differ by no more than this part.
const SAME: f64 = 0.05;
/// A peak has grown if it is larger by more than this part, and by more than [`STEPS`].
const GROWN: f64 = 0.1;
/// Encoder steps by which two errors of the same size may differ.
const STEPS: f64 = 3.0;

/// Part of the range that a reference moves in one sample only where it jumps: at a wrap, or between set points.
const JUMP: f64 = 0.3;

/// How well an axis follows its reference in one log; errors are reference less position and less their median, m or rad.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tracking {
    /// The log.
    pub log: String,
    /// Largest size of the error at each reversal of the reference, from 20 ms before to 150 ms after, with its time, s.
    pub peaks: Vec<Peak>,
    /// Root mean square of the error, from the first motion of the reference to the last.
    pub rms: f64,
    /// Its largest size there.
    pub largest: f64,
    /// How far the reference moves, m or rad.
    pub range: f64,
    /// Its top speed, m/s or rad/s.
    pub top_speed: f64,
    /// From its first motion to its last, s.
    pub seconds: f64,
    /// Median of reference less position, which the errors are without, m or rad.
    pub offset: f64,
    /// Encoder step, m or rad, where it is known.
    pub step: Option<f64>,
}

/// The error at a reversal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Peak {
    /// When the reference turns, s from the beginning of the log.
    pub time: f64,
    /// Largest size of the error about it, m or rad.
    pub error: f64,
}

/// What changed from one log to another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrackingChange {
    /// The earlier log.
    pub before: Tracking,
    /// The later one.
    pub after: Tracking,
    /// In what the motions differ, for people; empty where they are the same.
    pub differs: Vec<String>,
    /// The reversals at which the error has grown, largest growth first: time in the later log, error before and after. Only
    /// where the motions are the same.
    pub grown: Vec<(f64, f64, f64)>,
}

impl Tracking {
    /// How a log follows its reference; else why that is not known, in words that complete "... is not compared: ".
    pub(super) fn of(name: &str, log: &Log) -> Result<Self, &'static str> {
        let reference = log
            .reference
            .as_ref()
            .ok_or("it has no reference position")?;
        let position = log.position.as_ref().ok_or("it has no position")?;
        let ends = |of: fn(f64, f64) -> f64, start| reference.iter().copied().fold(start, of);
        let range = ends(f64::max, f64::NEG_INFINITY) - ends(f64::min, f64::INFINITY);
        let jumps = |pair: &[f64]| (pair[1] - pair[0]).abs() > JUMP * range;
        if reference.windows(2).any(jumps) {
            return Err("its reference jumps; one that wraps has to be unwrapped in the log");
        }
        let mut error: Vec<f64> = reference.iter().zip(position).map(|(r, x)| r - x).collect();
        let mut sorted = error.clone();
        let middle = sorted.len() / 2;
        let (_, median, _) = sorted.select_nth_unstable_by(middle, f64::total_cmp);
        let offset = *median;
        error.iter_mut().for_each(|e| *e -= offset);
        let moving = moving(reference).ok_or("its reference does not move")?;
        let stretches = log.segments.iter().filter_map(|s| reference.get(s.clone()));
        let noise = noise_deviation(stretches);
        let shortest = Travel::shortest_movement(least_step(reference), noise);
        let turns = turned(reference, shortest);
        let samples = |seconds: f64| (seconds * log.rate_hz) as usize;
        let largest =
            |range: Range<usize>| error[range].iter().fold(0.0, |m: f64, e| m.max(e.abs()));
        let ends = turns
            .iter()
            .skip(1)
            .map(|next| next.saturating_sub(samples(BEFORE)));
        let ends = ends.chain([error.len()]);
        let peaks: Vec<Peak> = turns
            .iter()
            .zip(ends)
            .filter_map(|(&turn, end)| {
                let from = turn.saturating_sub(samples(BEFORE));
                let to = (turn + samples(AFTER) + 1).min(end).max(turn + 1);
                // One beside a gap is not seen.
                let gap = |g: &Gap| from <= g.start_index && g.start_index < to;
                (!log.gaps.iter().any(gap)).then(|| Peak {
                    time: log.time[turn],
                    error: largest(from..to),
                })
            })
            .collect();
        if peaks.is_empty() {
            return Err("its reference does not turn back");
        }
        let square: f64 = error[moving.clone()].iter().map(|e| e * e).sum();
        let speeds = moving
            .clone()
            .skip(1)
            .map(|i| ((reference[i] - reference[i - 1]) / (log.time[i] - log.time[i - 1])).abs());
        let mut speeds: Vec<f64> = speeds.collect();
        speeds.sort_unstable_by(f64::total_cmp);
        let last = speeds.len().saturating_sub(1);
        Ok(Self {
            log: name.into(),
            peaks,
            rms: (square / moving.len() as f64).sqrt(),
            largest: largest(moving.clone()),
            range,
            // A single jump is no speed.
            top_speed: speeds.get(last * 99 / 100).copied().unwrap_or(0.0),
            seconds: log.time[moving.end - 1] - log.time[moving.start],
            offset,
            step: log.quantum,
        })
    }

    /// The largest error at a reversal, m or rad.
    pub fn largest_peak(&self) -> f64 {
        self.peaks
            .iter()
            .fold(0.0, |most, peak| most.max(peak.error))
    }

    /// The median of the errors at reversals, m or rad.
    pub fn median_peak(&self) -> f64 {
        let mut errors: Vec<f64> = self.peaks.iter().map(|peak| peak.error).collect();
        errors.sort_unstable_by(f64::total_cmp);
        errors.get(errors.len() / 2).copied().unwrap_or(0.0)
    }
}

impl TrackingChange {
    pub(super) fn between(before: &Tracking, after: &Tracking) -> Self {
        let other = |a: f64, b: f64| (a - b).abs() > SAME * a.max(b);
        let mut differs = Vec::new();
        if before.peaks.len() != after.peaks.len() {
            differs.push("reversals".into());
        }
        for (name, a, b) in [
            ("range", before.range, after.range),
            ("top speed", before.top_speed, after.top_speed),
            ("duration", before.seconds, after.seconds),
        ] {
            if other(a, b) {
                differs.push(name.into());
            }
        }
        let slack = STEPS * before.step.unwrap_or(0.0).max(after.step.unwrap_or(0.0));
        let mut grown = Vec::new();
        if differs.is_empty() {
            for (a, b) in before.peaks.iter().zip(&after.peaks) {
                if b.error > (1.0 + GROWN) * a.error && b.error > a.error + slack {
                    grown.push((b.time, a.error, b.error));
                }
            }
            grown.sort_by(|x, y| (y.2 - y.1).total_cmp(&(x.2 - x.1)));
        }
        Self {
            before: before.clone(),
            after: after.clone(),
            differs,
            grown,
        }
    }
}

/// From the first sample at which a reference moves to the last.
fn moving(reference: &[f64]) -> Option<Range<usize>> {
    let moves = |pair: &[f64]| pair[0] != pair[1];
    let first = reference.windows(2).position(moves)?;
    let last = reference.windows(2).rposition(moves)?;
    Some(first..last + 2)
}

/// The smallest step of a reference that comes in steps, such as counts; 0 for one that does not.
fn least_step(reference: &[f64]) -> f64 {
    let steps = reference.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let mut steps: Vec<f64> = steps.filter(|step| *step > 0.0).collect();
    if steps.is_empty() {
        return 0.0;
    }
    let at = steps.len() / 20;
    let (_, low, _) = steps.select_nth_unstable_by(at, f64::total_cmp);
    let low = *low;
    // In steps, many of the smallest are the same.
    let same = steps
        .iter()
        .filter(|step| (**step - low).abs() <= 1e-6 * low)
        .count();
    if same * 20 > steps.len() { low } else { 0.0 }
}
