//! Whether logs of constant velocities tell the same level of friction.

use super::levels::Disagreement;
use crate::parameter::NORMAL_Q95;
use crate::procedure::StaticPoint;
use crate::student;
use std::f64::consts::FRAC_PI_2;
use stiction_parameters::{Name, Quantity};
use stiction_policy::agreement;

/// Standard deviation over median deviation of a normal distribution.
const DEVIATION_OF_MEDIAN: f64 = 1.4826;

/// A point with the force of the curve there, without a constant force.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub point: &'a StaticPoint,
    /// What the curve leaves of the force.
    pub residual: f64,
    /// Friction of the curve.
    pub friction: f64,
}

/// By what part the friction of a log is above that of the curve, and the deviation of that.
struct Level {
    part: f64,
    variance: f64,
}

/// The two logs that differ most surely in their level of friction, at the speeds that both have; `coulomb` is the level of the
/// curve.
pub(crate) fn disagreement(placed: &[Placed], coulomb: f64) -> Option<Disagreement> {
    let mut logs: Vec<usize> = placed.iter().map(|p| p.point.log).collect();
    logs.sort_unstable();
    logs.dedup();
    let mut surest = agreement::MIN_CERTAIN_DEVIATIONS;
    let mut found = None;
    for (i, &a) in logs.iter().enumerate() {
        for &b in &logs[i + 1..] {
            let Some([x, y]) = compared(placed, [a, b]) else {
                continue;
            };
            let (low, high, logs) = match x.part <= y.part {
                true => (x.part, y.part, [a, b]),
                false => (y.part, x.part, [b, a]),
            };
            let deviation = (x.variance + y.variance).sqrt();
            let apart = high - low;
            if apart > agreement::MIN_NAMED_DIFFERENCE && apart > surest * deviation {
                surest = apart / deviation;
                found = Some(Disagreement {
                    name: Name::from(Quantity::Coulomb),
                    logs,
                    values: [low, high].map(|part| coulomb * (1.0 + part)),
                    deviation: coulomb * deviation,
                    part: apart,
                });
            }
        }
    }
    found
}

impl Disagreement {
    /// Variance that a level has between two such logs, SI; Student's for the one degree of freedom that their difference has.
    pub(crate) fn between(&self, value: f64) -> f64 {
        let few = student::whole(1) / NORMAL_Q95;
        let half = 0.5 * self.part * value;
        few * few * half * half
    }
}

/// Levels of two logs over the speeds that they share.
fn compared(placed: &[Placed], logs: [usize; 2]) -> Option<[Level; 2]> {
    let speeds = |log: usize| {
        let own = placed.iter().filter(move |p| p.point.log == log);
        own.fold([f64::INFINITY, 0.0_f64], |[low, high], p| {
            let v = p.point.velocity.abs();
            [low.min(v), high.max(v)]
        })
    };
    let [a, b] = logs.map(speeds);
    let shared = a[0].max(b[0])..=a[1].min(b[1]);
    let [a, b] = logs.map(|log| {
        let own = placed.iter().filter(|p| p.point.log == log);
        let own = own.filter(|p| shared.contains(&p.point.velocity.abs()));
        level(&own.copied().collect::<Vec<_>>())
    });
    Some([a?, b?])
}

/// A factor on the friction of the curve: the median over the points, since an axis that stuck instead of sliding is far off, and
/// the deviation of a median from their median deviation.
fn level(points: &[Placed]) -> Option<Level> {
    let parts = points.iter().map(|p| p.residual / p.friction);
    let mut parts: Vec<f64> = parts.filter(|part| part.is_finite()).collect();
    if parts.len() < agreement::MIN_POINTS {
        return None;
    }
    let part = median(&mut parts);
    let mut off: Vec<f64> = parts.iter().map(|x| (x - part).abs()).collect();
    let noise = points.iter().map(|p| (p.point.error / p.friction).abs());
    let mut noise: Vec<f64> = noise.filter(|x| x.is_finite()).collect();
    let scatter = (DEVIATION_OF_MEDIAN * median(&mut off)).max(median(&mut noise));
    let variance = FRAC_PI_2 * scatter * scatter / parts.len() as f64;
    (variance > 0.0).then_some(Level { part, variance })
}

/// The middle of some finite numbers; of two the upper one.
fn median(x: &mut [f64]) -> f64 {
    let middle = x.len() / 2;
    *x.select_nth_unstable_by(middle, f64::total_cmp).1
}
