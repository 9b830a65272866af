//! How sure the unknowns are, with the correlation of the residuals counted.
//!
//! The covariance is the sandwich `B S B`: `B` inverts `J^T J`, `S` is the long-run covariance of the
//! scores `J_t r_t`. The scores are whitened by a first-order autoregression each (Andrews and
//! Monahan 1992, doi 10.2307/2951574), the remainder is summed with Bartlett weights over a lag
//! chosen from the data (Andrews 1991, doi 10.2307/2938229) in the form of overlapping batch sums,
//! which costs one pass whatever the lag, and the whitening is undone. The result is never below the
//! covariance for white residuals.

use crate::separable::objective::{Evaluation, Objective};
use nalgebra::{DMatrix, SymmetricEigen};

/// Covariance of named parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariance {
    /// Names, in the order of rows and columns.
    pub names: Vec<String>,
    /// Covariance, row by row, in the product of the units of the two parameters.
    pub matrix: Vec<Vec<f64>>,
}

impl Covariance {
    /// Correlation matrix, in -1..1; zero where a variance is zero or not finite.
    pub fn correlation(&self) -> Vec<Vec<f64>> {
        let n = self.names.len();
        let sd: Vec<f64> = (0..n).map(|i| self.matrix[i][i].sqrt()).collect();
        (0..n)
            .map(|i| {
                (0..n)
                    .map(|j| {
                        let x = self.matrix[i][j] / (sd[i] * sd[j]);
                        if x.is_finite() {
                            x.clamp(-1.0, 1.0)
                        } else {
                            0.0
                        }
                    })
                    .collect()
            })
            .collect()
    }
}

/// Relative size of an eigenvalue of the scaled `J^T J` that is rounding only.
const ROUNDING: f64 = 1e-15;

/// Covariance of `(p, c)`; coefficients held at zero or left out have zero rows.
///
/// A nonlinear unknown at the bound of its search range counts as free here: the bound is ours, not
/// nature's, and holding it would make the others look surer than the data allow.
pub(crate) fn unknowns(objective: &Objective, at: &Evaluation) -> DMatrix<f64> {
    let k = at.slopes.len();
    let width = k + at.columns.len();
    let mut index: Vec<usize> = (0..k).collect();
    let mut jacobian: Vec<&[f64]> = at.slopes.iter().map(Vec::as_slice).collect();
    for (j, column) in at.columns.iter().enumerate() {
        if at.solution.active[j] {
            index.push(k + j);
            jacobian.push(column);
        }
    }
    let small = sandwich(&jacobian, at.residual(), &objective.record().breaks());
    let mut out = DMatrix::zeros(width, width);
    for (a, &i) in index.iter().enumerate() {
        for (b, &j) in index.iter().enumerate() {
            out[(i, j)] = small[(a, b)];
        }
    }
    out
}

/// A covariance scaled up, row by row, to variances of at least those of another.
pub(crate) fn widened(covariance: &DMatrix<f64>, least: &DMatrix<f64>) -> DMatrix<f64> {
    let n = covariance.nrows();
    let factor: Vec<f64> = (0..n)
        .map(|i| {
            let ratio = least[(i, i)] / covariance[(i, i)];
            // No variance at all is a coefficient that is held.
            if ratio > 1.0 && ratio.is_finite() {
                ratio.sqrt()
            } else {
                1.0
            }
        })
        .collect();
    DMatrix::from_fn(n, n, |i, j| covariance[(i, j)] * factor[i] * factor[j])
}

/// `B S B` for Jacobian columns and residual; `breaks` are the indices at which a new segment starts.
pub(crate) fn sandwich(jacobian: &[&[f64]], residual: &[f64], breaks: &[usize]) -> DMatrix<f64> {
    let q = jacobian.len();
    let n = residual.len();
    if q == 0 || n <= q {
        return DMatrix::from_element(q, q, f64::INFINITY);
    }
    let scale: Vec<f64> = jacobian
        .iter()
        .map(|c| {
            let norm = crate::separable::linear::dot(c, c).sqrt();
            if norm > 0.0 { 1.0 / norm } else { 1.0 }
        })
        .collect();
    let gram = DMatrix::from_fn(q, q, |i, j| {
        crate::separable::linear::dot(jacobian[i], jacobian[j]) * scale[i] * scale[j]
    });
    let bread = inverse(gram);
    let scores = influence(jacobian, residual, &scale, &bread);
    let variance = crate::separable::linear::dot(residual, residual) / (n - q) as f64;
    let correction = n as f64 / (n - q) as f64;
    let mut out = of_influence(&scores, breaks, correction, &(&bread * variance));
    for i in 0..q {
        for j in 0..q {
            out[(i, j)] *= scale[i] * scale[j];
        }
    }
    out
}

