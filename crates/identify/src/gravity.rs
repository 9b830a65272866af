//! Whether the force of a rotary axis follows its angle, as gravity does: asked where a law without gravity explains little, or friction is
//! another in each direction.

use nalgebra::{DMatrix, DVector};

/// Samples of a log that are looked at: a few thousand tell.
const SAMPLES: usize = 4000;
/// Time to either side over which a speed is taken, s: encoder steps then do not drown it.
const WINDOW: f64 = 0.01;

/// A log, as far as gravity shows in it.
#[derive(Clone, Copy, Debug)]
pub struct Swing<'a> {
    /// s.
    pub time: &'a [f64],
    /// rad.
    pub angle: &'a [f64],
    /// In the unit of the log.
    pub force: &'a [f64],
    /// Hz.
    pub rate: f64,
}

/// Part of the variance that direction, speed in each direction, acceleration and a constant leave of the force, which the sine and
/// cosine of the angle explain, 0 to 1; 0 where nothing can be told.
///
/// ```
/// use stiction_identify::{Swing, explained_by_gravity};
///
/// let time: Vec<f64> = (0..4000).map(|i| 1e-3 * f64::from(i)).collect();
/// let angle: Vec<f64> = time.iter().map(|t| 0.8 * (2.0 * t).sin()).collect();
/// // 2 N m of gravity and .5 N m of friction.
/// let force = |t: &f64| 2.0 * (0.8 * (2.0 * t).sin()).sin() + 0.5 * (2.0 * t).cos().signum();
/// let force: Vec<f64> = time.iter().map(force).collect();
/// let log = Swing { time: &time, angle: &angle, force: &force, rate: 1000.0 };
/// assert!(explained_by_gravity(&[log]) > 0.9);
///
/// // Friction that differs with the direction is no weight.
/// let speed = |t: f64| 1.6 * (2.0 * t).cos();
/// let friction = |v: f64| if v > 0.0 { 0.5 + 0.4 * v } else { -0.3 + 0.1 * v };
/// let force: Vec<f64> = time.iter().map(|t| friction(speed(*t)) + 0.1 * (40.0 * t).sin()).collect();
/// let log = Swing { force: &force, ..log };
/// assert!(explained_by_gravity(&[log]) < 0.1);
/// ```
pub fn explained_by_gravity(logs: &[Swing]) -> f64 {
    let mut rows: Vec<[f64; 7]> = Vec::new();
    let mut forces = Vec::new();
    for log in logs {
        let x = log.angle;
        let n = log.time.len().min(x.len()).min(log.force.len());
        let wide = ((WINDOW * log.rate) as usize).clamp(1, n.max(1));
        for i in (2 * wide..n.saturating_sub(2 * wide)).step_by((n / SAMPLES).max(1)) {
            let dt = log.time[i + wide] - log.time[i - wide];
            let speed = |i: usize| (x[i + wide] - x[i - wide]) / dt;
            let v = speed(i);
            let a = (speed(i + wide) - speed(i - wide)) / dt;
            let (sin, cos) = (libm::sin(x[i]), libm::cos(x[i]));
            rows.push([v.signum(), v, v.abs(), a, 1.0, sin, cos]);
            forces.push(log.force[i]);
        }
    }
    let left = |columns: usize| {
        let a = DMatrix::from_fn(rows.len(), columns, |i, j| rows[i][j]);
        let b = DVector::from_column_slice(&forces);
        let found = a.clone().svd(true, true).solve(&b, 1e-12).ok()?;
        Some((b - a * found).norm_squared())
    };
    if rows.len() < 2 * 7 || rows.iter().flatten().any(|x| !x.is_finite()) {
        return 0.0;
    }
    match (left(5), left(7)) {
        (Some(without), Some(with)) if without > 0.0 && with.is_finite() => {
            (1.0 - with / without).max(0.0)
        }
        _ => 0.0,
    }
}
