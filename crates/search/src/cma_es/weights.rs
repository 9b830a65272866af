//! Weights and learning rates of CMA-ES, from dimension and population alone.

use crate::bits;
use serde::{Deserialize, Serialize};

/// Strategy parameters, named as in the tutorial: table 1, eqs. (49) to (58).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Weights {
    /// Recombination weights, best first; those behind the better half are negative.
    #[serde(with = "bits")]
    pub w: Vec<f64>,
    /// How many are positive.
    pub mu: usize,
    #[serde(with = "bits")]
    pub mu_eff: f64,
    #[serde(with = "bits")]
    pub c_sigma: f64,
    #[serde(with = "bits")]
    pub d_sigma: f64,
    #[serde(with = "bits")]
    pub c_c: f64,
    #[serde(with = "bits")]
    pub c_1: f64,
    #[serde(with = "bits")]
    pub c_mu: f64,
}

impl Weights {
    pub fn new(n: f64, size: usize) -> Self {
        let raw: Vec<f64> = (1..=size)
            .map(|i| libm::log((size as f64 + 1.0) / 2.0) - libm::log(i as f64))
            .collect();
        let mu = size / 2;
        let sums = |w: &[f64]| {
            let (sum, squares) = w.iter().fold((0.0, 0.0), |(s, q), x| (s + x, q + x * x));
            (sum, sum * sum / squares)
        };
        let (positive, mu_eff) = sums(&raw[..mu]);
        let (_, mu_eff_minus) = sums(&raw[mu..]);
        let negative: f64 = -raw.iter().filter(|w| **w < 0.0).sum::<f64>();
        let c_sigma = (mu_eff + 2.0) / (n + mu_eff + 5.0);
        let above = (((mu_eff - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0);
        let c_c = (4.0 + mu_eff / n) / (n + 4.0 + 2.0 * mu_eff / n);
        let c_1 = 2.0 / ((n + 1.3) * (n + 1.3) + mu_eff);
        let rank_mu = 2.0 * (0.25 + mu_eff + 1.0 / mu_eff - 2.0) / ((n + 2.0) * (n + 2.0) + mu_eff);
        let c_mu = rank_mu.min(1.0 - c_1);
        let alpha = (1.0 + c_1 / c_mu)
            .min(1.0 + 2.0 * mu_eff_minus / (mu_eff + 2.0))
            .min((1.0 - c_1 - c_mu) / (n * c_mu));
        let scaled = |&w: &f64| {
            if w >= 0.0 {
                w / positive
            } else {
                w * alpha / negative
            }
        };
        Self {
            w: raw.iter().map(scaled).collect(),
            mu,
            mu_eff,
            c_sigma,
            d_sigma: 1.0 + 2.0 * above + c_sigma,
            c_c,
            c_1,
            c_mu,
        }
    }
}
