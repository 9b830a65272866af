//! A low-pass of first order, as drives pass what they show through.

/// Undoes a low-pass of first order whose input was held from sample to sample, its time constant in samples: gives the input
/// of each sample. What was before the first one counts as its value. A time constant of zero leaves everything as it is.
///
/// Noise that was added behind the low-pass becomes larger, by about the time constant.
///
/// ```
/// // A step behind a low-pass with a time constant of 2 samples.
/// let mut behind = vec![0.0; 2];
/// behind.extend((1..20).map(|k| 1.0 - f64::exp(-0.5 * f64::from(k))));
/// stiction_signal::undo_low_pass(&mut behind, 2.0);
/// assert!(behind[..2].iter().all(|x| x.abs() < 1e-12));
/// assert!(behind[2..].iter().all(|x| (x - 1.0).abs() < 1e-12));
/// ```
pub fn undo_low_pass(samples: &mut [f64], time_constant: f64) {
    if time_constant.is_nan() || time_constant <= 0.0 {
        return;
    }
    let kept = libm::exp(-1.0 / time_constant);
    let mut before = samples.first().copied().unwrap_or(0.0);
    for x in samples {
        let behind = *x;
        *x = (behind - kept * before) / (1.0 - kept);
        before = behind;
    }
}
