//! Linear interpolation between irregular samples.

use crate::{SignalError, check};

/// Most grid samples for each sample of the input, so that a stray time stamp cannot exhaust
/// the memory.
const MAX_EXPANSION: f64 = 64.0;
/// How far the last grid point may lie beyond the last time stamp, in grid steps: rounding of the time stamps. It then
/// takes the value of the last sample.
const GRID_ROUNDING: f64 = 1e-6;

/// Values at the instants `at`, s, on the straight lines between the samples taken at `times`, s;
/// before the first and after the last sample, their values. Equal to
/// `numpy.interp(at, times, signal)`. The instants need no order, but rising ones are faster.
///
/// ```
/// let values = stiction_signal::interpolate(&[0.0, 1.0, 3.0], &[0.0, 2.0, 0.0], &[0.5, 2.0, 9.0])?;
/// assert_eq!(values, [1.0, 1.0, 0.0]);
/// # Ok::<(), stiction_signal::SignalError>(())
/// ```
///
/// # Errors
/// If there are no samples, the lengths differ, anything is not finite or `times` does not
/// increase.
pub fn interpolate(times: &[f64], signal: &[f64], at: &[f64]) -> Result<Vec<f64>, SignalError> {
    check_samples(times, signal)?;
    check::finite(at)?;
    Ok(on_lines(times, signal, at.iter().copied()))
}

/// The signal on a uniform grid: from the first of the `times`, s, on, at `rate` Hz, as far as the
/// samples reach, on straight lines between them. Sample k is at `times[0] + k / rate`.
///
/// This does not filter: a signal with content above half the new rate must be filtered before.
///
/// # Errors
/// As for [`interpolate`]; also if the rate is not positive, or so high that the grid would have
/// more than 64 samples for each one given.
pub fn resample_uniform(times: &[f64], signal: &[f64], rate: f64) -> Result<Vec<f64>, SignalError> {
    check_samples(times, signal)?;
    check::positive("sample rate in Hz", rate)?;
    let start = times[0];
    let span = times[times.len() - 1] - start;
    let most = MAX_EXPANSION * times.len() as f64;
    if span * rate > most {
        return Err(SignalError::Parameter {
            parameter: "sample rate in Hz",
            found: rate,
            allowed: format!("at most {} for these {} samples", most / span, times.len()),
        });
    }
    let steps = (span * rate + GRID_ROUNDING).floor() as usize;
    Ok(on_lines(
        times,
        signal,
        (0..=steps).map(|k| start + k as f64 / rate),
    ))
}

fn check_samples(times: &[f64], signal: &[f64]) -> Result<(), SignalError> {
    check::same_length("the time column", times.len(), signal.len())?;
    check::length("interpolation", signal, 1)?;
    check::increasing(times)?;
    check::finite(signal)
}

fn on_lines(times: &[f64], signal: &[f64], at: impl Iterator<Item = f64>) -> Vec<f64> {
    let last = times.len() - 1;
    // Interval `left` contains the previous instant. For rising instants the same interval or the next one is tried
    // before a search.
    let mut left = 0;
    let value = |t: f64| {
        if t < times[0] {
            return signal[0];
        }
        if t >= times[last] {
            return signal[last];
        }
        let holds = |left: usize| left < last && times[left] <= t && t < times[left + 1];
        if !holds(left) {
            let search = || times.partition_point(|&time| time <= t) - 1;
            left = if holds(left + 1) { left + 1 } else { search() };
        }
        let slope = (signal[left + 1] - signal[left]) / (times[left + 1] - times[left]);
        slope * (t - times[left]) + signal[left]
    };
    at.map(value).collect()
}
