//! The normal distribution that CMA-ES draws from and learns.

use super::weights::Weights;
use crate::bits;
use crate::linear::symmetric_eigen;
use crate::points::Points;
use crate::random::Dice;
use serde::{Deserialize, Serialize};

/// Ratio of the shortest to the longest axis of the distribution below which the covariance is numerically singular:
/// a condition of 1e14 (Hansen 2016, section B.3).
const LEAST_AXIS_RATIO: f64 = 1e-7;
/// Deviation of a step, in widths of the box, below which it changes nothing any more (Hansen 2016: 1e-12 of the
/// first).
const LEAST_STEP: f64 = 1e-12;

/// Mean, step length, covariance `B D^2 B^T` and the two paths, named as in the tutorial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Distribution {
    weights: Weights,
    #[serde(with = "bits")]
    mean: Vec<f64>,
    #[serde(with = "bits")]
    sigma: f64,
    #[serde(with = "bits")]
    covariance: Vec<f64>,
    #[serde(with = "bits")]
    b: Vec<f64>,
    #[serde(with = "bits")]
    d: Vec<f64>,
    #[serde(with = "bits")]
    p_sigma: Vec<f64>,
    #[serde(with = "bits")]
    p_c: Vec<f64>,
    generation: usize,
    decomposed: usize,
}

impl Distribution {
    pub fn new(mean: Vec<f64>, sigma: f64, size: usize) -> Self {
        let n = mean.len();
        let mut identity = vec![0.0; n * n];
        for i in 0..n {
            identity[i * n + i] = 1.0;
        }
        Self {
            weights: Weights::new(n as f64, size),
            sigma,
            b: identity.clone(),
            covariance: identity,
            d: vec![1.0; n],
            p_sigma: vec![0.0; n],
            p_c: vec![0.0; n],
            generation: 0,
            decomposed: 0,
            mean,
        }
    }

    /// Eqs. (38) to (40).
    pub fn draw(&self, many: usize, dice: &mut Dice) -> Points {
        let n = self.mean.len();
        let mut points = Points::new(n);
        for _ in 0..many {
            let z: Vec<f64> = self.d.iter().map(|d| d * dice.normal()).collect();
            let x: Vec<f64> = (0..n)
                .map(|i| self.mean[i] + self.sigma * dot(&self.b[i * n..(i + 1) * n], &z))
                .collect();
            points.push(&x);
        }
        points
    }

    /// Eqs. (41) to (47), from the points of a generation in the order of their costs.
    pub fn update(&mut self, points: &Points, order: &[usize]) {
        let n = self.mean.len();
        let w = &self.weights;
        let y: Vec<Vec<f64>> = order
            .iter()
            .map(|&i| {
                let from_mean = points.row(i).iter().zip(&self.mean);
                from_mean.map(|(x, m)| (x - m) / self.sigma).collect()
            })
            .collect();
        let mut y_w = vec![0.0; n];
        for (y, w) in y.iter().zip(&w.w).take(w.mu) {
            for (sum, y) in y_w.iter_mut().zip(y) {
                *sum += w * y;
            }
        }
        for (m, y) in self.mean.iter_mut().zip(&y_w) {
            *m += self.sigma * y;
        }
        let whitened = self.whitened(&y_w);
        let kept = (w.c_sigma * (2.0 - w.c_sigma) * w.mu_eff).sqrt();
        for (p, x) in self.p_sigma.iter_mut().zip(&whitened) {
            *p = (1.0 - w.c_sigma) * *p + kept * x;
        }
        self.generation += 1;
        let nf = n as f64;
        // The expected length of a standard normal vector.
        let chi = nf.sqrt() * (1.0 - 1.0 / (4.0 * nf) + 1.0 / (21.0 * nf * nf));
        let length = dot(&self.p_sigma, &self.p_sigma).sqrt();
        let ramp = 1.0 - libm::pow(1.0 - w.c_sigma, 2.0 * self.generation as f64);
        let steady = length / ramp.sqrt() < (1.4 + 2.0 / (nf + 1.0)) * chi;
        let h = if steady { 1.0 } else { 0.0 };
        let kept = h * (w.c_c * (2.0 - w.c_c) * w.mu_eff).sqrt();
        for (p, y) in self.p_c.iter_mut().zip(&y_w) {
            *p = (1.0 - w.c_c) * *p + kept * y;
        }
        self.learn(&y, (1.0 - h) * self.weights.c_c * (2.0 - self.weights.c_c));
        let w = &self.weights;
        self.sigma *= libm::exp((w.c_sigma / w.d_sigma * (length / chi - 1.0)).min(1.0));
        let lag = 1.0 / ((w.c_1 + w.c_mu) * nf * 10.0);
        if (self.generation - self.decomposed) as f64 >= lag {
            self.decompose();
        }
    }

    /// The covariance, eq. (47).
    fn learn(&mut self, y: &[Vec<f64>], delta: f64) {
        let n = self.mean.len();
        let w = &self.weights;
        // Negative weights by the length of their step, so that the matrix stays definite; eq. (46).
        let scaled: Vec<f64> = (y.iter().zip(&w.w))
            .map(|(y, &weight)| {
                if weight >= 0.0 {
                    return weight;
                }
                let x = self.whitened(y);
                weight * n as f64 / dot(&x, &x).max(f64::MIN_POSITIVE)
            })
            .collect();
        let total: f64 = w.w.iter().sum();
        let keep = 1.0 + w.c_1 * delta - w.c_1 - w.c_mu * total;
        for i in 0..n {
            for j in 0..=i {
                let mut c = keep * self.covariance[i * n + j];
                c += w.c_1 * self.p_c[i] * self.p_c[j];
                for (y, scaled) in y.iter().zip(&scaled) {
                    c += w.c_mu * scaled * y[i] * y[j];
                }
                self.covariance[i * n + j] = c;
                self.covariance[j * n + i] = c;
            }
        }
    }

    /// `C^(-1/2) y`.
    fn whitened(&self, y: &[f64]) -> Vec<f64> {
        let n = y.len();
        let in_axes: Vec<f64> = (0..n)
            .map(|k| (0..n).map(|i| self.b[i * n + k] * y[i]).sum::<f64>() / self.d[k])
            .collect();
        (0..n)
            .map(|i| dot(&self.b[i * n..(i + 1) * n], &in_axes))
            .collect()
    }

    fn decompose(&mut self) {
        let n = self.mean.len();
        let (values, b) = symmetric_eigen(self.covariance.clone(), n);
        self.decomposed = self.generation;
        self.d = values.iter().map(|v| v.max(0.0).sqrt()).collect();
        self.b = b;
    }

    /// Whether steps have become too short to change anything, or the covariance is numerically singular.
    pub fn is_degenerate(&self) -> bool {
        let n = self.mean.len();
        let (low, high) =
            (self.d.iter()).fold((f64::INFINITY, 0.0f64), |(l, h), &d| (l.min(d), h.max(d)));
        let widest = (0..n)
            .map(|i| self.covariance[i * n + i].sqrt().max(self.p_c[i].abs()))
            .fold(0.0, f64::max);
        // Written as a negation so that NaN counts as degenerate too.
        !(low > LEAST_AXIS_RATIO * high && self.sigma * widest > LEAST_STEP)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
