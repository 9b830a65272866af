//! What drives pass through that they show: a low-pass of first order, or a mean over rows.

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

/// Undoes a mean over so many rows, but for its delay of half of them: gives what was passed through it where that hardly changes
/// within that many rows. Fewer than two rows leave everything as it is.
///
/// A mean has no inverse that noise survives. The two low-passes of first order, one forward and one back in time, whose spread in
/// time is that of the mean have one, and are the same to the third order of frequency times rows.
///
/// ```
/// // What goes up and down in 60 rows, in the middle of a mean over 9 of them.
/// let wave = |k: usize| f64::sin(std::f64::consts::TAU * k as f64 / 60.0);
/// let mut mean: Vec<f64> = (0..240)
///     .map(|k| (0..9).map(|j| wave(k + j)).sum::<f64>() / 9.0)
///     .collect();
/// assert!((mean[101] / wave(105) - 1.0).abs() > 0.03);
/// stiction_signal::undo_mean(&mut mean, 9.0);
/// assert!((mean[101] / wave(105) - 1.0).abs() < 0.001);
/// ```
pub fn undo_mean(samples: &mut [f64], rows: f64) {
    let time_constant = of_mean(rows);
    undo_low_pass(samples, time_constant);
    samples.reverse();
    undo_low_pass(samples, time_constant);
    samples.reverse();
}

/// Time constant, samples, of the low-passes forward and back in time whose spread is that of a mean over so many rows; 0 for
/// fewer than two.
pub fn of_mean(rows: f64) -> f64 {
    // The variance of a row of the mean is (n^2 - 1)/12, that of one low-pass q/(1 - q)^2 with q what it keeps in a sample.
    let variance = (rows * rows - 1.0) / 24.0;
    if variance.is_nan() || variance <= 0.0 {
        return 0.0;
    }
    let kept = (2.0 * variance + 1.0 - libm::sqrt(4.0 * variance + 1.0)) / (2.0 * variance);
    -1.0 / libm::log(kept)
}
