//! Tracking metrics of an axis.

mod contour;
mod crawl;
mod feed;
mod rest;

pub use contour::{Contour, circular_deviation};
pub use crawl::Crawl;
pub use feed::Feed;
pub use rest::{Hunting, standing_error};

use crate::axis::Sample;
use crate::path::Reference;

/// Tracking of one axis. Errors are reference less true position, m (rad).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tracking {
    /// Rms error, m (rad).
    pub rms: f64,
    /// Largest error, m (rad).
    pub peak: f64,
    /// Largest error about a reversal of the reference, m (rad): the quadrant glitch. 0 without reversals. The spike comes
    /// when friction has reversed, which in slow motion is long after the reversal: the window is 20 ms on either
    /// side, or a quarter of the duration of the stroke before and after if that is longer. A stroke is from a reversal, or the
    /// beginning of the samples, to the next, or their end, without the rest of the reference after it; where the
    /// reference rests before a reversal, 20 ms before it count.
    pub reversal_peak: f64,
    /// Rms change of the command from sample to sample, N (N m).
    pub command_change: f64,
    /// Longest standstill about a reversal, below a hundredth of the fastest reference, s.
    pub stick_time: f64,
}

/// Least half width of the window about a reversal, s.
const MIN_REVERSAL_WINDOW: f64 = 0.02;
/// Half width of that window as a fraction of the stroke, where that is longer: a spike comes once friction has reversed,
/// which in slow motion is late (decision 0034).
const REVERSAL_SHARE_OF_STROKE: f64 = 0.25;
/// Speed below which the axis stands still, as a fraction of the fastest reference.
const STANDSTILL_SHARE: f64 = 0.01;

/// Shortest stretch of constant velocity, or of rest, in which an axis is measured, s; in shorter ones it is still settling.
const MIN_STRETCH: f64 = 0.1;

impl Tracking {
    /// From the given samples; all 0 without samples. Leave out those that should not count, such as the first cycle.
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
    /// When it last moved in the direction before, s.
    left: f64,
    /// When it first moves in the other direction, s.
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
        let rested = turn.time - turn.left > MIN_REVERSAL_WINDOW;
        let before = if rested { 0.0 } else { turn.left - since };
        let after = until.unwrap_or(turn.time) - turn.time;
        let from = turn.time - MIN_REVERSAL_WINDOW.max(REVERSAL_SHARE_OF_STROKE * before);
        let to = turn.time + MIN_REVERSAL_WINDOW.max(REVERSAL_SHARE_OF_STROKE * after);
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
        if sample.velocity.abs() >= STANDSTILL_SHARE * fastest {
            since = None;
            continue;
        }
        let begin = *since.get_or_insert(sample.time);
        // A standstill belongs to a reversal that it contains or follows within the window about it.
        let next = turns.partition_point(|turn| turn.time < begin - MIN_REVERSAL_WINDOW);
        if turns
            .get(next)
            .is_some_and(|turn| turn.time <= sample.time + MIN_REVERSAL_WINDOW)
        {
            longest = longest.max(sample.time - begin);
        }
    }
    longest
}

/// Share of the samples whose command is at `limit` > 0, N (N m), or beyond; 0 without samples.
pub fn share_at_limit(samples: &[Sample], limit: f64) -> f64 {
    let at = samples.iter().filter(|s| s.command.abs() >= limit).count();
    at as f64 / samples.len().max(1) as f64
}

/// The square root of the mean; 0 without values.
pub(crate) fn root_mean(squares: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = squares.fold((0.0, 0.0), |(sum, n), x| (sum + x, n + 1.0));
    if n == 0.0 { 0.0 } else { libm::sqrt(sum / n) }
}

/// Samples that follow each other while the reference does the same, from the middle of at least `least` seconds on.
fn settled<'a>(
    samples: &'a [Sample],
    least: f64,
    same: impl Fn(&Reference, &Reference) -> bool + 'a,
) -> impl Iterator<Item = &'a [Sample]> {
    samples
        .chunk_by(move |a, b| same(&a.reference, &b.reference))
        .filter(move |stretch| {
            // Rounding of two instants must not decide.
            stretch[stretch.len() - 1].time - stretch[0].time >= least * (1.0 - 1e-9)
        })
        .map(|stretch| &stretch[stretch.len() / 2..])
}
