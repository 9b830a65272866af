//! Savitzky-Golay smoothing and differentiation.

use crate::orthogonal::Gram;
use crate::{SignalError, check};

/// Highest degree of the polynomials: up to it their recurrence is accurate to 1e-12.
const MAX_DEGREE: usize = 12;

/// A sliding least-squares polynomial (Savitzky and Golay 1964): each sample becomes the value or
/// a derivative of the polynomial fitted to the window around it. Near the ends the first and last
/// full windows are evaluated away from their middle.
///
/// Equal to `scipy.signal.savgol_filter(..., mode="interp")` for odd windows.
///
/// ```
/// use stiction_signal::SavitzkyGolay;
///
/// // Acceleration of uniformly accelerated motion, 2 m/s^2, sampled at 1 kHz.
/// let position: Vec<f64> = (0..100).map(|k| (k as f64 * 1e-3).powi(2)).collect();
/// let acceleration = SavitzkyGolay::new(11, 3, 2)?.apply(&position, 1e-3)?;
/// assert!(acceleration.iter().all(|a| (a - 2.0).abs() < 1e-8));
/// # Ok::<(), stiction_signal::SignalError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SavitzkyGolay {
    half: usize,
    derivative: usize,
    gram: Gram,
    weights: Vec<f64>,
}

impl SavitzkyGolay {
    /// Fits polynomials of `degree` (0 to 12) to `window` samples (odd, more than the degree) and
    /// takes the derivative of order `derivative`; 0 smooths. A derivative above the degree is 0.
    ///
    /// # Errors
    /// If a number is outside its range.
    pub fn new(window: usize, degree: usize, derivative: usize) -> Result<Self, SignalError> {
        let outside = |parameter, found: usize, allowed: &str| SignalError::Parameter {
            parameter,
            found: found as f64,
            allowed: allowed.into(),
        };
        if window.is_multiple_of(2) {
            return Err(outside("Savitzky-Golay window", window, "odd"));
        }
        let highest = MAX_DEGREE.min(window - 1);
        if degree > highest {
            let allowed = format!("0 to {highest} for a window of {window}");
            return Err(outside("Savitzky-Golay degree", degree, &allowed));
        }
        if derivative > MAX_DEGREE {
            return Err(outside("Savitzky-Golay derivative", derivative, "0 to 12"));
        }
        let half = window / 2;
        let gram = Gram::new(half, degree);
        let weights = gram.central_weights(derivative);
        Ok(Self {
            half,
            derivative,
            gram,
            weights,
        })
    }

    /// The smoothed signal or its derivative, in units of the signal per s to the power of the
    /// derivative; `step` is the time between samples, s.
    ///
    /// # Errors
    /// If the signal is shorter than the window, a sample is not finite or the step not positive.
    pub fn apply(&self, signal: &[f64], step: f64) -> Result<Vec<f64>, SignalError> {
        let window = 2 * self.half + 1;
        check::positive("step in s", step)?;
        check::length("Savitzky-Golay filtering", signal, window)?;
        check::finite(signal)?;
        let scale = libm::pow(step, -(self.derivative as f64));
        let mut output = Vec::with_capacity(signal.len());
        self.off_middle(&signal[..window], -(self.half as isize)..0, &mut output);
        output.extend(signal.windows(window).map(|samples| self.middle(samples)));
        let end = &signal[signal.len() - window..];
        self.off_middle(end, 1..self.half as isize + 1, &mut output);
        output.iter_mut().for_each(|value| *value *= scale);
        Ok(output)
    }

    fn middle(&self, samples: &[f64]) -> f64 {
        self.weights
            .iter()
            .zip(samples)
            .map(|(weight, sample)| weight * sample)
            .sum()
    }

    /// Appends the derivative of the fit to one window at offsets from its middle.
    fn off_middle(&self, samples: &[f64], offsets: core::ops::Range<isize>, output: &mut Vec<f64>) {
        let fit = self.gram.fit(samples);
        output.extend(offsets.map(|offset| {
            let derivatives = self.gram.derivatives(self.derivative, offset as f64);
            fit.iter().zip(derivatives).map(|(c, d)| c * d).sum::<f64>()
        }));
    }
}
