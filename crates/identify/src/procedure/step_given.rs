//! What a step fit takes as known and is not exact: the steady curve, the mass, and the force of each
//! step, which noise leaves uncertain. The residual shows none of it, since all of it can be made good
//! by other sigma0, sigma1 and mass.

use super::step_fit::Problem;
use crate::separable::linear::dot;
use nalgebra::{DMatrix, DVector};

/// Numbers of the settings: Fc, Fs, vs, sigma2, mass. Two for each response come after them.
const SETTINGS: usize = 5;

/// What their uncertainty does to the unknowns: `K G K^T` with `G` their covariance and
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
        // A tenth of a deviation either way: within reach of the linear.
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

/// Covariance of what is known: that of the settings, and of each response the two levels of its
/// force, which are measured apart.
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

/// The residual with one of the known numbers moved; `None` where it is not given, or is no law.
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
