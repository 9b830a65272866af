//! A load behind a gap, with the encoder on the motor.
//!
//! Between two stops the load is free but for a little friction of its own; a stop that catches it up takes it along, and it
//! does not bounce. So its velocity follows from the motion of the motor, and the force that the rigid mass lacks is its mass
//! times the derivative of the difference of both velocities.

use super::beside::Beside;
use super::spring::slope;
use super::{Candidate, Effect, Fitted};
use crate::conditioning::record::extent;
use crate::law::terms::ColumnKind;
use stiction_policy::effect;

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
/// Halvings of such a step, to 2 % of the width.
const HALVINGS: i32 = 4;

/// The gap that explains most, where one is suspected.
pub(super) fn candidate(fitted: &Fitted, beside: &Beside) -> Option<Candidate> {
    let (record, mass) = (fitted.objective.record(), fitted.mass);
    (mass > 0.0 && fitted.objective.law().layout().kappa.is_some()).then_some(())?;
    let drag = viscous(fitted) / mass;
    let suspected = suspected(fitted, beside, drag)?;
    let column = |width: f64, part: f64| {
        let segments = record.segments.iter();
        let mut full: Vec<Vec<f64>> = segments
            .map(|s| apart(&s.position, &s.velocity, s.step, width, part * drag))
            .collect();
        record.filter(&mut full);
        let segments = record.segments.iter().zip(&full);
        let slopes: Vec<Vec<f64>> = segments.map(|(s, x)| slope(x, s.step)).collect();
        fitted.kept(&slopes)
    };
    let mut best = (0.0, None);
    let mut course = Vec::new();
    for i in -STEPS..=STEPS {
        let width = suspected * libm::pow(2.0, 0.5 * f64::from(i));
        let mut most = 0.0_f64;
        for part in DRAGS {
            let column = column(width, part);
            let own = beside.explained(&column);
            if effect::LOAD_SHARE.contains(&(own.coefficient / mass)) {
                most = most.max(own.share);
                if own.share > best.0 {
                    best = (own.share, Some((width, part, column)));
                }
            }
        }
        course.push((width, most));
    }
    let (width, part, own) = best.1?;
    // Whether there is a gap is judged at the widths above; how wide it is, is looked for between them.
    let finest = (1..=HALVINGS).fold((best.0, width), |at, k| {
        let step = libm::pow(2.0, libm::pow(0.5, f64::from(k + 1)));
        [at.1 / step, at.1 * step]
            .into_iter()
            .fold(at, |at, width| {
                let own = beside.explained(&column(width, part));
                let fits = effect::LOAD_SHARE.contains(&(own.coefficient / mass));
                match fits && own.share > at.0 {
                    true => (own.share, width),
                    false => at,
                }
            })
    });
    let small = 0.1;
    let [low, high] = [1.0 - small, 1.0 + small].map(|f| column(f * width, part));
    let slope = high.iter().zip(&low).map(|(h, l)| (h - l) / (2.0 * small));
    let slope = slope.collect();
    let mut candidate = Candidate::new(vec![own], move |c| {
        let load = c[0] / mass;
        effect::LOAD_SHARE
            .contains(&load)
            .then_some(Effect::Backlash {
                width: finest.1,
                load,
            })
    });
    (candidate.course, candidate.slope) = (course, Some(slope));
    Some(candidate)
}

/// Viscous friction, of an asymmetric law that of either direction.
fn viscous(fitted: &Fitted) -> f64 {
    let linear = fitted.objective.linear().iter();
    let terms = linear.zip(&fitted.at.solution.coefficients);
    let speed = terms.filter(|(term, _)| matches!(term.column, ColumnKind::Speed(_)));
    speed.map(|(_, c)| c.max(0.0)).fold(0.0, f64::max)
}

/// The width at which a gap is suspected, m or rad. `drag` is the viscous friction over the mass, 1/s.
fn suspected(fitted: &Fitted, beside: &Beside, drag: f64) -> Option<f64> {
    let (record, along) = (fitted.objective.record(), &fitted.measures);
    let (low, high) = extent(&along.position);
    let stroke = high - low;
    let least = match record.resolution {
        Some(count) if count > 0.0 => COUNTS * count,
        _ => LEAST_OF_STROKE * stroke,
    };
    if !(least > 0.0 && stroke.is_finite()) {
        return None;
    }
    let step = record.step() * record.decimate as f64;
    let mut best = (effect::MIN_SUSPECTED_GAP, None);
    let widths = (0..WIDTHS).map(|i| least * libm::pow(2.0, f64::from(i)));
    for width in widths.take_while(|w| *w <= OF_STROKE * stroke) {
        let mut difference = Vec::with_capacity(along.time.len());
        // Between samples that do not count nothing is known of the load.
        let gaps = along.time.windows(2).enumerate();
        let breaks = gaps.filter(|(_, t)| t[1] - t[0] > 1.5 * step);
        let mut from = 0;
        for to in breaks.map(|(i, _)| i + 1).chain([along.time.len()]) {
            let (position, speed) = (&along.position[from..to], &along.speed[from..to]);
            let apart = apart(position, speed, step, width, DRAG * drag);
            difference.extend(slope(&apart, step));
            from = to;
        }
        let found = beside.explained(&difference);
        let part = found.coefficient / fitted.mass;
        if found.share > best.0 && part > 0.0 && part < 2.0 {
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
