//! How well a model explains a force.

use crate::conditioning::record::Record;
use stiction_signal::effective_sample_size;

/// Largest lag of an autocorrelation: with more, a long record costs more than its search, and an error
/// that stays correlated that long is model error of the law.
pub(crate) const MOST_LAGS: usize = 2000;

/// Size of the residual on one set of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Root mean square of the residual, in the unit of the force.
    pub rmse: f64,
    /// `100 rms(residual) / rms(measured)`.
    pub relative_error_percent: f64,
    /// `1 - sum(residual^2) / sum((measured - mean)^2)`.
    pub r2: f64,
    /// Samples that count.
    pub samples: usize,
    /// Number of independent samples that carry the same information as the residual, from its autocorrelation.
    pub effective_samples: f64,
}

impl Fit {
    /// Compares a residual with the measured force; `None` without samples, or where the force is zero
    /// throughout or the values are too large to square.
    pub fn new(measured: &[f64], residual: &[f64]) -> Option<Self> {
        Self::up_to_lag(measured, residual, MOST_LAGS)
    }

    /// The same with an autocorrelation of at most `lags`.
    pub(crate) fn up_to_lag(measured: &[f64], residual: &[f64], lags: usize) -> Option<Self> {
        let n = measured.len().min(residual.len());
        if n == 0 {
            return None;
        }
        let squares = |x: &[f64]| crate::separable::linear::dot(x, x);
        let mean = measured.iter().sum::<f64>() / n as f64;
        let spread: f64 = measured.iter().map(|u| (u - mean) * (u - mean)).sum();
        let (energy, error) = (squares(measured), squares(residual));
        if !(energy > 0.0 && energy.is_finite() && error.is_finite()) {
            return None;
        }
        Some(Self {
            rmse: (error / n as f64).sqrt(),
            relative_error_percent: 100.0 * (error / energy).sqrt(),
            r2: if spread > 0.0 {
                1.0 - error / spread
            } else {
                f64::NAN
            },
            samples: n,
            effective_samples: effective_sample_size(residual, lags).map_or(n as f64, |e| e.size),
        })
    }

    /// The same for the samples slower than `bound`, m/s or rad/s.
    pub fn slow(measured: &[f64], residual: &[f64], speed: &[f64], bound: f64) -> Option<Self> {
        let pick = |x: &[f64]| -> Vec<f64> {
            x.iter()
                .zip(speed)
                .filter(|(_, v)| v.abs() < bound)
                .map(|(x, _)| *x)
                .collect()
        };
        Self::new(&pick(measured), &pick(residual))
    }
}

/// Default speed below which a sample counts as slow: 2 % of the top speed.
pub fn low_speed_bound(record: &Record) -> f64 {
    0.02 * record.top_speed()
}
