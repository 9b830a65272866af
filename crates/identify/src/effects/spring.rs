//! A load on a spring.
//!
//! With x the motor, y the load, m its mass and w = sqrt(k/m), the spring exerts `m y''` and
//! `y'' + 2 zeta w (y' - x') + w^2 (y - x) = 0`.
//! - Encoder on the motor: the rigid mass lacks `m (y'' - x'')`, the acceleration behind a filter that is sharp at w.
//! - Encoder on the load: the motor is ahead by `x - y = y''/w^2`, well below w. Its inertia adds `(M - m) y''''/w^2`, and its
//!   friction is that at the velocity `y' + y'''/w^2`.

use super::beside::Beside;
use super::waves::highest;
use super::{Candidate, Effect, Fitted};
use crate::conditioning::record::Record;
use crate::separable::objective::Objective;
use std::f64::consts::{PI, TAU};
use stiction_policy::effect;

/// Damping ratio of a resonance, and of what is none. A gap and friction of another shape look like a load whose spring is
/// damped strongly.
const LIGHT: f64 = 0.02;
const STRONG: f64 = 0.1;
/// Frequencies that are tried: the highest over the cut-off of the common filter or, without one, over the sample rate; how
/// far down; how many.
const OF_CUTOFF: f64 = 1.2;
const OF_RATE: f64 = 0.2;
const MOST_OF_RATE: f64 = 0.45;
const DOWN: f64 = 20.0;
const TRIED: usize = 30;
/// Steps of the search for the sharp one beside the best of them.
const STEPS: usize = 16;

pub(super) fn candidates(fitted: &Fitted, beside: &Beside) -> Vec<Candidate> {
    if fitted.mass <= 0.0 || fitted.objective.law().layout().kappa.is_none() {
        return Vec::new();
    }
    let acceleration = fitted.acceleration();
    let both = [
        behind_the_motor(fitted, &acceleration, beside),
        before_the_encoder(fitted, &acceleration),
    ];
    both.into_iter().flatten().collect()
}

/// A load on a spring behind the motor, where a sharp resonance explains more than a dull one.
fn behind_the_motor(
    fitted: &Fitted,
    acceleration: &[Vec<f64>],
    beside: &Beside,
) -> Option<Candidate> {
    let top = highest_tried(fitted.objective.record());
    let ratio = libm::pow(DOWN, 1.0 / (TRIED - 1) as f64);
    let column = |frequency: f64, damping: f64| {
        let segments = fitted.objective.record().segments.iter().zip(acceleration);
        let behind = segments.map(|(s, a)| lacking(a, frequency * s.step, damping));
        fitted.kept(&behind.collect::<Vec<_>>())
    };
    let share = |frequency: f64, damping: f64| {
        let found = beside.explained(&column(frequency, damping));
        let load = found.coefficient / fitted.mass;
        if load > 0.0 && load < 1.0 {
            found.share
        } else {
            0.0
        }
    };
    let tried = (0..TRIED).map(|i| top / libm::pow(ratio, i as f64));
    let mut course: Vec<(f64, f64)> = tried.map(|f| (f, share(f, STRONG))).collect();
    let (dull, of_dull) = course.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let frequency = highest(dull, (ratio - 1.0) * dull, STEPS, |f| {
        share(f.min(top), LIGHT)
    })
    .min(top);
    (share(frequency, LIGHT) >= of_dull && of_dull > 0.0).then_some(())?;
    let own = column(frequency, LIGHT);
    let small = 0.5 * LIGHT;
    let [low, high] = [1.0 - small, 1.0 + small].map(|f| column(f * frequency, LIGHT));
    let slope = high.iter().zip(&low).map(|(h, l)| (h - l) / (2.0 * small));
    let slope = slope.collect();
    let mass = fitted.mass;
    let mut candidate = Candidate::new(vec![own], move |c| {
        let load = c[0] / mass;
        let read_at_load = false;
        effect::LOAD_SHARE
            .contains(&load)
            .then_some(Effect::Resonance {
                frequency,
                load,
                read_at_load,
            })
    });
    course.reverse();
    (candidate.course, candidate.slope) = (course, Some(slope));
    Some(candidate)
}

/// Highest frequency that is tried, Hz.
fn highest_tried(record: &Record) -> f64 {
    let rate = 1.0 / record.step();
    match record.common_hz {
        Some(cutoff) => (OF_CUTOFF * cutoff).min(MOST_OF_RATE * rate),
        None => OF_RATE * rate,
    }
}

/// `y'' - x''` of a load of mass 1 for the acceleration x'', `frequency` in parts of the sample rate: a high-pass of second
/// order, turned round, by the bilinear transform with its frequency kept.
fn lacking(acceleration: &[f64], frequency: f64, damping: f64) -> Vec<f64> {
    let k = libm::tan(PI * frequency);
    let norm = 1.0 / (1.0 + 2.0 * damping * k + k * k);
    let (back, twice) = (
        2.0 * (k * k - 1.0) * norm,
        (1.0 - 2.0 * damping * k + k * k) * norm,
    );
    let (mut one, mut two) = (0.0, 0.0);
    let step = |&a: &f64| {
        let out = norm * a + one;
        one = -2.0 * norm * a - back * out + two;
        two = norm * a - twice * out;
        -out
    };
    acceleration.iter().map(step).collect()
}

