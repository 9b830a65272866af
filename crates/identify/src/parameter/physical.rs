//! A parameter of a law as a function of the unknowns of a search.

use nalgebra::DMatrix;
use stiction_parameters::{Allowed, Name};

/// A parameter of the law as a function of the unknowns `(p, c)`.
#[derive(Clone, Debug)]
pub(crate) struct Physical {
    pub name: Name,
    pub value: f64,
    /// Derivatives with respect to `p` then `c`.
    pub slope: Vec<f64>,
    /// Nonlinear unknown that sets this parameter, if any: at its bound the parameter is not known.
    pub nonlinear: Option<usize>,
    /// Linear unknown that sets this parameter, if any.
    pub linear: Option<usize>,
}

impl Physical {
    /// Whether it is positive by nature: then errors are relative, and intervals log-normal.
    pub fn is_positive(&self) -> bool {
        self.name.quantity.allowed().is_never_negative()
    }

    /// Whether it is a share, between 0 and 1.
    pub fn is_share(&self) -> bool {
        self.name.quantity.allowed() == Allowed::Share
    }

    /// Variance for a covariance of the unknowns.
    pub fn variance(&self, unknowns: &DMatrix<f64>) -> f64 {
        (0..self.slope.len())
            .map(|i| self.slope[i] * self.with(unknowns, i))
            .sum()
    }

    /// Covariance with one of the unknowns.
    pub fn with(&self, unknowns: &DMatrix<f64>, unknown: usize) -> f64 {
        self.slope
            .iter()
            .enumerate()
            .map(|(j, slope)| slope * unknowns[(unknown, j)])
            .sum()
    }
}

/// Covariance of the physical parameters from that of the unknowns.
pub(crate) fn propagate(parameters: &[Physical], unknowns: &DMatrix<f64>) -> DMatrix<f64> {
    let width = unknowns.nrows();
    let t = DMatrix::from_fn(parameters.len(), width, |i, j| parameters[i].slope[j]);
    &t * unknowns * t.transpose()
}
