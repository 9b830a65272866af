//! Lower sample rates.

use crate::{SignalError, Sos};

/// The filter that [`decimate`] uses: an 8th-order Butterworth low-pass filter at half the new
/// Nyquist frequency. Forward and backward it passes 1 - 2e-3 at a third of the new Nyquist
/// frequency and less than 1.6e-5 above it.
///
/// # Errors
/// If `factor` is not 2 to 50 000.
pub fn anti_alias(factor: usize) -> Result<Sos, SignalError> {
    if !(2..=50_000).contains(&factor) {
        return Err(SignalError::Parameter {
            parameter: "decimation factor",
            found: factor as f64,
            allowed: "2 to 50000 (1 leaves the signal as it is)".into(),
        });
    }
    Sos::butterworth_low_pass(8, 0.5 / factor as f64, 2.0)
}

/// Every `factor`-th sample, from the first on, of the signal after zero-phase filtering with
/// [`anti_alias`]. A factor of 1 copies the signal.
///
/// ```
/// let slow: Vec<f64> = (0..1000).map(|k| (k as f64 * 0.01).sin()).collect();
/// let decimated = stiction_signal::decimate(&slow, 10)?;
/// assert_eq!(decimated.len(), 100);
/// assert!((decimated[50] - slow[500]).abs() < 1e-6);
/// # Ok::<(), stiction_signal::SignalError>(())
/// ```
///
/// # Errors
/// If the factor is 0 or above 50 000, the signal is shorter than 28 samples or a sample is not
/// finite.
pub fn decimate(signal: &[f64], factor: usize) -> Result<Vec<f64>, SignalError> {
    if factor == 1 {
        crate::check::finite(signal)?;
        return Ok(signal.to_vec());
    }
    let smooth = anti_alias(factor)?.zero_phase(signal)?;
    Ok(smooth.into_iter().step_by(factor).collect())
}
