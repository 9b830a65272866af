//! How noisy a channel is, without knowing the signal.

/// Order of the differences.
const DIFFERENCE_ORDER: usize = 6;
/// Sum of the squared weights of a sixth difference: the binomial coefficient of 12 over 6.
const DIFFERENCE_GAIN: f64 = 924.0;
/// Fraction of the differences, the largest ones, that is left out: jumps and gaps are not noise. A chosen
/// value: a log with more of them has other faults too.
const OUTLIER_SHARE: f64 = 0.01;

/// Standard deviation of the white noise of channels that are smooth between samples, from their
/// sixth differences. Encoder steps passed at speed count as noise, of step/sqrt(12); whatever the
/// signal itself has near the Nyquist frequency counts too.
pub fn noise_deviation<'a>(channels: impl Iterator<Item = &'a [f64]>) -> f64 {
    let mut squares: Vec<f64> = Vec::new();
    for channel in channels {
        let differences = channel.windows(DIFFERENCE_ORDER + 1).map(|x| {
            let pairs = (x[0] + x[6]) - 6.0 * (x[1] + x[5]) + 15.0 * (x[2] + x[4]);
            pairs - 20.0 * x[3]
        });
        squares.extend(differences.map(|d| d * d));
    }
    if squares.is_empty() {
        return 0.0;
    }
    let most = ((1.0 - OUTLIER_SHARE) * squares.len() as f64) as usize;
    let most = most.clamp(1, squares.len());
    let largest = *squares
        .clone()
        .select_nth_unstable_by(most - 1, f64::total_cmp)
        .1;
    // In the order of the samples, whatever the selection did; those equal to the largest stand for each other.
    let (mut sum, mut below) = (0.0, 0_usize);
    for square in squares.into_iter().filter(|square| *square < largest) {
        sum += square;
        below += 1;
    }
    sum += (most - below) as f64 * largest;
    (sum / (DIFFERENCE_GAIN * most as f64)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::noise_deviation;

    #[test]
    fn encoder_steps_at_speed_are_noise_of_a_step_over_the_root_of_twelve() {
        let steps: Vec<f64> = (0..20_000)
            .map(|i| (1e5 * (3e-3 * f64::from(i)).sin()).round())
            .collect();
        let found = noise_deviation(std::iter::once(&steps[..]));
        assert!((found * 12.0_f64.sqrt() - 1.0).abs() < 0.1, "{found}");
    }

    #[test]
    fn a_smooth_signal_has_none_and_a_short_one_too() {
        let smooth: Vec<f64> = (0..1000).map(|i| (0.05 * f64::from(i)).sin()).collect();
        assert!(noise_deviation(std::iter::once(&smooth[..])) < 1e-9);
        assert_eq!(noise_deviation(std::iter::once(&smooth[..5])), 0.0);
    }
}