/// A load with the encoder on it, where the inertia and the friction of a motor ahead both show.
fn before_the_encoder(fitted: &Fitted, acceleration: &[Vec<f64>]) -> Option<Candidate> {
    let segments = fitted.objective.record().segments.iter().zip(acceleration);
    let twice = segments.map(|(s, a)| slope(&slope(a, s.step), s.step));
    let bend = fitted.kept(&twice.collect::<Vec<_>>());
    let friction = friction_ahead(fitted, acceleration)?;
    let mass = fitted.mass;
    Some(Candidate::new(vec![friction, bend], move |c| {
        // 1/w^2 of the load against the motor held, and of motor and load against each other.
        let (held, free) = (c[0], c[1] / mass);
        let load = 1.0 - free / held;
        let frequency = 1.0 / (TAU * held.sqrt());
        let is_one = held > 0.0 && free > 0.0 && effect::LOAD_SHARE_AT_ENCODER.contains(&load);
        let read_at_load = true;
        is_one.then_some(Effect::Resonance {
            frequency,
            load,
            read_at_load,
        })
    }))
}

impl Fitted<'_> {
    /// Acceleration behind the common filter at the full rate, segment by segment.
    pub(super) fn acceleration(&self) -> Vec<Vec<f64>> {
        let record = self.objective.record();
        let mut all: Vec<Vec<f64>> = record
            .segments
            .iter()
            .map(|s| s.acceleration.clone())
            .collect();
        record.filter(&mut all);
        all
    }

    /// A full-rate channel of each segment, which has passed the common filter, at the kept samples.
    pub(super) fn kept(&self, full: &[Vec<f64>]) -> Vec<f64> {
        let record = self.objective.record();
        let shift = self.objective.shift(self.p);
        let mut out = Vec::with_capacity(record.kept());
        for (segment, full) in record.segments.iter().zip(full) {
            record.thin(segment, full, shift, &mut out);
        }
        out
    }
}

/// Central differences, at the ends one-sided.
pub(super) fn slope(values: &[f64], step: f64) -> Vec<f64> {
    let last = values.len().saturating_sub(1);
    (0..values.len())
        .map(|i| {
            let (from, to) = (i.saturating_sub(1), (i + 1).min(last));
            (values[to] - values[from]) / (step * to.abs_diff(from).max(1) as f64)
        })
        .collect()
}

/// By how much friction grows where the motor is ahead by the acceleration (times 1 s^2), at the kept samples.
fn friction_ahead(fitted: &Fitted, acceleration: &[Vec<f64>]) -> Option<Vec<f64>> {
    let record = fitted.objective.record();
    let bristle = fitted.objective.law().layout().kappa?;
    let length = libm::exp(-fitted.p[bristle]);
    let most = acceleration
        .iter()
        .flatten()
        .fold(0.0_f64, |most, a| most.max(a.abs()));
    let ahead = 1e-3 * length / most;
    if !(ahead > 0.0 && ahead.is_finite()) {
        return None;
    }
    let jerks: Vec<Vec<f64>> = record
        .segments
        .iter()
        .zip(acceleration)
        .map(|(s, a)| slope(a, s.step))
        .collect();
    let moved = |by: f64| {
        let mut record = record.clone();
        for (segment, jerk) in record.segments.iter_mut().zip(&jerks) {
            let both = segment.velocity.iter_mut().zip(jerk);
            both.for_each(|(v, j)| *v += by * j);
        }
        let objective = Objective::new(&record, *fitted.objective.law(), fitted.terms);
        objective.model(fitted.p, &fitted.at.solution.coefficients)
    };
    let (low, high) = (moved(-ahead), moved(ahead));
    let both = high.iter().zip(&low);
    Some(both.map(|(h, l)| (h - l) / (2.0 * ahead)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The gain of `y'' - x''` over x'', w^2/(w^2 - s^2) - 1 of an undamped spring.
    #[test]
    fn what_a_rigid_mass_lacks_grows_towards_the_resonance_and_turns_round_beyond() {
        let (rate, own) = (1000.0, 40.0);
        for hertz in [5.0, 20.0, 80.0] {
            let wave: Vec<f64> = (0..20_000)
                .map(|i| libm::sin(TAU * hertz * f64::from(i) / rate))
                .collect();
            let out = lacking(&wave, own / rate, LIGHT);
            let late = 10_000..20_000;
            let sum: f64 = late.clone().map(|i| out[i] * wave[i]).sum();
            let all: f64 = late.map(|i| wave[i] * wave[i]).sum();
            let ratio = (hertz / own).powi(2);
            let gain = ratio / (1.0 - ratio);
            assert!(
                (sum / all / gain - 1.0).abs() < 0.05,
                "{hertz} {}",
                sum / all
            );
        }
    }
}
