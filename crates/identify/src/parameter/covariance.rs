//! Covariance and correlation of the errors of parameters.

use nalgebra::DMatrix;
use stiction_parameters::Name;

/// Covariance of named parameters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Covariance {
    /// Names, in the order of rows and columns.
    pub names: Vec<Name>,
    /// Covariance, row by row, in the product of the units of the two parameters.
    pub matrix: Vec<Vec<f64>>,
}

impl Covariance {
    /// The covariance matrix of the named parameters.
    pub(crate) fn new(names: Vec<Name>, matrix: &DMatrix<f64>) -> Self {
        let row = |i: usize| (0..names.len()).map(|j| matrix[(i, j)]).collect();
        Self {
            matrix: (0..names.len()).map(row).collect(),
            names,
        }
    }

    /// The same without parameters of which anything is not a finite number, and with both triangles alike: sums over parts whose
    /// variances lie far apart are rounded in each on its own.
    #[must_use]
    pub fn finite(&self) -> Self {
        let mut kept: Vec<usize> = (0..self.names.len())
            .filter(|&i| self.matrix[i][i].is_finite())
            .collect();
        let all = kept.clone();
        kept.retain(|&i| all.iter().all(|&j| self.matrix[i][j].is_finite()));
        let both = |i: usize, j: usize| 0.5 * self.matrix[i][j] + 0.5 * self.matrix[j][i];
        Self {
            names: kept.iter().map(|&i| self.names[i]).collect(),
            matrix: kept
                .iter()
                .map(|&i| kept.iter().map(|&j| both(i, j)).collect())
                .collect(),
        }
    }

    /// The same with rows and columns in the order of tables.
    pub(crate) fn in_order(&self) -> Self {
        let mut order: Vec<usize> = (0..self.names.len()).collect();
        order.sort_by_key(|i| self.names[*i].quantity.place());
        let row = |i: &usize| order.iter().map(|j| self.matrix[*i][*j]).collect();
        Self {
            names: order.iter().map(|i| self.names[*i]).collect(),
            matrix: order.iter().map(row).collect(),
        }
    }

    /// Gives a parameter this variance, its correlations as they are.
    pub(crate) fn widen(&mut self, name: Name, variance: f64) {
        let Some(i) = self.place(name) else { return };
        let by = (variance / self.matrix[i][i]).sqrt();
        let by = if by.is_finite() { by } else { 1.0 };
        self.matrix[i].iter_mut().for_each(|x| *x *= by);
        self.matrix.iter_mut().for_each(|row| row[i] *= by);
    }

    /// Place of a parameter among its rows and columns.
    pub fn place(&self, name: Name) -> Option<usize> {
        self.names.iter().position(|own| *own == name)
    }

    /// Standard deviation of a quantity with these slopes by the parameters.
    pub fn deviation(&self, slope: impl Fn(Name) -> f64) -> f64 {
        let slopes: Vec<f64> = self.names.iter().map(|&name| slope(name)).collect();
        let mut variance = 0.0;
        for (row, a) in self.matrix.iter().zip(&slopes) {
            for (c, b) in row.iter().zip(&slopes) {
                if *a != 0.0 && *b != 0.0 {
                    variance += a * c * b;
                }
            }
        }
        variance.max(0.0).sqrt()
    }

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
