//! A load on a spring.
//!
//! With x the motor, y the load, m its mass and w = sqrt(k/m), the spring exerts `m y''` and
//! `y'' + 2 zeta w (y' - x') + w^2 (y - x) = 0`.
//! - Encoder on the motor: the rigid mass lacks `m (y'' - x'')`, the acceleration behind a filter that is sharp at w.
//! - Encoder on the load: the motor is ahead by `x - y = y''/w^2`, well below w. Its inertia adds `(M - m) y''''/w^2`, and its
//!   friction is that at the velocity `y' + y'''/w^2`.

use super::{Between, Coupling, Encoder, Fitted, LOAD, WAYS, slope};
use crate::conditioning::record::Record;
use crate::separable::objective::Objective;
use std::f64::consts::{PI, TAU};

/// Part of the residual from which a spring behind the motor, and one before the encoder, is named, and the part of it that
/// the friction of a motor ahead explains beyond its inertia.
const BEHIND: f64 = 0.3;
const BEFORE: f64 = 0.3;
const OF_FRICTION: f64 = 0.1;
/// Largest load of an encoder on it, as a part of the mass: behind more, other laws of friction look alike.
const LOAD_OF_ENCODER: f64 = 0.75;
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
/// A light spring is looked for so far beside the best strong one, in so many steps, and then by golden section.
const BESIDE: f64 = 0.2;
const CLOSE: usize = 16;
const REFINED: usize = 8;

/// The best load on a spring behind the motor.
pub(super) struct Behind {
    /// Its column.
    pub column: Vec<f64>,
    frequency: f64,
    /// Part of the residual that it explains.
    pub share: f64,
    /// Every frequency that was tried, with the part of the residual that it explains.
    tried: Vec<(f64, f64)>,
}

/// The best strongly damped spring behind the motor; `None` where none explains anything.
pub(super) fn behind_the_motor(fitted: &Fitted) -> Option<Behind> {
    let top = highest(fitted.objective.record());
    let ratio = libm::pow(DOWN, 1.0 / (TRIED - 1) as f64);
    let tried = (0..TRIED).map(|i| top / libm::pow(ratio, i as f64));
    best(fitted, tried, STRONG)
}

fn highest(record: &Record) -> f64 {
    let rate = 1.0 / record.step();
    match record.common_hz {
        Some(cutoff) => (OF_CUTOFF * cutoff).min(MOST_OF_RATE * rate),
        None => OF_RATE * rate,
    }
}

/// The best of several frequencies whose load is a part of the mass.
fn best(fitted: &Fitted, tried: impl Iterator<Item = f64>, damping: f64) -> Option<Behind> {
    let (mut best, mut all) = (None::<Behind>, Vec::new());
    for frequency in tried {
        let (column, share, load) = at(fitted, frequency, damping);
        if !(load > 0.0 && load < 1.0) {
            all.push((frequency, 0.0));
            continue;
        }
        all.push((frequency, share));
        if best.as_ref().is_none_or(|best| share > best.share) {
            best = Some(Behind {
                column,
                frequency,
                share,
                tried: Vec::new(),
            });
        }
    }
    best.map(|best| Behind { tried: all, ..best })
}

