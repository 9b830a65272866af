//! A wave over the position.

use std::f64::consts::TAU;

/// Waves that are tried for each one that fits the stroke: between two of them the phase at the end differs by a quarter.
const FINE: f64 = 4.0;
/// Most waves over the stroke.
const MOST_WAVES: f64 = 64.0;
/// Samples on which waves are tried, at most: many times the waves.
const MOST_SAMPLES: usize = 2000;
/// Steps of the search beside the best of them.
const REFINED: usize = 40;

/// A force that repeats with the position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ripple {
    /// Its pitch, m or rad.
    pub pitch: f64,
    /// Its amplitude, in the unit of the force.
    pub amplitude: f64,
    /// Part of the variance of the residual that it explains, 0 to 1.
    pub share: f64,
}

impl Ripple {
    /// The wave over the position that explains most of a residual; `None` for a stroke of no length.
    pub(super) fn of(position: &[f64], residual: &[f64]) -> Option<Self> {
        let low = position.iter().copied().fold(f64::INFINITY, f64::min);
        let high = position.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let stroke = high - low;
        if !(stroke > 0.0 && stroke.is_finite()) {
            return None;
        }
        let every = position.len().div_ceil(MOST_SAMPLES).max(1);
        let some = |x: &[f64]| -> Vec<f64> { x.iter().step_by(every).copied().collect() };
        let (few, left) = (some(position), some(residual));
        let at = |waves: f64| fitted(&few, &left, waves / stroke);
        let tried = (FINE as usize..(FINE * MOST_WAVES) as usize).map(|i| i as f64 / FINE);
        let best = tried
            .map(|waves| (waves, at(waves)))
            .max_by(|a, b| a.1.1.total_cmp(&b.1.1))?;
        // Golden section between its neighbours, where there is one maximum.
        let (mut from, mut to) = (best.0 - 1.0 / FINE, best.0 + 1.0 / FINE);
        let part = 0.5 * (5.0_f64.sqrt() - 1.0);
        for _ in 0..REFINED {
            let (a, b) = (to - part * (to - from), from + part * (to - from));
            if at(a).1 > at(b).1 {
                to = b;
            } else {
                from = a;
            }
        }
        let waves = 0.5 * (from + to);
        let (amplitude, share) = fitted(position, residual, waves / stroke);
        Some(Ripple {
            pitch: stroke / waves,
            amplitude,
            share,
        })
    }
}

/// Amplitude of the wave of a spatial frequency (1/m) by least squares, and the part of the squares that it explains.
fn fitted(position: &[f64], residual: &[f64], frequency: f64) -> (f64, f64) {
    let (mut ss, mut sc, mut cc, mut sr, mut cr, mut rr) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (x, r) in position.iter().zip(residual) {
        let (s, c) = libm::sincos(TAU * frequency * x);
        ss += s * s;
        sc += s * c;
        cc += c * c;
        sr += s * r;
        cr += c * r;
        rr += r * r;
    }
    let determinant = ss * cc - sc * sc;
    if determinant.is_nan() || determinant <= 0.0 || rr <= 0.0 {
        return (0.0, 0.0);
    }
    let a = (cc * sr - sc * cr) / determinant;
    let b = (ss * cr - sc * sr) / determinant;
    (a.hypot(b), (a * sr + b * cr) / rr)
}