/// Long-run covariance of the influence `B J_t r_t` of each sample, one series for each unknown, times
/// `correction`; never below `white`, what white residuals would give.
pub(crate) fn of_influence(
    influence: &[Vec<f64>],
    breaks: &[usize],
    correction: f64,
    white: &DMatrix<f64>,
) -> DMatrix<f64> {
    let q = influence.len();
    let long_run = long_run_covariance(influence, breaks);
    // Never below what white residuals would give.
    let widen: Vec<f64> = (0..q)
        .map(|i| {
            let white = white[(i, i)];
            let hac = correction * long_run[(i, i)];
            if hac > 0.0 {
                (white / hac).max(1.0).sqrt()
            } else {
                0.0
            }
        })
        .collect();
    DMatrix::from_fn(q, q, |i, j| {
        if widen[i] == 0.0 || widen[j] == 0.0 {
            white[(i, j)]
        } else {
            correction * long_run[(i, j)] * widen[i] * widen[j]
        }
    })
}

/// Inverse of a scaled symmetric matrix in which directions that rounding has lost stay huge: they
/// must come out as unknown, not as zero.
pub(crate) fn inverse(matrix: DMatrix<f64>) -> DMatrix<f64> {
    let q = matrix.nrows();
    let eigen = SymmetricEigen::new(matrix);
    let most = eigen.eigenvalues.iter().fold(0.0_f64, |m, x| m.max(*x));
    let inverse: Vec<f64> = eigen
        .eigenvalues
        .iter()
        .map(|x| 1.0 / x.max(ROUNDING * most))
        .collect();
    DMatrix::from_fn(q, q, |i, j| {
        (0..q)
            .map(|l| eigen.eigenvectors[(i, l)] * inverse[l] * eigen.eigenvectors[(j, l)])
            .sum()
    })
}

/// `B J_t r_t`, one column of length n per unknown.
fn influence(
    jacobian: &[&[f64]],
    residual: &[f64],
    scale: &[f64],
    bread: &DMatrix<f64>,
) -> Vec<Vec<f64>> {
    let q = jacobian.len();
    (0..q)
        .map(|i| {
            let weights: Vec<f64> = (0..q).map(|j| bread[(i, j)] * scale[j]).collect();
            (0..residual.len())
                .map(|t| {
                    let x: f64 = (0..q).map(|j| weights[j] * jacobian[j][t]).sum();
                    x * residual[t]
                })
                .collect()
        })
        .collect()
}

/// Sum over all pairs of samples of the covariance of the scores.
fn long_run_covariance(scores: &[Vec<f64>], breaks: &[usize]) -> DMatrix<f64> {
    let q = scores.len();
    let n = scores.first().map_or(0, Vec::len);
    let whitened: Vec<(f64, Vec<f64>)> = scores.iter().map(|w| whiten(w, breaks)).collect();
    let lag = bandwidth(&whitened, breaks).min(n / 4).max(1);
    let sums: Vec<Vec<f64>> = whitened.iter().map(|(_, e)| batch_sums(e, lag)).collect();
    DMatrix::from_fn(q, q, |i, j| {
        let sum = crate::separable::linear::dot(&sums[i], &sums[j]) / lag as f64;
        sum / ((1.0 - whitened[i].0) * (1.0 - whitened[j].0))
    })
}

/// First-order autoregression: its coefficient and what it leaves.
fn whiten(w: &[f64], breaks: &[usize]) -> (f64, Vec<f64>) {
    // Beyond .97 undoing the whitening would amplify noise more than it removes bias.
    let a = lag_one(w, breaks).clamp(-0.97, 0.97);
    let mut e = w.to_vec();
    for t in (1..w.len()).rev() {
        if breaks.binary_search(&t).is_err() {
            e[t] -= a * w[t - 1];
        }
    }
    (a, e)
}

fn lag_one(w: &[f64], breaks: &[usize]) -> f64 {
    let energy = crate::separable::linear::dot(w, w);
    if energy <= 0.0 {
        return 0.0;
    }
    let product: f64 = (1..w.len())
        .filter(|t| breaks.binary_search(t).is_err())
        .map(|t| w[t] * w[t - 1])
        .sum();
    product / energy
}

/// Andrews' lag for the Bartlett kernel, from first-order autoregressions of the whitened scores.
fn bandwidth(whitened: &[(f64, Vec<f64>)], breaks: &[usize]) -> usize {
    let n = whitened.first().map_or(0, |(_, e)| e.len()) as f64;
    let (mut above, mut below) = (0.0, 0.0);
    for (_, e) in whitened {
        let energy = crate::separable::linear::dot(e, e);
        if energy <= 0.0 {
            continue;
        }
        let b = lag_one(e, breaks).clamp(-0.97, 0.97);
        // Each unknown has its own unit, so each counts alike.
        above += 4.0 * b * b / ((1.0 - b).powi(6) * (1.0 + b).powi(2));
        below += 1.0 / (1.0 - b).powi(4);
    }
    if below <= 0.0 {
        return 1;
    }
    (1.1447 * (above / below * n).cbrt()).ceil() as usize
}

/// Sums of all windows of `lag` samples, also those that hang over an end.
fn batch_sums(e: &[f64], lag: usize) -> Vec<f64> {
    let mut out = Vec::with_capacity(e.len() + lag);
    let mut sum = 0.0;
    for t in 0..e.len() + lag - 1 {
        if t < e.len() {
            sum += e[t];
        }
        if t >= lag {
            sum -= e[t - lag];
        }
        out.push(sum);
    }
    out
}
