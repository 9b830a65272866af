//! Derivatives, resampling, gaps and correlation: closed forms and invariants.

use proptest::collection::vec;
use proptest::prelude::*;
use stiction_signal::{
    SavitzkyGolay, SignalError, autocorrelation, effective_sample_size, fill_gaps, gradient,
    gradient_irregular, interpolate, resample_uniform, second_derivative,
};

/// Value and derivatives of sum c_k t^k by differentiating the coefficients.
fn polynomial(coefficients: &[f64], t: f64, derivative: usize) -> f64 {
    let term = |(k, c): (usize, &f64)| {
        let falling: f64 = (0..derivative).map(|d| k as f64 - d as f64).product();
        if k < derivative {
            0.0
        } else {
            c * falling * t.powi((k - derivative) as i32)
        }
    };
    coefficients.iter().enumerate().map(term).sum()
}

proptest! {
    #[test]
    fn savitzky_golay_is_exact_for_its_degree(
        coefficients in vec(-1.0..1.0, 1..=6), half in 3usize..30, derivative in 0usize..=3,
    ) {
        let (step, count) = (0.01, 2 * half + 40);
        let time = |k: usize| step * k as f64 - 0.5;
        let values: Vec<f64> = (0..count).map(|k| polynomial(&coefficients, time(k), 0)).collect();
        let filter = SavitzkyGolay::new(2 * half + 1, coefficients.len() - 1, derivative).unwrap();
        let found = filter.apply(&values, step).unwrap();
        // Rounding of the values, amplified by differences over a fraction of the window.
        let tolerance = 1e-13 * (40.0 / (half as f64 * step)).powi(derivative as i32);
        for (k, found) in found.into_iter().enumerate() {
            let expected = polynomial(&coefficients, time(k), derivative);
            prop_assert!((found - expected).abs() < tolerance.max(1e-12), "{k}: {found} {expected}");
        }
    }

    /// Of all polynomials the fit is the nearest: its residual has no part in any of them, so
    /// smoothing with the whole record as window leaves nothing to find in what was removed.
    #[test]
    fn savitzky_golay_projects(values in vec(-1.0..1.0, 31..=31), degree in 0usize..=8) {
        let filter = SavitzkyGolay::new(31, degree, 0).unwrap();
        let smooth = filter.apply(&values, 1.0).unwrap();
        let residual: Vec<f64> = values.iter().zip(&smooth).map(|(x, s)| x - s).collect();
        let left = filter.apply(&residual, 1.0).unwrap();
        prop_assert!(left.iter().all(|value| value.abs() < 1e-12));
    }

    #[test]
    fn parabolas_and_cubics_are_differentiated_exactly(
        c in vec(-1.0..1.0, 4), steps in vec(0.1..1.0, 4..50),
    ) {
        let mut times = vec![-3.0];
        times.extend(steps.iter().scan(-3.0, |t, step| { *t += step; Some(*t) }));
        let parabola: Vec<f64> = times.iter().map(|&t| polynomial(&c[..3], t, 0)).collect();
        let slopes = gradient_irregular(&times, &parabola).unwrap();
        let uniform: Vec<f64> = (0..times.len()).map(|k| 0.1 * k as f64).collect();
        let parabola: Vec<f64> = uniform.iter().map(|&t| polynomial(&c[..3], t, 0)).collect();
        let cubic: Vec<f64> = uniform.iter().map(|&t| polynomial(&c, t, 0)).collect();
        let uniform_slopes = gradient(&parabola, 0.1).unwrap();
        let bends = second_derivative(&cubic, 0.1).unwrap();
        for k in 0..times.len() {
            prop_assert!((slopes[k] - polynomial(&c[..3], times[k], 1)).abs() < 1e-10);
            prop_assert!((uniform_slopes[k] - polynomial(&c[..3], uniform[k], 1)).abs() < 1e-11);
            prop_assert!((bends[k] - polynomial(&c, uniform[k], 2)).abs() < 1e-8);
        }
    }

    #[test]
    fn resampling_a_straight_line_gives_the_line(steps in vec(1e-4..1e-2, 1..200), rate in 100.0..2000.0) {
        let mut times = vec![5.0];
        times.extend(steps.iter().scan(5.0, |t, step| { *t += step; Some(*t) }));
        let line: Vec<f64> = times.iter().map(|t| 2.0 * t - 7.0).collect();
        let grid = resample_uniform(&times, &line, rate).unwrap();
        let span = times[times.len() - 1] - times[0];
        prop_assert!(((grid.len() - 1) as f64 - span * rate).abs() <= 1.0);
        for (k, value) in grid.iter().enumerate() {
            prop_assert!((value - (2.0 * (5.0 + k as f64 / rate) - 7.0)).abs() < 1e-8);
        }
    }

    #[test]
    fn correlation_stays_within_one(values in vec(-1e3..1e3, 4..200)) {
        let lags = values.len() - 1;
        let found = autocorrelation(&values, lags).unwrap();
        prop_assert!((found[0] - 1.0).abs() < 1e-12);
        prop_assert!(found.iter().all(|value| value.abs() <= 1.0 + 1e-12));
        // All lags of both signs of a centred signal sum to 0.
        let sum = 1.0 + 2.0 * found[1..].iter().sum::<f64>();
        prop_assert!(sum.abs() < 1e-9, "{sum}");
        let size = effective_sample_size(&values, lags).unwrap().size;
        prop_assert!((1.0..=values.len() as f64).contains(&size));
    }
}

