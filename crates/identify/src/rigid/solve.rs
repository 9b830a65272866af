//! Normal equations of weighted least squares with a prior.

use super::Prior;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use std::ops::Range;

/// Eigenvalues of scaled normal equations, as a part of the largest, below which a direction is not determined: there the prior stays.
const LEAST_EIGENVALUE: f64 = 1e-11;

/// Normal equations.
pub(super) struct Normal {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
    /// What the prior has; 0 of what it does not know.
    prior: DVector<f64>,
}

impl Normal {
    /// Of so many unknowns, the first of which a prior knows, with so much of its information.
    pub fn new(unknowns: usize, prior: &Prior, part: f64) -> Self {
        let known = prior.parameters.len();
        let mut matrix = DMatrix::zeros(unknowns, unknowns);
        let mut right = DVector::zeros(unknowns);
        matrix
            .view_mut((0, 0), (known, known))
            .copy_from(&(part * &prior.information));
        right
            .rows_mut(0, known)
            .copy_from(&(part * &prior.information * &prior.parameters));
        let mut mean = DVector::zeros(unknowns);
        mean.rows_mut(0, known).copy_from(&prior.parameters);
        Self {
            matrix,
            right,
            prior: mean,
        }
    }

    /// Adds rows whose columns are these unknowns, each of this variance.
    pub fn add(
        &mut self,
        rows: &DMatrix<f64>,
        places: &[usize],
        values: &DVector<f64>,
        variance: f64,
    ) {
        let square = rows.tr_mul(rows) / variance;
        let right = rows.tr_mul(values) / variance;
        for (i, at) in places.iter().enumerate() {
            self.right[*at] += right[i];
            for (j, beside) in places.iter().enumerate() {
                self.matrix[(*at, *beside)] += square[(i, j)];
            }
        }
    }

    /// The solution, in which none of some unknowns is negative: those that would be are 0.
    pub fn solve(&self, not_negative: Range<usize>) -> DVector<f64> {
        let mut free: Vec<usize> = (0..self.right.len()).collect();
        loop {
            let matrix = self.matrix.select_rows(&free).select_columns(&free);
            let prior = self.prior.select_rows(&free);
            let right = self.right.select_rows(&free) - matrix.tr_mul(&prior);
            let own = prior + inverse(matrix) * right;
            let mut out = DVector::zeros(self.right.len());
            for (place, x) in free.iter().zip(own.iter()) {
                out[*place] = *x;
            }
            let negative: Vec<usize> = not_negative.clone().filter(|i| out[*i] < 0.0).collect();
            if negative.is_empty() {
                return out;
            }
            free.retain(|i| !negative.contains(i));
        }
    }

    /// The covariance of all unknowns.
    pub fn covariance(&self) -> DMatrix<f64> {
        inverse(self.matrix.clone())
    }
}

/// The inverse of a symmetric matrix, 0 in directions that it does not determine.
///
/// Products here and beside are those with a transpose, whose sums do not depend on the instruction set; others go through kernels that
/// are chosen by the processor.
pub fn inverse(matrix: DMatrix<f64>) -> DMatrix<f64> {
    let scale: DVector<f64> = matrix
        .diagonal()
        .map(|x| if x > 0.0 { 1.0 / x.sqrt() } else { 0.0 });
    let scaled = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
        matrix[(i, j)] * scale[i] * scale[j]
    });
    let eigen = SymmetricEigen::new(scaled);
    let least = LEAST_EIGENVALUE * eigen.eigenvalues.max();
    let roots = eigen
        .eigenvalues
        .map(|x| if x > least { 1.0 / x.sqrt() } else { 0.0 });
    let scaled = DMatrix::from_fn(scale.len(), scale.len(), |i, j| {
        eigen.eigenvectors[(j, i)] * roots[i] * scale[j]
    });
    scaled.tr_mul(&scaled)
}

/// A root of a covariance: its product with its transpose is the covariance.
pub(super) fn root(covariance: DMatrix<f64>) -> DMatrix<f64> {
    let eigen = SymmetricEigen::new(covariance);
    let mut root = eigen.eigenvectors;
    for (i, value) in eigen.eigenvalues.iter().enumerate() {
        root.column_mut(i).scale_mut(value.max(0.0).sqrt());
    }
    root
}
