//! A load behind a gap, with the encoder on the motor.
//!
//! Between two stops the load is free but for a little friction of its own; a stop that catches it up takes it along, and it
//! does not bounce. So its velocity follows from the motion of the motor, and the force that the rigid mass lacks is its mass
//! times the derivative of the difference of both velocities.

use super::super::Divisions;
use super::{Beside, Between, Coupling, Fitted, LOAD, WAYS, slope};
use crate::conditioning::record::Record;

/// Part of the residual that a gap explains from which it is named, no less than a spring behind the motor; the part that it
/// explains beyond any spring; and the factor within which both must find the same width.
const NAMED: f64 = 0.25;
const BEYOND: f64 = 0.15;
const ALIKE: f64 = 1.5;
/// Part that a gap explains of the kept samples alone from which it is looked at closely.
const SUSPECTED: f64 = 0.06;
/// Smallest width in encoder counts or, without them, in strokes; the largest in strokes; how many at most, each twice the
/// one before.
const COUNTS: f64 = 4.0;
const LEAST_OF_STROKE: f64 = 1e-5;
const OF_STROKE: f64 = 0.02;
const WIDTHS: i32 = 12;
/// Friction of the load itself, as a part of the viscous friction over the mass: what is tried.
const DRAG: f64 = 0.2;
const DRAGS: [f64; 3] = [0.0, 0.1, 0.3];
/// Widths beside the suspected one: steps of half an octave to each side.
const STEPS: i32 = 3;

/// The width at which a gap is suspected, m or rad. `drag` is the viscous friction over the mass, 1/s.
pub(super) fn suspected(
    divisions: &Divisions,
    record: &Record,
    beside: &Beside,
    mass: f64,
    drag: f64,
) -> Option<f64> {
    let along = &divisions.measures;
    let (low, high) = along
        .position
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(*x), high.max(*x))
        });
    let stroke = high - low;
    let least = match record.resolution {
        Some(count) if count > 0.0 => COUNTS * count,
        _ => LEAST_OF_STROKE * stroke,
    };
    if !(least > 0.0 && stroke.is_finite()) {
        return None;
    }
    let step = record.step() * record.decimate as f64;
    let mut best = (SUSPECTED, None);
    let widths = (0..WIDTHS).map(|i| least * libm::pow(2.0, f64::from(i)));
    for width in widths.take_while(|w| *w <= OF_STROKE * stroke) {
        let mut difference = Vec::with_capacity(along.time.len());
        // Between samples that do not count nothing is known of the load.
        let gaps = along.time.windows(2).enumerate();
        let breaks = gaps.filter(|(_, t)| t[1] - t[0] > 1.5 * step);
        let mut from = 0;
        for to in breaks.map(|(i, _)| i + 1).chain([along.time.len()]) {
            let apart = apart(
                &along.position[from..to],
                &along.speed[from..to],
                step,
                width,
                DRAG * drag,
            );
            difference.extend(slope(&apart, step));
            from = to;
        }
        let found = beside.explained(&difference);
        if found.share > best.0 && found.coefficient > 0.0 && found.coefficient < 2.0 * mass {
            best = (found.share, Some(width));
        }
    }
    best.1
}

/// Velocity of the load less that of the motor.
fn apart(position: &[f64], speed: &[f64], step: f64, width: f64, drag: f64) -> Vec<f64> {
    let half = 0.5 * width;
    let slowed = libm::exp(-drag * step);
    let mut load = position.first().copied().unwrap_or(0.0);
    let mut own = speed.first().copied().unwrap_or(0.0);
    let mut is_first = true;
    let next = |(&x, &v): (&f64, &f64)| {
        if std::mem::take(&mut is_first) {
            return 0.0;
        }
        load += step * own;
        own *= slowed;
        if load - x > half {
            load = x + half;
            own = own.min(v);
        } else if load - x < -half {
            load = x - half;
            own = own.max(v);
        }
        own - v
    };
    position.iter().zip(speed).map(next).collect()
}

