//! Inputs of a step fit that are taken as known but are not exact: the steady curve, the mass, and the
//! force of each step, which is uncertain because of noise. The residual does not show their errors,
//! since other values of sigma0, sigma1 and mass can compensate all of them.

use super::step_fit::Problem;
use crate::separable::linear::dot;
use nalgebra::{DMatrix, DVector};

/// Numbers of the settings: Fc, Fs, vs, sigma2, mass. Two for each response come after them.
const SETTINGS: usize = 5;

/// Effect of their uncertainty on the unknowns: `K G K^T` with `G` their covariance and
/// `K = -(J^T J)^-1 J^T J_given`, `J` being `slopes`.
pub(super) fn carried(problem: &mut Problem, p: &[f64], slopes: &[Vec<f64>]) -> DMatrix<f64> {
    let n = p.len();
    let known = covariance(problem);
    let scale: Vec<f64> = slopes
        .iter()
        .map(|s| 1.0 / dot(s, s).sqrt().max(f64::MIN_POSITIVE))
        .collect();
    let gram = DMatrix::from_fn(n, n, |i, j| {
        dot(&slopes[i], &slopes[j]) * scale[i] * scale[j]
    });
    let Some(factor) = gram.cholesky() else {
        return DMatrix::zeros(n, n);
    };
    let mut answer = DMatrix::zeros(n, known.nrows());
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
    &answer * known * answer.transpose()
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
        if which == 4 {
            after.mass = Some(before.mass? + by);
        } else {
            let mut curve = before.curve?;
            match which {
                0 => curve.coulomb += by,
                1 => curve.static_friction += by,
                2 => curve.stribeck_velocity += by,
                _ => curve.viscous += by,
            }
            after.curve = Some(curve);
        }
        problem.settings = after;
        let residual = problem.residual(p);
        problem.settings = before;
        residual
    };
    residual.iter().all(|r| r.is_finite()).then_some(residual)
}