#[test]
fn second_derivative_of_a_sine_converges_with_the_square_of_the_step() {
    let error = |count: usize| {
        let step = 3.0 / count as f64;
        let sine: Vec<f64> = (0..=count).map(|k| (step * k as f64).sin()).collect();
        let found = second_derivative(&sine, step).unwrap();
        let differences = found.iter().zip(&sine).map(|(d, s)| (d + s).abs());
        differences.fold(0.0, f64::max)
    };
    let order = (error(1000) / error(2000)).log2();
    assert!((order - 2.0).abs() < 0.02, "{order}");
}

#[test]
fn a_constant_counts_as_uncorrelated() {
    assert_eq!(autocorrelation(&[0.1; 9], 2).unwrap(), [1.0, 0.0, 0.0]);
    assert_eq!(effective_sample_size(&[0.1; 9], 8).unwrap().size, 9.0);
    let huge = [1e308, -1e308, 1e308, -1e308];
    assert_eq!(autocorrelation(&huge, 1).unwrap(), [1.0, -0.75]);
}

#[test]
fn a_trend_never_dies_out() {
    let trend: Vec<f64> = (0..1000).map(f64::from).collect();
    let found = effective_sample_size(&trend, 10).unwrap();
    assert!(!found.complete && found.lags == 10);
}

#[test]
fn gaps_are_filled_or_reported() {
    let nan = f64::NAN;
    let mut signal = [nan, 0.0, nan, nan, 3.0, nan, nan, nan, 7.0, f64::INFINITY];
    let gaps = fill_gaps(&mut signal, 2).unwrap();
    assert_eq!(signal[..5][1..], [0.0, 1.0, 2.0, 3.0]);
    assert_eq!((gaps.filled, gaps.left), (2, vec![0..1, 5..8, 9..10]));
    let mut all = [nan; 3];
    assert_eq!(fill_gaps(&mut all, 9).unwrap().left.first(), Some(&(0..3)));
    assert_eq!(fill_gaps(&mut [], 9).unwrap().left, []);
    assert!(fill_gaps(&mut all, 0).is_err());
}

#[test]
fn bad_input_is_refused_with_its_place() {
    let (times, values) = ([0.0, 1.0, 1.0, 2.0], [0.0; 4]);
    let expected = SignalError::NotIncreasing {
        index: 2,
        previous: 1.0,
        found: 1.0,
    };
    assert_eq!(gradient_irregular(&times, &values), Err(expected.clone()));
    assert_eq!(interpolate(&times, &values, &[0.5]), Err(expected));
    let length = SignalError::LengthMismatch {
        signal: "the time column",
        found: 4,
        expected: 3,
    };
    assert_eq!(interpolate(&times, &values[..3], &[]), Err(length));
    assert!(interpolate(&[], &[], &[1.0]).is_err());
    assert_eq!(
        gradient(&[0.0, 1.0], 1.0).unwrap_err().to_string(),
        "a gradient needs at least 3 samples, found 2"
    );
    assert!(gradient(&[0.0; 5], 0.0).is_err() && second_derivative(&[0.0; 3], 1.0).is_err());
    // A stray time stamp must not ask for a grid of 10^12 samples.
    let stray = resample_uniform(&[0.0, 1e-3, 1e9], &[0.0; 3], 1e3).unwrap_err();
    assert!(
        stray
            .to_string()
            .starts_with("sample rate in Hz is 1000; allowed: at most")
    );
    assert!(resample_uniform(&[-1e308, 1e308], &[0.0; 2], 1e3).is_err());
    assert!(autocorrelation(&[0.0; 3], 3).is_err() && effective_sample_size(&[0.0; 3], 1).is_err());
    for (window, degree, derivative) in [(4, 2, 0), (0, 0, 0), (5, 5, 0), (99, 13, 0), (5, 2, 13)] {
        assert!(SavitzkyGolay::new(window, degree, derivative).is_err());
    }
    let filter = SavitzkyGolay::new(5, 2, 3).unwrap();
    assert_eq!(
        filter.apply(&[1.0, 9.0, 2.0, 4.0, 4.0], 1.0).unwrap(),
        [0.0; 5]
    );
    assert!(filter.apply(&[0.0; 4], 1.0).is_err());
}