/// The column of a frequency, the part of the residual that it explains, and the load as a part of the mass.
fn at(fitted: &Fitted, frequency: f64, damping: f64) -> (Vec<f64>, f64, f64) {
    let segments = fitted.objective.record().segments.iter();
    let behind: Vec<Vec<f64>> = segments
        .zip(&fitted.acceleration)
        .map(|(s, a)| lacking(a, frequency * s.step, damping))
        .collect();
    let column = fitted.kept(&behind);
    let found = fitted.beside.explained(&column);
    let load = found.coefficient / fitted.mass;
    (column, found.share, load)
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

impl Behind {
    /// The resonance that it is, where it is sharp and explains enough.
    pub fn named(&self, fitted: &Fitted) -> Option<Coupling> {
        if self.share < 0.5 * BEHIND {
            return None;
        }
        let top = highest(fitted.objective.record());
        let step = |i: usize| 1.0 + BESIDE * (2.0 * i as f64 / (CLOSE - 1) as f64 - 1.0);
        let close = (0..CLOSE).map(|i| self.frequency * step(i));
        let sharp = best(fitted, close.filter(|f| *f <= top), LIGHT)?;
        let next = 2.0 * BESIDE / (CLOSE - 1) as f64 * self.frequency;
        let (mut from, mut to) = (sharp.frequency - next, sharp.frequency + next);
        let part = 0.5 * (5.0_f64.sqrt() - 1.0);
        let share = |f: f64| at(fitted, f, LIGHT).1;
        for _ in 0..REFINED {
            let (a, b) = (to - part * (to - from), from + part * (to - from));
            if share(a) > share(b) {
                to = b;
            } else {
                from = a;
            }
        }
        let frequency = 0.5 * (from + to);
        let (column, share, load) = at(fitted, frequency, LIGHT);
        if share < BEHIND || share < self.share || !LOAD.contains(&load) {
            return None;
        }
        // What a relative change of the frequency does to the model.
        let small = 0.5 * LIGHT;
        let beside = [1.0 - small, 1.0 + small].map(|f| at(fitted, f * frequency, LIGHT).0);
        let scale = load * fitted.mass / (2.0 * small);
        let change: Vec<f64> = beside[1]
            .iter()
            .zip(&beside[0])
            .map(|(high, low)| scale * (high - low))
            .collect();
        let mut course = [&self.tried[..], &sharp.tried, &[(frequency, share)]].concat();
        // Of the strongly damped ones only those farther off.
        let within = |f: f64| (f / self.frequency - 1.0).abs() <= BESIDE;
        let far = course.split_off(self.tried.len());
        course.retain(|(f, _)| !within(*f));
        course.extend(far);
        course.sort_by(|a, b| a.0.total_cmp(&b.0));
        Some(Coupling {
            between: Between::Spring {
                frequency,
                encoder: Encoder::Motor,
            },
            deviation: fitted.beside.with(&column).deviation(&change, WAYS),
            load,
            share,
            course,
        })
    }
}

/// A load with the encoder on it, where the inertia and the friction of a motor ahead both show; `bend` is y''''.
pub(super) fn before_the_encoder(fitted: &Fitted, bend: &[f64]) -> Option<Coupling> {
    let of_bend = fitted.beside.explained(bend).share;
    let friction = friction_ahead(fitted)?;
    let with_bend = fitted.beside.with(bend);
    let of_friction = with_bend.explained(&friction);
    let share = of_bend + (1.0 - of_bend) * of_friction.share;
    let inertia = fitted.beside.with(&friction).explained(bend).coefficient;
    // 1/w^2 of the load against the motor held, and of motor and load against each other.
    let (held, free) = (of_friction.coefficient, inertia / fitted.mass);
    let load = 1.0 - free / held;
    let shows = share >= BEFORE && share - of_bend >= OF_FRICTION && held > 0.0 && free > 0.0;
    if !shows || !(LOAD.start..=LOAD_OF_ENCODER).contains(&load) {
        return None;
    }
    let left = with_bend.with(&friction);
    // Its size is 1/w^2: half of its relative deviation is that of the frequency.
    let change: Vec<f64> = friction.iter().map(|x| 2.0 * held * x).collect();
    let outside = with_bend.outside(&change);
    let deviation = (left.square() / (WAYS * outside.iter().map(|x| x * x).sum::<f64>())).sqrt();
    let frequency = 1.0 / (TAU * held.sqrt());
    // What another 1/w^2 explains, the inertia free.
    let explained = |f: f64| {
        let size = 1.0 / (TAU * f).powi(2) / held;
        of_bend + (1.0 - of_bend) * of_friction.share * (2.0 * size - size * size).max(-1.0)
    };
    let course = (0..=40).map(|i| frequency * libm::pow(2.0, f64::from(i) / 20.0 - 0.5));
    Some(Coupling {
        between: Between::Spring {
            frequency,
            encoder: Encoder::Load,
        },
        deviation,
        load,
        share,
        course: course.map(|f| (f, explained(f).max(0.0))).collect(),
    })
}

/// By how much friction grows where the motor is ahead by the acceleration (times 1 s^2), at the kept samples.
fn friction_ahead(fitted: &Fitted) -> Option<Vec<f64>> {
    let record = fitted.objective.record();
    let bristle = fitted.objective.law().layout().kappa?;
    let length = libm::exp(-fitted.p[bristle]);
    let accelerations = fitted.acceleration.iter().flatten();
    let most = accelerations.fold(0.0_f64, |most, a| most.max(a.abs()));
    let ahead = 1e-3 * length / most;
    if !(ahead > 0.0 && ahead.is_finite()) {
        return None;
    }
    let jerks: Vec<Vec<f64>> = record
        .segments
        .iter()
        .zip(&fitted.acceleration)
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