/// The gap near the suspected width, where it explains enough, more than a spring that explains `of_spring`, and enough beyond
/// `springs`.
pub(super) fn found(
    fitted: &Fitted,
    suspected: f64,
    drag: f64,
    (springs, of_spring): (&Beside, f64),
) -> Option<Coupling> {
    let column = |width: f64, part: f64| {
        let record = fitted.objective.record();
        let mut full: Vec<Vec<f64>> = record
            .segments
            .iter()
            .map(|s| apart(&s.position, &s.velocity, s.step, width, part * drag))
            .collect();
        full.iter_mut()
            .for_each(|x| record.filter(std::iter::once(x)));
        let segments = record.segments.iter().zip(&full);
        let slopes: Vec<Vec<f64>> = segments.map(|(s, x)| slope(x, s.step)).collect();
        fitted.kept(&slopes)
    };
    let mut alone = None::<Found>;
    let mut beyond = None::<Found>;
    let mut course = Vec::new();
    for i in -STEPS..=STEPS {
        let width = suspected * libm::pow(2.0, 0.5 * f64::from(i));
        let mut most = 0.0_f64;
        for part in DRAGS {
            let column = column(width, part);
            let found = |beside: &Beside| {
                let own = beside.explained(&column);
                let load = own.coefficient / fitted.mass;
                LOAD.contains(&load).then_some(Found {
                    width,
                    part,
                    share: own.share,
                    load,
                })
            };
            let own = found(&fitted.beside);
            most = own.as_ref().map_or(most, |own| own.share.max(most));
            alone = better(alone, own);
            beyond = better(beyond, found(springs));
        }
        course.push((width, most));
    }
    let (alone, beyond) = (alone?, beyond?);
    let alike = alone.width / beyond.width;
    let surely = alone.share >= NAMED.max(of_spring)
        && beyond.share >= BEYOND
        && (1.0 / ALIKE..=ALIKE).contains(&alike);
    if !surely {
        return None;
    }
    let own = column(alone.width, alone.part);
    let small = 0.1;
    let beside = [1.0 - small, 1.0 + small].map(|f| column(f * alone.width, alone.part));
    let scale = alone.load * fitted.mass / (2.0 * small);
    let both = beside[1].iter().zip(&beside[0]);
    let change: Vec<f64> = both.map(|(high, low)| scale * (high - low)).collect();
    Some(Coupling {
        between: Between::Gap { width: alone.width },
        deviation: fitted.beside.with(&own).deviation(&change, WAYS),
        load: alone.load,
        share: alone.share,
        course,
    })
}

/// A gap that was tried.
struct Found {
    width: f64,
    /// Friction of the load, as a part of the viscous friction.
    part: f64,
    share: f64,
    load: f64,
}

fn better(best: Option<Found>, other: Option<Found>) -> Option<Found> {
    match (best, other) {
        (Some(best), Some(other)) if best.share >= other.share => Some(best),
        (best, None) => best,
        (_, other) => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A motor at constant speed that stops: its load goes on through the gap, at its speed, and is stopped.
    #[test]
    fn a_load_crosses_its_gap_and_is_caught_up() {
        let (step, width) = (1e-3, 2e-3);
        let speed: Vec<f64> = (0..200).map(|i| if i < 100 { 0.1 } else { 0.0 }).collect();
        let mut x = 0.0;
        let position: Vec<f64> = speed
            .iter()
            .map(|v| {
                x += step * v;
                x
            })
            .collect();
        let difference = apart(&position, &speed, step, width, 0.0);
        let free = difference.iter().filter(|d| **d > 0.0).count();
        // Half of the gap lies before it where it began in the middle: 1 mm at 0.1 m/s, 10 ms.
        assert!((9..=11).contains(&free), "{free}");
        assert!(difference[..100].iter().all(|d| d.abs() < 1e-12));
        assert_eq!(difference[150], 0.0);
    }
}
