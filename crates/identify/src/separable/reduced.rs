//! The reduced problem at a trial: cost, gradient and curvature in the nonlinear unknowns alone.

use crate::separable::linear::{Factor, Normal};
use nalgebra::DMatrix;
use stiction_search::Derivatives;

/// Products of the columns of a trial, without the columns themselves: the reduced problem follows from them.
pub(crate) trait Products {
    /// Linear columns with each other.
    fn linear(&self, i: usize, j: usize) -> f64;
    /// A linear column with the target.
    fn target(&self, i: usize) -> f64;
    /// Sum of squares of the target.
    fn energy(&self) -> f64;
    /// The derivative of the model with respect to a nonlinear unknown, for given coefficients, with a
    /// linear column.
    fn slope_linear(&self, k: usize, i: usize, coefficients: &[f64]) -> f64;
    /// The same with the target.
    fn slope_target(&self, k: usize, coefficients: &[f64]) -> f64;
    /// The same with another derivative.
    fn slopes(&self, k: usize, l: usize, coefficients: &[f64]) -> f64;
}

/// The reduced problem from the products of `bounded.len()` linear columns and `unknowns` derivatives. `J^T J` is that of
/// Kaufman.
///
/// The cost has an absolute error of about 1e-15 of the energy of the target.
pub(crate) fn from_products(
    products: &impl Products,
    bounded: &[bool],
    unknowns: usize,
) -> Derivatives {
    let m = bounded.len();
    let (factor, c, cost) = linear(products, bounded);
    let mut out = Derivatives::zeros(unknowns);
    out.cost = cost;
    let rows: Vec<Vec<f64>> = (0..unknowns)
        .map(|k| (0..m).map(|i| products.slope_linear(k, i, &c)).collect())
        .collect();
    for (k, row) in rows.iter().enumerate() {
        let model: f64 = row.iter().zip(&c).map(|(x, c)| x * c).sum();
        out.gradient[k] = -(products.slope_target(k, &c) - model);
        let own: Vec<f64> = factor.columns().iter().map(|&j| row[j]).collect();
        let inside = factor.solve(&own);
        for (l, other) in rows[..=k].iter().enumerate() {
            let explained: f64 = factor
                .columns()
                .iter()
                .zip(&inside)
                .map(|(&j, x)| other[j] * x)
                .sum();
            let outside = products.slopes(k, l, &c) - explained;
            out.normal[k * unknowns + l] = outside;
            out.normal[l * unknowns + k] = outside;
        }
    }
    out
}

/// The cost alone.
pub(super) fn cost(products: &impl Products, bounded: &[bool]) -> f64 {
    linear(products, bounded).2
}

/// The linear problem: its factor, the coefficients, and the cost.
fn linear(products: &impl Products, bounded: &[bool]) -> (Factor, Vec<f64>, f64) {
    let m = bounded.len();
    let whole = Normal {
        gram: DMatrix::from_fn(m, m, |i, j| products.linear(i, j)),
        rhs: (0..m).map(|i| products.target(i)).collect(),
        energy: products.energy(),
    };
    let (factor, found, _) = whole.solve(bounded);
    let mut c = vec![0.0; m];
    for (&j, &x) in factor.columns().iter().zip(&found) {
        c[j] = x;
    }
    let mut cost = whole.energy;
    for i in 0..m {
        let model: f64 = (0..m).map(|j| whole.gram[(i, j)] * c[j]).sum();
        cost += c[i] * (model - 2.0 * whole.rhs[i]);
    }
    (factor, c, cost.max(0.0))
}
