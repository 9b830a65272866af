//! Weighted linear least squares that is robust to outliers: first least absolute residuals, then Tukey's loss.

use crate::separable::linear;

/// Tukey's constant for 95 % efficiency on normal residuals.
const TUKEY_BIWEIGHT: f64 = 4.685;
/// Factor from the median absolute residual to the standard deviation of normal residuals.
const MAD_TO_DEVIATION: f64 = 1.482_602_218_505_602;
/// Most rounds of reweighting.
pub(crate) const ROUNDS: usize = 50;
/// Relative change of the cost that ends them: near the rounding of a sum of a thousand residuals.
const SETTLED_CHANGE: f64 = 1e-12;

/// Tukey's biweight loss of residuals in units of their deviations: half their square where they are small, constant beyond
/// 4.685 times the scale.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tukey {
    limit: f64,
}

impl Tukey {
    pub fn new(scale: f64) -> Self {
        Tukey {
            limit: TUKEY_BIWEIGHT * scale,
        }
    }

    fn inside(self, u: f64) -> f64 {
        (1.0 - (u / self.limit) * (u / self.limit)).max(0.0)
    }

    /// The slope of the loss over the residual, 0 to 1.
    pub fn weight(self, u: f64) -> f64 {
        self.inside(u) * self.inside(u)
    }

    pub fn cost(self, u: f64) -> f64 {
        let inside = self.inside(u);
        self.limit * self.limit / 6.0 * (1.0 - inside * inside * inside)
    }
}

/// A linear problem: columns, which coefficients must not be negative, what is to be explained, and
/// the standard deviation that each row is expected to have.
pub(crate) struct Rows<'a> {
    pub columns: &'a [Vec<f64>],
    pub nonnegative: &'a [bool],
    pub target: &'a [f64],
    pub deviation: &'a [f64],
}

/// Coefficients, residual and weights (0 to 1) of the rows.
#[derive(Clone, Debug)]
pub(crate) struct Solved {
    pub coefficients: Vec<f64>,
    pub residual: Vec<f64>,
    pub weights: Vec<f64>,
    pub cost: f64,
}

impl Rows<'_> {
    /// Least sum of absolute residuals in units of the deviations, with a quadratic loss below one of them.
    pub fn absolute(&self, rounds: usize) -> Solved {
        let weight = |u: f64| 1.0 / u.abs().max(1.0);
        let cost = |u: f64| {
            let u = u.abs();
            if u < 1.0 { 0.5 * u * u } else { u - 0.5 }
        };
        self.reweighted(vec![1.0; self.target.len()], rounds, weight, cost)
    }

    /// Least Tukey loss for residuals of `scale` deviations, from given weights.
    pub fn tukey(&self, scale: f64, start: &[f64], rounds: usize) -> Solved {
        let loss = Tukey::new(scale);
        let (weight, cost) = (|u| loss.weight(u), |u| loss.cost(u));
        self.reweighted(start.to_vec(), rounds, weight, cost)
    }

    fn reweighted(
        &self,
        start: Vec<f64>,
        rounds: usize,
        weight: impl Fn(f64) -> f64,
        cost: impl Fn(f64) -> f64,
    ) -> Solved {
        let mut best = self.weighted(start);
        best.cost = self.sum(&best.residual, &cost);
        for _ in 0..rounds {
            let weights = best
                .residual
                .iter()
                .zip(self.deviation)
                .map(|(r, s)| weight(r / s))
                .collect();
            let mut next = self.weighted(weights);
            next.cost = self.sum(&next.residual, &cost);
            let gained = best.cost - next.cost;
            let done = gained.is_nan() || gained <= SETTLED_CHANGE * best.cost;
            if gained >= 0.0 {
                best = next;
            }
            if done {
                break;
            }
        }
        best
    }

    fn sum(&self, residual: &[f64], cost: &impl Fn(f64) -> f64) -> f64 {
        let rows = residual.iter().zip(self.deviation);
        rows.map(|(r, s)| cost(r / s)).sum()
    }

    fn weighted(&self, weights: Vec<f64>) -> Solved {
        let factor: Vec<f64> = weights
            .iter()
            .zip(self.deviation)
            .map(|(w, s)| w.sqrt() / s)
            .collect();
        let scaled =
            |x: &[f64]| -> Vec<f64> { x.iter().zip(&factor).map(|(x, f)| x * f).collect() };
        let columns: Vec<Vec<f64>> = self.columns.iter().map(|c| scaled(c)).collect();
        let views: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let solution = linear::solve(&views, self.nonnegative, &scaled(self.target));
        let mut residual = self.target.to_vec();
        for (column, c) in self.columns.iter().zip(&solution.coefficients) {
            for (r, x) in residual.iter_mut().zip(column) {
                *r -= c * x;
            }
        }
        Solved {
            coefficients: solution.coefficients,
            residual,
            weights,
            cost: 0.0,
        }
    }
}

/// Standard deviation of normal residuals around zero by their median size, with `unknowns` counted.
pub(crate) fn scale(residual: impl Iterator<Item = f64>, unknowns: usize) -> f64 {
    let mut sizes: Vec<f64> = residual.map(f64::abs).collect();
    let n = sizes.len();
    if n == 0 {
        return 0.0;
    }
    let (_, median, _) = sizes.select_nth_unstable_by(n / 2, f64::total_cmp);
    let free = (n as f64 / n.saturating_sub(unknowns).max(1) as f64).sqrt();
    MAD_TO_DEVIATION * *median * free
}

/// Factor from `scale^2 (X^T X)^-1` to the covariance of an estimate with Tukey's loss (Huber 1981,
/// section 7.6); at least 1.
pub(super) fn widening(standardised: &[f64], unknowns: usize) -> f64 {
    let n = standardised.len() as f64;
    let (mut squares, mut slopes) = (0.0, 0.0);
    for u in standardised {
        let x = u / TUKEY_BIWEIGHT;
        let inside = (1.0 - x * x).max(0.0);
        squares += (u * inside * inside).powi(2);
        slopes += inside * (1.0 - 5.0 * x * x);
    }
    let free = (n - unknowns as f64).max(1.0);
    let slope = (slopes / n).max(0.1);
    (squares / free / (slope * slope)).max(1.0)
}
