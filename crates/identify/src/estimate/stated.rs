//! What a mass or a delay that is stated leaves open of the other parameters.
//!
//! One that is not that of the machine is made up for by the others: a tenth of a sample of delay moves micro-damping by some
//! percent. What the log says against it is the coefficient of one more column, by how much the model changes with it. As far as
//! that goes beyond chance, nobody knows whether it is the statement or the law, and the parameters may be where the fit would
//! have them with it.

use crate::estimate::uncertainty::{bread, followed, sandwich};
use crate::held_delay;
use crate::law::terms::{Delay, DelayFrom, Mass, Terms};
use crate::separable::linear::dot;
use crate::separable::objective::{Evaluation, Objective};
use nalgebra::DMatrix;

/// Deviations that chance makes.
const CHANCE: f64 = 2.0;

/// What a residual has of a force one sample later, and of the stated inertia; `None` where they are not stated.
pub(crate) type Against = [Option<f64>; 2];

/// What the residual of a fit has against what is stated.
pub(crate) fn against(
    objective: &Objective,
    terms: &Terms,
    (at, p): (&Evaluation, &[f64]),
) -> Against {
    columns(objective, terms, (at, p)).map(|column| {
        let column = column?;
        Some(beside(at, &column).2)
    })
}

/// Covariance of the unknowns, nonlinear then linear, that it leaves, `replicas` being what fits of replicas have against it, which is
/// what encoder and filters make; `None` where nothing is stated, or the log has nothing against it.
pub(super) fn spread(
    objective: &Objective,
    terms: &Terms,
    (at, p): (&Evaluation, &[f64]),
    replicas: &[Against],
) -> Option<DMatrix<f64>> {
    let columns = columns(objective, terms, (at, p)).into_iter().enumerate();
    let moved = |(i, column): (usize, Option<Vec<f64>>)| {
        let replicas: Vec<f64> = replicas.iter().filter_map(|against| against[i]).collect();
        moved(objective, at, &column?, &replicas)
    };
    let moved: Vec<Vec<f64>> = columns.filter_map(moved).collect();
    let of = |i: usize, j: usize| moved.iter().map(|moved| moved[i] * moved[j]).sum::<f64>();
    let n = moved.first()?.len();
    Some(DMatrix::from_fn(n, n, of))
}

/// By how much a force that is one sample later changes the model, and the stated inertia.
fn columns(
    objective: &Objective,
    terms: &Terms,
    (at, p): (&Evaluation, &[f64]),
) -> [Option<Vec<f64>>; 2] {
    [delay(objective, terms, (at, p)), mass(objective, terms, p)]
}

fn delay(objective: &Objective, terms: &Terms, (at, p): (&Evaluation, &[f64])) -> Option<Vec<f64>> {
    let Delay::Given(delay) = terms.delay else {
        return None;
    };
    let stated = terms.delay_from == DelayFrom::Stated && terms.delay_deviation == 0.0;
    let step = objective.record().step();
    stated.then(|| held_delay::column(objective, terms, (p, at), delay, step))
}

fn mass(objective: &Objective, terms: &Terms, p: &[f64]) -> Option<Vec<f64>> {
    let Mass::Given(mass) = terms.mass else {
        return None;
    };
    let without = Terms {
        mass: Mass::Absent,
        ..terms.clone()
    };
    let without = Objective::new(objective.record(), *objective.law(), &without);
    let (all, rest) = (without.target_at(p), objective.target_at(p));
    let column = all.iter().zip(rest.iter()).map(|(a, b)| a - b).collect();
    (mass > 0.0).then_some(column)
}

/// The columns of a fit with one more, the last; the inverse of the products of all, and the coefficient of that one.
fn beside<'a>(at: &'a Evaluation, column: &'a [f64]) -> (Vec<&'a [f64]>, DMatrix<f64>, f64) {
    let mut jacobian = at.jacobian();
    jacobian.push(column);
    let (bread, own) = (bread(&jacobian), jacobian.len() - 1);
    let coefficient = bread[(own, own)] * dot(column, at.residual());
    (jacobian, bread, coefficient)
}

/// By how much the unknowns, nonlinear then linear, would move with as much of the column as the residual has beyond chance and
/// what replicas have.
fn moved(
    objective: &Objective,
    at: &Evaluation,
    column: &[f64],
    replicas: &[f64],
) -> Option<Vec<f64>> {
    let (jacobian, bread, coefficient) = beside(at, column);
    let own = jacobian.len() - 1;
    // What is left with it is the noise that its deviation comes of.
    let mut rest = at.residual().to_vec();
    for (i, along) in jacobian.iter().enumerate() {
        let by = coefficient * bread[(i, own)] / bread[(own, own)];
        rest.iter_mut().zip(*along).for_each(|(r, x)| *r -= by * x);
    }
    let known = sandwich(&jacobian, &rest, &objective.record().breaks());
    let count = replicas.len() as f64;
    let mean = replicas.iter().sum::<f64>() / count.max(1.0);
    let scatter = replicas.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
    let variance = known.covariance[(own, own)] + scatter / (count - 1.0).max(1.0);
    let beyond = (coefficient - mean).powi(2) - CHANCE * CHANCE * variance;
    let open = (beyond > 0.0 && beyond.is_finite()).then(|| beyond.sqrt())?;
    let followed = followed(at, &bread)?;
    Some(followed.iter().map(|follows| open * follows).collect())
}
