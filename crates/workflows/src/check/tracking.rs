//! How well an axis follows its reference, and what changed from one log to another: a recording before a compensation was
//! put into operation and one after.

use crate::turns::turned;
use serde::Serialize;
use std::ops::Range;
use stiction_codes::Code;
use stiction_log::{Gap, Log};
use stiction_policy::tracking;
use stiction_signal::{Travel, noise_deviation};

/// A peak at a reversal is sought from so long before the reference turns, s; so do the check lists of `docs/deploy`.
const BEFORE: f64 = 0.02;
/// To so long after, s, or until just before the next turn.
const AFTER: f64 = 0.15;

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
    /// Rows in a second; of a position that is held over some rows those that renew it.
    pub rate_hz: f64,
    /// Reversals that are left out: beside a gap, or with rows that are frozen or bridged.
    pub left_out: usize,
    /// Rows of the motion that are left out: frozen, or without a position or reference.
    pub rows_left_out: usize,
    /// Of each peak the number of its reversal, of all that the reference has, counted from 0.
    #[serde(skip)]
    numbers: Vec<usize>,
    /// Of each peak time from its reversal, s, and error.
    #[serde(skip)]
    about: Vec<Vec<(f64, f64)>>,
    /// Time and error of the motion.
    #[serde(skip)]
    course: Vec<(f64, f64)>,
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
    /// The lower rate of the two, Hz, to which the finer log was thinned; absent where the rates are the same.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thinned_to_hz: Option<f64>,
    /// In what the motions differ, for people; empty where they are the same.
    pub differs: Vec<String>,
    /// The reversals at which the error has grown, largest growth first: time in the later log, error before and after. Only
    /// where the motions are the same.
    pub grown: Vec<(f64, f64, f64)>,
    /// Whether it has grown at half of the reversals of the same motion or more.
    pub worse: bool,
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
        let jumps = |pair: &[f64]| (pair[1] - pair[0]).abs() > tracking::MIN_REFERENCE_JUMP * range;
        if reference.windows(2).any(jumps) {
            return Err(match log.wrap {
                Some(_) => "its reference jumps, not by the wrap of the axis file",
                None => {
                    "its reference jumps; where it wraps as the position does, give that travel under [log] in the axis file: \
                     wrap = \"360 deg\""
                }
            });
        }
        let mut error: Vec<f64> = reference.iter().zip(position).map(|(r, x)| r - x).collect();
        let mut sorted = error.clone();
        let middle = sorted.len() / 2;
        let (_, median, _) = sorted.select_nth_unstable_by(middle, f64::total_cmp);
        let offset = *median;
        error.iter_mut().for_each(|e| *e -= offset);
        let moving = moving(reference).ok_or("its reference does not move")?;
        if moving.clone().all(|i| reference[i] == position[i]) {
            return Err(
                "its position is its reference, row by row: the position of the encoder has to be logged",
            );
        }
        let seen = seen(log);
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
        if turns.is_empty() {
            return Err("its reference does not turn back");
        }
        let all = turns
            .iter()
            .zip(ends)
            .enumerate()
            .filter_map(|(number, (&turn, end))| {
                let from = turn.saturating_sub(samples(BEFORE));
                let to = (turn + samples(AFTER) + 1).min(end).max(turn + 1);
                // One beside a gap is not seen, nor one in rows that were not measured.
                let gap = |g: &Gap| from <= g.start_index && g.start_index < to;
                let whole = seen[from..to].iter().all(|seen| *seen);
                (whole && !log.gaps.iter().any(gap)).then(|| {
                    let peak = Peak {
                        time: log.time[turn],
                        error: largest(from..to),
                    };
                    let turned = instant(&log.time, reference, turn);
                    let since = |i: usize| (log.time[i] - turned, error[i]);
                    (number, peak, (from..to).map(since).collect::<Vec<_>>())
                })
            });
        let (mut numbers, mut peaks, mut about) = (Vec::new(), Vec::new(), Vec::new());
        for (number, peak, rows) in all {
            numbers.push(number);
            peaks.push(peak);
            about.push(rows);
        }
        if peaks.is_empty() {
            return Err(
                "every reversal of its reference lies beside a gap, or in rows that are frozen or missing",
            );
        }
        let course: Vec<(f64, f64)> = (moving.clone())
            .filter(|&i| seen[i])
            .map(|i| (log.time[i], error[i]))
            .collect();
        let square: f64 = course.iter().map(|(_, e)| e * e).sum();
        let speeds = moving
            .clone()
            .skip(1)
            .map(|i| ((reference[i] - reference[i - 1]) / (log.time[i] - log.time[i - 1])).abs());
        let mut speeds: Vec<f64> = speeds.collect();
        speeds.sort_unstable_by(f64::total_cmp);
        let last = speeds.len().saturating_sub(1);
        Ok(Self {
            log: name.into(),
            left_out: turns.len() - peaks.len(),
            rows_left_out: moving.len() - course.len(),
            peaks,
            numbers,
            about,
            rms: (square / course.len().max(1) as f64).sqrt(),
            largest: course.iter().fold(0.0, |most, (_, e)| e.abs().max(most)),
            course,
            rate_hz: log.rate_hz,
            range,
            // A single jump is no speed.
            top_speed: speeds.get(last * 99 / 100).copied().unwrap_or(0.0),
            seconds: log.time[moving.end - 1] - log.time[moving.start],
            offset,
            step: log.quantum,
        })
    }

    /// As a log of a lower rate would show it: the error at the places where that has its rows, after the same reversal where
    /// they have as many.
    fn as_seen_by(&self, coarse: &Self) -> Self {
        let mut thin = self.clone();
        let same = self.reversals() == coarse.reversals();
        for (i, (peak, about)) in thin.peaks.iter_mut().zip(&self.about).enumerate() {
            let there = coarse.numbers.binary_search(&self.numbers[i]);
            let rows = &coarse.about[there.ok().filter(|_| same).unwrap_or(0)];
            let places = rows.iter().map(|(place, _)| *place);
            peak.error = places
                .filter_map(|place| nearest(about, place, 1.0 / self.rate_hz))
                .fold(0.0, |most: f64, e| most.max(e.abs()));
        }
        // Elsewhere on the rows that go on from those.
        let begin = self.peaks[0].time + coarse.about[0].first().map_or(0.0, |(place, _)| *place);
        let half = 0.5 * coarse.rate_hz / self.rate_hz;
        let has_a_row = |t: f64| {
            let rows = (t - begin) * coarse.rate_hz;
            (rows - rows.round()).abs() < half
        };
        let rows = self.course.iter().filter(|(t, _)| has_a_row(*t));
        thin.largest = rows.fold(thin.largest_peak(), |most, (_, e)| e.abs().max(most));
        thin
    }

    /// Reversals of the reference, with those that are left out.
    fn reversals(&self) -> usize {
        self.peaks.len() + self.left_out
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
    /// What changed; else why that is not known, in words that complete "... is not compared: ".
    pub(super) fn between(before: &Tracking, after: &Tracking) -> Result<Self, String> {
        let lower = before.rate_hz.min(after.rate_hz);
        let apart =
            before.rate_hz.max(after.rate_hz) > (1.0 + tracking::MAX_RATE_DIFFERENCE) * lower;
        if apart && lower < tracking::MIN_RATE {
            let hz = |x: f64| stiction_number::full(libm::round(10.0 * x) / 10.0);
            return Err(format!(
                "it has {} Hz and the first log {} Hz, and an error that comes and goes at a reversal is seen from {} Hz; record \
                 both at the same rate",
                hz(after.rate_hz),
                hz(before.rate_hz),
                hz(tracking::MIN_RATE)
            ));
        }
        let coarser = |one: &Tracking, other: &Tracking| match apart && one.rate_hz > lower {
            true => one.as_seen_by(other),
            false => one.clone(),
        };
        let (before, after) = (&coarser(before, after), &coarser(after, before));
        let other = |a: f64, b: f64| (a - b).abs() > tracking::MAX_MOTION_DIFFERENCE * a.max(b);
        let mut differs = Vec::new();
        if before.reversals() != after.reversals() {
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
        let slack = tracking::MIN_PEAK_GROWTH_STEPS
            * before.step.unwrap_or(0.0).max(after.step.unwrap_or(0.0));
        let (mut grown, mut compared) = (Vec::new(), 0);
        if differs.is_empty() {
            for (number, b) in after.numbers.iter().zip(&after.peaks) {
                let Ok(there) = before.numbers.binary_search(number) else {
                    continue;
                };
                let a = before.peaks[there];
                compared += 1;
                if b.error > (1.0 + tracking::MIN_PEAK_GROWTH) * a.error
                    && b.error > a.error + slack
                {
                    grown.push((b.time, a.error, b.error));
                }
            }
            grown.sort_by(|x, y| (y.2 - y.1).total_cmp(&(x.2 - x.1)));
        }
        Ok(Self {
            before: before.clone(),
            after: after.clone(),
            thinned_to_hz: apart.then_some(lower),
            differs,
            worse: compared > 0 && 2 * grown.len() >= compared,
            grown,
        })
    }
}

/// When a reference turns at a sample, s: between samples too, as the parabola through three of them has it. Of one that rested
/// before, the last sample of its rest.
fn instant(time: &[f64], reference: &[f64], turn: usize) -> f64 {
    let Some(&[a, b, c]) = turn.checked_sub(1).and_then(|i| reference.get(i..i + 3)) else {
        return time[turn];
    };
    let rested = a == b && turn >= 2 && reference[turn - 2] == b;
    let bend = a - 2.0 * b + c;
    if rested || bend == 0.0 {
        return time[turn];
    }
    let rows = (0.5 * (a - c) / bend).clamp(-1.0, 1.0);
    time[turn] + rows * (time[turn + 1] - time[turn])
}

/// Which samples have a measured position and reference: a force beyond its limit or a temperature without a sensor does not
/// change them.
fn seen(log: &Log) -> Vec<bool> {
    let mut seen = vec![true; log.time.len()];
    let spoilt = |code: Code| {
        matches!(
            code,
            Code::MissingCells | Code::StuckEncoder | Code::PositionJump | Code::ZeroFilled
        )
    };
    for part in log.excluded.iter().filter(|part| spoilt(part.code)) {
        seen[part.samples.clone()].fill(false);
    }
    for samples in &log.without_reference {
        seen[samples.clone()].fill(false);
    }
    seen
}

/// The error at the row nearest to a place after a reversal, where one is within a row of it.
fn nearest(about: &[(f64, f64)], place: f64, row: f64) -> Option<f64> {
    let after = about.partition_point(|(t, _)| *t < place);
    let near = about.get(after.saturating_sub(1)..(after + 1).min(about.len()))?;
    let away = |t: f64| (t - place).abs();
    let (t, e) = near.iter().min_by(|a, b| away(a.0).total_cmp(&away(b.0)))?;
    (away(*t) <= row).then_some(*e)
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
