//! Autocorrelation of a residual, and its effective sample size.

use crate::{SignalError, check};

/// Autocorrelation at lags 0 to `max_lag`: the biased estimate
/// `sum (x[n] - mean)(x[n + lag] - mean) / sum (x[n] - mean)^2`, which is 1 at lag 0 and never
/// beyond +-1. A signal without variation counts as uncorrelated: 1, 0, 0, ...
///
/// # Errors
/// If the signal has no more than `max_lag` samples or one is not finite.
pub fn autocorrelation(signal: &[f64], max_lag: usize) -> Result<Vec<f64>, SignalError> {
    check::length("autocorrelation", signal, max_lag.saturating_add(1))?;
    check::finite(signal)?;
    let centred = Centred::new(signal);
    Ok((0..=max_lag).map(|lag| centred.correlation(lag)).collect())
}

/// How many independent samples a correlated signal is worth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EffectiveSize {
    /// Effective number of samples, 1 to the number of samples.
    pub size: f64,
    /// Lags that entered the sum.
    pub lags: usize,
    /// Whether the correlation died out within the lags allowed; if not, `size` is too large.
    pub complete: bool,
}

/// Effective sample size N / (1 + 2 sum of the autocorrelation), summed over Geyer's initial
/// positive sequence: pairs of neighbouring lags, as long as the pair's sum is positive and not
/// beyond `max_lag`. (Geyer 1992, Practical Markov chain Monte Carlo, section 3.3.)
///
/// For a first-order autoregressive signal it estimates N (1 - rho) / (1 + rho). Cost: N times the
/// lags needed.
///
/// # Errors
/// If the signal has fewer than 4 samples or one is not finite.
pub fn effective_sample_size(signal: &[f64], max_lag: usize) -> Result<EffectiveSize, SignalError> {
    check::length("the effective sample size", signal, 4)?;
    check::finite(signal)?;
    let centred = Centred::new(signal);
    let last = max_lag.min(signal.len() - 1);
    let mut time = -1.0;
    let mut lag = 0;
    let mut complete = false;
    while lag < last {
        let pair = centred.correlation(lag) + centred.correlation(lag + 1);
        complete = pair <= 0.0;
        if complete {
            break;
        }
        time += 2.0 * pair;
        lag += 2;
    }
    let count = signal.len() as f64;
    // For a mean, an alternating signal is worth more than its number of samples, but not for a variance.
    let size = (count / time.max(1.0)).max(1.0);
    Ok(EffectiveSize {
        size,
        lags: lag,
        complete,
    })
}

/// A signal less its mean, and its sum of squares.
struct Centred {
    values: Vec<f64>,
    square: f64,
}

impl Centred {
    fn new(signal: &[f64]) -> Self {
        // Scaled first, so that squares of very large or small values stay in range.
        let largest = signal
            .iter()
            .fold(0.0, |most: f64, value| most.max(value.abs()));
        let scale = if largest > 0.0 { largest } else { 1.0 };
        let mut values: Vec<f64> = signal.iter().map(|value| value / scale).collect();
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        values.iter_mut().for_each(|value| *value -= mean);
        let square = dot(&values, &values);
        // A spread that comes only from the rounding of the mean counts as no variation.
        let floor = values.len() as f64 * f64::EPSILON * f64::EPSILON;
        Self {
            values,
            square: if square > 16.0 * floor { square } else { 0.0 },
        }
    }

    fn correlation(&self, lag: usize) -> f64 {
        if self.square == 0.0 {
            return if lag == 0 { 1.0 } else { 0.0 };
        }
        dot(&self.values[..self.values.len() - lag], &self.values[lag..]) / self.square
    }
}

/// Sum of products in eight interleaved partial sums: vectorised, yet always in the same order.
fn dot(x: &[f64], y: &[f64]) -> f64 {
    let (x_chunks, x_rest) = x.as_chunks::<8>();
    let (y_chunks, y_rest) = y.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (x, y) in x_chunks.iter().zip(y_chunks) {
        for lane in 0..8 {
            sums[lane] += x[lane] * y[lane];
        }
    }
    let rest: f64 = x_rest.iter().zip(y_rest).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f64>() + rest
}
