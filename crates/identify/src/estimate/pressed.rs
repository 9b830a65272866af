//! What a micro-damping or an inertia that is held at zero leaves open of the other parameters.
//!
//! Micro-damping and stiffness share the force of presliding: where one is too small, the other is too large. A micro-damping
//! for which the data ask a negative value is held at zero, and the deviations of the others would be those of a fit that
//! knows it to be zero. What it really is, is not known: it may be as large as if it were free, and whatever presses it down
//! (a delay, a filter, encoder steps) presses at least as far as the negative value that the data ask for.
//!
//! The same holds of an inertia: where the acceleration hardly changes, its force is a part of the constant one. And of viscous
//! friction: at hardly more than one speed its force is a part of the level.

use crate::estimate::uncertainty;
use crate::law::terms::ColumnKind;
use crate::parameter::physical::Physical;
use crate::scatter::strokes::Strokes;
use crate::separable::linear::dot;
use crate::separable::objective::{Evaluation, Objective};
use nalgebra::{DMatrix, DVector};

/// Variance that it adds to each of the parameters `raw`; `None` where neither is held. `stated` is the covariance of
/// the unknowns with the held one at zero.
pub(super) fn spread(
    objective: &Objective,
    at: &Evaluation,
    raw: &[Physical],
    stated: &DMatrix<f64>,
) -> Option<Vec<f64>> {
    let solution = &at.solution;
    let pressed: Vec<usize> = (0..solution.active.len())
        .filter(|&j| may_be_held(objective.linear()[j].column))
        .filter(|&j| !solution.active[j] && !solution.dependent[j])
        .collect();
    if pressed.is_empty() {
        return None;
    }
    let strokes = Strokes::of(objective.record());
    let free = uncertainty::beside(objective, at, (&strokes, false), |j| {
        solution.active[j] || pressed.contains(&j)
    });
    let unknown = |j: usize| at.slopes.len() + j;
    // One step of least squares, with which the residual asks for the negative value.
    let mut asked = DVector::zeros(stated.nrows());
    for &j in &pressed {
        let pull = dot(&at.columns[j], at.residual());
        asked += free.bread.column(unknown(j)) * pull;
    }
    let opened = free.at_once() - stated + &asked * asked.transpose();
    Some(raw.iter().map(|p| p.variance(&opened).max(0.0)).collect())
}

fn may_be_held(column: ColumnKind) -> bool {
    matches!(
        column,
        ColumnKind::Rate | ColumnKind::Acceleration | ColumnKind::Speed(_)
    )
}
