//! Residual and Jacobian of the six parameters as combinations of columns, so that their products
//! are sums of products of columns.
//!
//! With `J_kappa = Fc eta_kappa + sigma1 rate_kappa`, and so for the ratio Fs/Fc - 1 (`J_excess`) and
//! vs, the derivatives with respect to the logarithms of the genome are
//!
//! ```text
//! sigma0  J_kappa             Fc       Fc eta - J_kappa - J_excess
//! sigma1  sigma1 rate         Fs - Fc  J_excess
//! sigma2  sigma2 v            vs       J_vs
//! ```

use crate::separable::linear::{Factor, Normal};
use nalgebra::{DMatrix, DVector};
use stiction_lanes::{OWN, Sums};
use stiction_search::Derivatives;

const FORCE: usize = OWN;
const SPEED: usize = OWN + 1;
const FURTHER: usize = OWN + 2;

/// All products of columns at one candidate, and the candidate's coefficients.
pub(super) struct Products {
    gram: DMatrix<f64>,
    residual: DVector<f64>,
    /// The further columns that take part.
    further: Factor,
}

impl Products {
    /// Of a candidate `[sigma0, sigma1, sigma2, Fc, ..]`; the further columns are solved for.
    pub fn new(sums: &Sums, shared: &[Vec<f64>], six: &[f64; 6], nonnegative: &[bool]) -> Self {
        let n = OWN + shared.len();
        let gram = DMatrix::from_fn(n, n, |i, j| match (i < OWN, j < OWN) {
            (true, true) => sums.own[i][j],
            (true, false) => sums.shared[j - OWN][i],
            (false, true) => sums.shared[i - OWN][j],
            (false, false) => shared[i - OWN][j - OWN],
        });
        let [_, s1, s2, fc, ..] = *six;
        let mut residual = DVector::zeros(n);
        residual[0] = -fc;
        residual[1] = -s1;
        residual[FORCE] = 1.0;
        residual[SPEED] = -s2;
        let normal = Normal {
            gram: gram.view_range(FURTHER.., FURTHER..).into_owned(),
            rhs: (FURTHER..n)
                .map(|j| gram.row(j).tr_dot(&residual))
                .collect(),
            energy: residual.dot(&(&gram * &residual)),
        };
        let (further, ..) = normal.solve(nonnegative);
        let mut out = Self {
            gram,
            residual,
            further,
        };
        out.residual = out.outside(&out.residual);
        out
    }

    /// The part of a combination that the further columns cannot express.
    fn outside(&self, x: &DVector<f64>) -> DVector<f64> {
        let mut out = x.clone();
        let taken = self.further.columns();
        let product = |&j: &usize| self.gram.row(FURTHER + j).tr_dot(x);
        let inside = self
            .further
            .solve(&taken.iter().map(product).collect::<Vec<_>>());
        for (&j, c) in taken.iter().zip(inside) {
            out[FURTHER + j] -= c;
        }
        out
    }

    /// Sum of squares of the residual.
    fn cost(&self) -> f64 {
        let cost = self.residual.dot(&(&self.gram * &self.residual));
        // Rounding may take it below zero, never far.
        if cost < 0.0 { 0.0 } else { cost }
    }

    /// Cost, gradient and normal matrix, all over the energy.
    pub fn derivatives(&self, six: &[f64; 6], energy: f64, out: &mut Derivatives) {
        let [_, s1, s2, fc, ..] = *six;
        let n = self.residual.len();
        let slope = |k: usize| {
            let mut x = DVector::zeros(n);
            x[2 + k] = fc;
            x[5 + k] = s1;
            x
        };
        let unit = |i: usize, c: f64| {
            let mut x = DVector::zeros(n);
            x[i] = c;
            x
        };
        let (kappa, excess, velocity) = (slope(0), slope(1), slope(2));
        let level = unit(0, fc) - &kappa - &excess;
        let columns = [kappa, unit(1, s1), unit(SPEED, s2), level, excess, velocity]
            .map(|x| self.outside(&x));
        let products = columns.clone().map(|x| &self.gram * x);
        out.cost = self.cost() / energy;
        for i in 0..6 {
            out.gradient[i] = -products[i].dot(&self.residual) / energy;
            for j in 0..6 {
                out.normal[6 * i + j] = products[i.max(j)].dot(&columns[i.min(j)]) / energy;
            }
        }
    }
}
