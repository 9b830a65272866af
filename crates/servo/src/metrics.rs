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
    /// side, or a quarter of the time between reversals if that is longer.
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
        let reversals = reversals(samples);
        let about = about(&reversals);
        let squares = samples.iter().map(|s| s.error() * s.error());
        let changes = samples
            .windows(2)
            .map(|pair| (pair[1].command - pair[0].command).powi(2));
        Tracking {
            rms: root_mean(squares),
            peak: samples.iter().fold(0.0, |m, s| m.max(s.error().abs())),
            reversal_peak: near(samples, &reversals, about)
                .fold(0.0, |m, s| m.max(s.error().abs())),
            command_change: root_mean(changes),
            stick_time: stick_time(samples, &reversals),
        }
    }
}

/// Instants, s, at which the reference velocity changes sign.
pub fn reversals(samples: &[Sample]) -> Vec<f64> {
    let mut sign = 0.0;
    let mut instants = Vec::new();
    for sample in samples {
        let v = sample.reference.velocity;
        if v == 0.0 {
            continue;
        }
        if sign * v < 0.0 {
            instants.push(sample.time);
        }
        sign = v.signum();
    }
    instants
}

/// Time about a reversal that counts as part of it, s: from the shortest way between two.
fn about(reversals: &[f64]) -> f64 {
    let between = reversals.windows(2).map(|pair| pair[1] - pair[0]);
    let shortest = between.fold(f64::INFINITY, f64::min);
    if shortest.is_finite() {
        ABOUT.max(0.25 * shortest)
    } else {
        ABOUT
    }
}

/// Samples within `about` seconds of an instant of the ascending `instants`.
fn near<'a>(
    samples: &'a [Sample],
    instants: &'a [f64],
    about: f64,
) -> impl Iterator<Item = &'a Sample> {
    samples.iter().filter(move |s| {
        let next = instants.partition_point(|t| *t < s.time - about);
        instants.get(next).is_some_and(|t| *t <= s.time + about)
    })
}

fn stick_time(samples: &[Sample], reversals: &[f64]) -> f64 {
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
        let next = reversals.partition_point(|t| *t < begin - ABOUT);
        if reversals
            .get(next)
            .is_some_and(|t| *t <= sample.time + ABOUT)
        {
            longest = longest.max(sample.time - begin);
        }
    }
    longest
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
