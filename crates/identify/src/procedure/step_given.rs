//! Inputs of a step fit that are taken as known but are not exact: the steady curve, the mass, the offset, and the
//! force of each step, which is uncertain because of noise. The residual does not show their errors,
//! since other values of sigma0, sigma1 and mass can compensate all of them.

use super::step_fit::Problem;
use crate::separable::linear::dot;
use nalgebra::{DMatrix, DVector};
use stiction_parameters::Quantity;

/// Numbers of the settings, in the order of their covariance.
pub(super) const GIVEN: [Quantity; 7] = [
    Quantity::Coulomb,
    Quantity::Static,
    Quantity::StribeckVelocity,
    Quantity::Sigma2,
    Quantity::Mass,
    Quantity::StribeckExponent,
    Quantity::Offset,
];
/// Two for each response come after them.
const SETTINGS: usize = GIVEN.len();

/// What the uncertainty of the known inputs adds to the covariance of the unknowns and the settings: with `G` that of the
/// inputs and `K = -(J^T J)^-1 J^T J_given`, `J` being `slopes`, the unknowns get `K G K^T` and vary with the inputs by
/// `K G`, since the noise of the record has nothing to do with them.
pub(super) fn carried(problem: &mut Problem, p: &[f64], slopes: &[Vec<f64>]) -> DMatrix<f64> {
    let (answer, known) = answer(problem, p, slopes);
    let (n, all) = (p.len(), p.len() + SETTINGS);
    // The unknowns, and the settings themselves.
    let of = DMatrix::from_fn(all, known.nrows(), |i, j| match i.checked_sub(n) {
        None => answer[(i, j)],
        Some(own) if own == j => 1.0,
        Some(_) => 0.0,
    });
    &of * known * of.transpose()
}

/// Factors that make the slopes of length 1, and `J^T J` of the slopes so scaled.
pub(super) fn scaled(slopes: &[Vec<f64>]) -> (Vec<f64>, DMatrix<f64>) {
    let scale: Vec<f64> = slopes
        .iter()
        .map(|s| 1.0 / dot(s, s).sqrt().max(f64::MIN_POSITIVE))
        .collect();
    let gram = DMatrix::from_fn(slopes.len(), slopes.len(), |i, j| {
        dot(&slopes[i], &slopes[j]) * scale[i] * scale[j]
    });
    (scale, gram)
}

/// `K` and `G`.
fn answer(problem: &mut Problem, p: &[f64], slopes: &[Vec<f64>]) -> (DMatrix<f64>, DMatrix<f64>) {
    let n = p.len();
    let known = covariance(problem);
    let (scale, gram) = scaled(slopes);
    let mut answer = DMatrix::zeros(n, known.nrows());
    let Some(factor) = gram.cholesky() else {
        return (answer, known);
    };
    for j in 0..known.nrows() {
        let std = known[(j, j)].sqrt();
        if !(std > 0.0 && std.is_finite()) {
            continue;
        }
        // A tenth of a standard deviation either way: small enough for a linear approximation.
        let by = 0.1 * std;
        let (Some(up), Some(down)) = (moved(problem, p, j, by), moved(problem, p, j, -by)) else {
            continue;
        };
        let slope: Vec<f64> = up
            .iter()
            .zip(&down)
            .map(|(a, b)| (a - b) / (2.0 * by))
            .collect();
        let rhs = DVector::from_fn(n, |i, _| dot(&slopes[i], &slope) * scale[i]);
        let x = factor.solve(&rhs);
        for i in 0..n {
            answer[(i, j)] = -x[i] * scale[i];
        }
    }
    (answer, known)
}

/// Covariance of the known inputs: that of the settings, and for each response those of the two force
/// levels, which are measured independently.
fn covariance(problem: &Problem) -> DMatrix<f64> {
    let n = SETTINGS + 2 * problem.responses.len();
    let mut known = DMatrix::zeros(n, n);
    for (i, row) in problem.settings.given.iter().enumerate() {
        for (j, value) in row.iter().enumerate() {
            known[(i, j)] = *value;
        }
    }
    for (k, response) in problem.responses.iter().enumerate() {
        for (side, error) in response.errors.iter().enumerate() {
            let at = SETTINGS + 2 * k + side;
            known[(at, at)] = error * error;
        }
    }
    known
}

/// The residual with one of the known inputs changed; `None` where it is not given, or the values are
/// invalid for a law.
fn moved(problem: &mut Problem, p: &[f64], which: usize, by: f64) -> Option<Vec<f64>> {
    let residual = if which >= SETTINGS {
        let (k, side) = ((which - SETTINGS) / 2, (which - SETTINGS) % 2);
        let before = problem.responses[k].clone();
        problem.responses[k].lift(side, by);
        let residual = problem.residual(p);
        problem.responses[k] = before;
        residual
    } else {
        let before = problem.settings;
        let mut after = before;
        match GIVEN[which] {
            Quantity::Mass => after.mass = Some(before.mass? + by),
            Quantity::StribeckExponent => after.exponent += by,
            Quantity::Offset => after.offset += by,
            quantity => {
                let mut curve = before.curve?;
                match quantity {
                    Quantity::Coulomb => curve.coulomb += by,
                    Quantity::Static => curve.static_friction += by,
                    Quantity::StribeckVelocity => curve.stribeck_velocity += by,
                    _ => curve.viscous += by,
                }
                after.curve = Some(curve);
            }
        }
        problem.settings = after;
        let residual = problem.residual(p);
        problem.settings = before;
        residual
    };
    residual.iter().all(|r| r.is_finite()).then_some(residual)
}
