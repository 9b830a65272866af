//! How well an axis followed.

mod contour;

pub use contour::{Contour, circular_deviation};

use crate::axis::Sample;

/// Tracking of one axis. Errors are reference less true position, m (rad).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tracking {
    /// Rms error, m (rad).
    pub rms: f64,
    /// Largest error, m (rad).
    pub peak: f64,
    /// Largest error about a reversal of the reference, m (rad): the quadrant spike. 0 without reversals. A spike stands
    /// where friction has turned round, which on a slow motion is long after the reversal: what counts is 20 ms to either
    /// side, or a quarter of the way before and after in time if that is longer. A way is from a reversal, or the
    /// beginning of the samples, to the next, or their end, without the rest of the reference after it; where the
    /// reference rests before a reversal, 20 ms before it count.
    pub reversal_peak: f64,
    /// Rms change of the command from sample to sample, N (N m).
    pub command_change: f64,
    /// Longest standstill about a reversal, below a hundredth of the fastest reference, s.
    pub stick_time: f64,
}

/// The least time about a reversal that counts as part of it, s.
const ABOUT: f64 = 0.02;

/// Shorter stretches of constant velocity are still settling, s.
const SETTLES: f64 = 0.1;

impl Tracking {
    /// Of the samples given; none give zeros. Leave out what is not to count, as the first cycle.
    pub fn of(samples: &[Sample]) -> Self {
        let turns = turns(samples);
        let squares = samples.iter().map(|s| s.error() * s.error());
        let changes = samples
            .windows(2)
            .map(|pair| (pair[1].command - pair[0].command).powi(2));
        Tracking {
            rms: root_mean(squares),
            peak: samples.iter().fold(0.0, |m, s| m.max(s.error().abs())),
            reversal_peak: about(samples, &turns)
                .flatten()
                .fold(0.0, |m, s| m.max(s.error().abs())),
            command_change: root_mean(changes),
            stick_time: stick_time(samples, &turns),
        }
    }
}

/// Instants, s, at which the reference velocity changes sign.
pub fn reversals(samples: &[Sample]) -> Vec<f64> {
    turns(samples).iter().map(|turn| turn.time).collect()
}

/// A reversal of the reference.
struct Turn {
    /// When it moved last the way before, s.
    left: f64,
    /// When it moves the other way, s.
    time: f64,
}

fn turns(samples: &[Sample]) -> Vec<Turn> {
    let mut last: Option<&Sample> = None;
    let mut turns = Vec::new();
    for sample in samples.iter().filter(|s| moves(s)) {
        if let Some(last) = last.filter(|l| l.reference.velocity * sample.reference.velocity < 0.0)
        {
            turns.push(Turn {
                left: last.time,
                time: sample.time,
            });
        }
        last = Some(sample);
    }
    turns
}

fn moves(sample: &Sample) -> bool {
    sample.reference.velocity != 0.0
}

/// The samples about each reversal; stretches may overlap.
fn about<'a>(samples: &'a [Sample], turns: &'a [Turn]) -> impl Iterator<Item = &'a [Sample]> {
    let begin = samples.iter().find(|s| moves(s)).map(|s| s.time);
    let end = samples.iter().rfind(|s| moves(s)).map(|s| s.time);
    let place = |time: f64| samples.partition_point(|s| s.time < time);
    turns.iter().enumerate().map(move |(i, turn)| {
        let since = match i.checked_sub(1) {
            Some(before) => turns[before].time,
            None => begin.unwrap_or(turn.left),
        };
        let until = turns.get(i + 1).map_or(end, |next| Some(next.left));
        let rested = turn.time - turn.left > ABOUT;
        let before = if rested { 0.0 } else { turn.left - since };
        let after = until.unwrap_or(turn.time) - turn.time;
        let from = turn.time - ABOUT.max(0.25 * before);
        let to = turn.time + ABOUT.max(0.25 * after);
        &samples[place(from)..place(to)]
    })
}

fn stick_time(samples: &[Sample], turns: &[Turn]) -> f64 {
    let fastest = samples
        .iter()
        .fold(0.0_f64, |m, s| m.max(s.reference.velocity.abs()));
    let mut longest = 0.0_f64;
    let mut since: Option<f64> = None;
    for sample in samples {
        if sample.velocity.abs() >= 0.01 * fastest {
            since = None;
            continue;
        }
        let begin = *since.get_or_insert(sample.time);
        // A standstill belongs to a reversal that it holds or follows within the time about it.
        let next = turns.partition_point(|turn| turn.time < begin - ABOUT);
        if turns
            .get(next)
            .is_some_and(|turn| turn.time <= sample.time + ABOUT)
        {
            longest = longest.max(sample.time - begin);
        }
    }
    longest
}

/// Share of the samples whose command is at `limit` > 0, N (N m), or beyond; 0 of none.
pub fn share_at_limit(samples: &[Sample], limit: f64) -> f64 {
    let at = samples.iter().filter(|s| s.command.abs() >= limit).count();
    at as f64 / samples.len().max(1) as f64
}

/// Rms deviation of the velocity from its mean over the mean: the ripple of a constant speed. Infinite at standstill.
pub fn velocity_ripple(samples: &[Sample]) -> f64 {
    let n = samples.len().max(1) as f64;
    let mean = samples.iter().map(|s| s.velocity).sum::<f64>() / n;
    let off = samples.iter().map(|s| (s.velocity - mean).powi(2));
    root_mean(off) / mean.abs()
}

/// The largest [`velocity_ripple`] of all stretches of constant reference velocity of at least .1 s, each from its middle
/// on; `None` without such a stretch.
pub fn ripple_at_constant_velocity(samples: &[Sample]) -> Option<f64> {
    let constant = |s: &Sample| s.reference.acceleration == 0.0 && s.reference.velocity != 0.0;
    let same = |a: &Sample, b: &Sample| {
        constant(a) && constant(b) && a.reference.velocity == b.reference.velocity
    };
    samples
        .chunk_by(same)
        .filter(|stretch| constant(&stretch[0]))
        .filter(|stretch| stretch[stretch.len() - 1].time - stretch[0].time >= SETTLES)
        .map(|stretch| velocity_ripple(&stretch[stretch.len() / 2..]))
        .reduce(f64::max)
}

/// The square root of the mean; 0 of nothing.
pub(crate) fn root_mean(squares: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = squares.fold((0.0, 0.0), |(sum, n), x| (sum + x, n + 1.0));
    if n == 0.0 { 0.0 } else { libm::sqrt(sum / n) }
}
