//! From which sample on a force has settled after a disturbance.

/// Samples to drop at the start of a signal that settles to a mean: the marginal standard error rule
/// (White 1997, doi 10.1177/003754979706900601) on batches of at least five samples.
///
/// It drops as many as make the standard error of the mean of the rest smallest: dropping a transient
/// lowers the spread, dropping more only costs samples. `None` where the smallest lies beyond the
/// middle: then the signal has not settled.
pub(super) fn transient(signal: &[f64]) -> Option<usize> {
    let n = signal.len();
    // More than some hundred batches would not locate the end of a transient any better.
    let batch = (n / 200).max(5);
    let means: Vec<f64> = signal
        .chunks_exact(batch)
        .map(|c| c.iter().sum::<f64>() / batch as f64)
        .collect();
    let m = means.len();
    if m < 4 {
        return Some(0);
    }
    let (mut sum, mut squares) = (0.0, 0.0);
    let level = means[m / 2];
    let mut best = (f64::INFINITY, 0);
    for (i, x) in means.iter().enumerate().rev() {
        let x = x - level;
        sum += x;
        squares += x * x;
        let left = (m - i) as f64;
        // The last few batches alone look steady by chance.
        if left < 5.0 {
            continue;
        }
        let error = (squares - sum * sum / left).max(0.0) / (left * left);
        if error <= best.0 {
            best = (error, i);
        }
    }
    (best.1 <= m / 2).then_some(best.1 * batch)
}

#[cfg(test)]
mod tests {
    use super::transient;

    /// A cheap sequence in -1..1.
    fn noise(i: usize) -> f64 {
        (i as f64 * 12.9898).sin() * 43_758.545_3 % 1.0
    }

    #[test]
    fn drops_an_exponential_transient_and_keeps_a_steady_signal() {
        let steady: Vec<f64> = (0..1000).map(|i| 5.0 + 0.1 * noise(i)).collect();
        assert!(transient(&steady).unwrap() < 250);
        let settling: Vec<f64> = (0..1000)
            .map(|i| 5.0 + 4.0 * (-(i as f64) / 40.0).exp() + 0.1 * noise(i))
            .collect();
        let dropped = transient(&settling).unwrap();
        // After 3 time constants .2 of the initial 4 is left, after 7 a negligible amount.
        assert!((100..400).contains(&dropped), "{dropped}");
    }

    #[test]
    fn a_signal_that_never_settles_is_told() {
        let ramp: Vec<f64> = (0..1000).map(|i| i as f64).collect();
        assert_eq!(transient(&ramp), None);
    }
}
