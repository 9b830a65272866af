//! Dynamics between the logged force and the motion that a rigid mass and a delay do not have.
//!
//! A filter or a mean over several rows in front of the force, a current loop, a motor ahead of the encoder on its load: to first
//! order all of them are a delay, which a fit finds. To second order the force gains or lacks a part that goes with its second
//! derivative, as half the square of a time (see [`lag`](crate::lag)). It is one more column beside those of the law. Filters and
//! encoder steps leave some of it as well; the replicas show how much.

use super::coupling::beside::Beside;
use crate::estimate::uncertainty::sandwich;
use crate::separable::objective::{Evaluation, Objective};

/// Deviations beyond what replicas have from which such a part is sure, and the part of the residual that it then explains.
const SURE: f64 = 5.0;
const LEAST_SHARE: f64 = 0.1;
/// Part of a misfit of the shape of the law that it explains where it is the cause.
pub(super) const PART_OF_MISFIT: f64 = 0.5;

/// Dynamics between force and motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dynamics {
    /// Square of the time that they have, s^2: negative where the logged force is smoother than the motion that belongs to it,
    /// positive where the force that acts is smoother than the logged one.
    pub square: f64,
    /// Its standard deviation, s^2.
    pub deviation: f64,
    /// Part of the variance of the residual that it explains, 0 to 1.
    pub share: f64,
}

/// The square of the time that a fit shows, samples; `None` where the delay of the force is not fitted.
pub(crate) fn square(
    objective: &Objective,
    (at, p): (&Evaluation, &[f64]),
    residual: &[f64],
) -> Option<f64> {
    let column = column(objective, at, p)?;
    let beside = Beside::new(&at.jacobian(), residual);
    Some(beside.explained(&column).coefficient)
}

fn column(objective: &Objective, at: &Evaluation, p: &[f64]) -> Option<Vec<f64>> {
    let fitted = objective.is_delayed() && objective.law().layout().kappa.is_some();
    fitted.then(|| objective.bend(p, &at.solution.coefficients))
}

/// Such dynamics, `replicas` being the squares that fits of replicas show, samples; `None` where a fit cannot show them.
pub(crate) fn sought(
    objective: &Objective,
    (at, p): (&Evaluation, &[f64]),
    residual: &[f64],
    replicas: &[f64],
) -> Option<Dynamics> {
    let column = column(objective, at, p)?;
    let beside = Beside::new(&at.jacobian(), residual);
    let found = beside.explained(&column);
    let count = replicas.len() as f64;
    let mean = replicas.iter().sum::<f64>() / count.max(1.0);
    let scatter = replicas.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
    let scatter = scatter / (count - 1.0).max(1.0);
    // Of what is left once it is taken off: what it leaves itself is no noise.
    let rest = beside.with(&column);
    let mut jacobian = at.jacobian();
    jacobian.push(&column);
    let known = sandwich(&jacobian, rest.residual(), &objective.record().breaks());
    let own = jacobian.len() - 1;
    let variance = known.covariance[(own, own)] + scatter;
    let square = found.coefficient - mean;
    let share = found.share * (square / found.coefficient).powi(2);
    let step = objective.record().step();
    Some(Dynamics {
        square: square * step * step,
        deviation: variance.sqrt() * step * step,
        share: share.min(1.0),
    })
}

impl Dynamics {
    /// Whether there surely are some.
    pub(super) fn is_sure(&self) -> bool {
        self.square.abs() > SURE * self.deviation && self.share >= LEAST_SHARE
    }
}
