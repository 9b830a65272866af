//! Derivatives, interpolation and correlation against scipy and numpy.

use crate::common::{Case, error, reference};
use stiction_signal::{
    SavitzkyGolay, autocorrelation, effective_sample_size, gradient, gradient_irregular,
    gradient_sixth_order, interpolate,
};

fn filtered(case: &Case) -> Vec<f64> {
    let [window, degree, derivative] = ["window", "degree", "derivative"].map(|n| case.count(n));
    let filter = SavitzkyGolay::new(window, degree, derivative).unwrap();
    filter
        .apply(&case.signal("x"), case.number("step"))
        .unwrap()
}

/// Windows up to 21 samples and degrees up to 5: beyond, scipy's powers of the sample number lose
/// digits (1e-11 at 41 samples, 1e-6 at degree 12), and the next test takes over. On the scale of
/// the largest output that a signal of this size can have.
#[test]
fn savitzky_golay_with_edges() {
    let mut worst: f64 = 0.0;
    for case in reference("savitzky_golay") {
        let error = error(&filtered(&case), &case.signal("y"), &case.signal("scale"));
        let [window, degree] = ["window", "degree"].map(|name| case.count(name));
        assert!(error < 1e-12, "window {window} degree {degree}: {error}");
        worst = worst.max(error);
    }
    println!("largest error {worst:.1e}");
}

/// Against weights from rational arithmetic, also where scipy is off by 1e-6.
#[test]
fn savitzky_golay_of_high_degree() {
    let (mut worst, mut scipy): (f64, f64) = (0.0, 0.0);
    for case in reference("savitzky_golay_exact") {
        let exact = case.signal("y");
        let error_of = |found: &[f64]| error(found, &exact, &exact);
        let error = error_of(&filtered(&case));
        let [window, degree] = ["window", "degree"].map(|name| case.count(name));
        assert!(error < 1e-12, "window {window} degree {degree}: {error}");
        worst = worst.max(error);
        scipy = scipy.max(error_of(&case.signal("scipy")));
    }
    println!("largest error {worst:.1e}, of scipy {scipy:.1e}");
}

#[test]
fn gradients() {
    for case in reference("gradient") {
        let signal = case.signal("x");
        let regular = gradient(&signal, case.number("step")).unwrap();
        let expected = case.signal("regular");
        assert!(error(&regular, &expected, &expected) < 1e-12);
        let irregular = gradient_irregular(&case.signal("times"), &signal).unwrap();
        let expected = case.signal("irregular");
        assert!(error(&irregular, &expected, &expected) < 1e-12);
    }
}

#[test]
fn interpolation_to_the_bit() {
    for case in reference("interpolation") {
        let found = interpolate(&case.signal("times"), &case.signal("x"), &case.signal("at"));
        assert_eq!(found.unwrap(), case.signal("y"));
    }
}

#[test]
fn autocorrelation_and_effective_size() {
    for case in reference("correlation") {
        let (signal, rho) = (case.signal("x"), case.number("rho"));
        let found = autocorrelation(&signal, 100).unwrap();
        assert!(
            error(&found, &case.signal("y"), &[1.0]) < 1e-12,
            "rho {rho}"
        );

        let effective = effective_sample_size(&signal, 2000).unwrap();
        let expected = (signal.len() as f64 * (1.0 - rho) / (1.0 + rho)).min(signal.len() as f64);
        let ratio = effective.size / expected;
        println!("rho {rho}: {effective:?}, {ratio:.3} of the expected size");
        assert!(effective.complete);
        // The estimate's own standard deviation is sqrt(2 (2 M + 1) / N) at M lags (Sokal 1997,
        // eq. 2.20 for a sum cut off at M): 2 to 11 % here. Three of them are allowed.
        let deviation = (2.0 * (2.0 * effective.lags as f64 + 1.0) / signal.len() as f64).sqrt();
        assert!(
            (ratio - 1.0).abs() < 3.0 * deviation,
            "rho {rho}: {ratio} within 3 x {deviation}"
        );
    }
}

/// A polynomial of degree 6 has an exact slope; a sine of a tenth of the rate one to 0.05 %.
#[test]
fn the_gradient_over_seven_samples_is_of_sixth_order() {
    let f = |t: f64| 1.0 - t * (2.0 - t * t * (0.3 + t * (0.1 - t * (0.02 + 0.003 * t))));
    let slope =
        |t: f64| -2.0 + t * t * (3.0 * 0.3 + t * (4.0 * 0.1 - t * (5.0 * 0.02 + 6.0 * 0.003 * t)));
    let times: Vec<f64> = (0..40).map(|i| 0.1 * f64::from(i) - 2.0).collect();
    let signal: Vec<f64> = times.iter().map(|&t| f(t)).collect();
    let found = gradient_sixth_order(&signal, 0.1).unwrap();
    for i in 3..37 {
        assert!((found[i] - slope(times[i])).abs() < 1e-11);
    }
    let omega = std::f64::consts::TAU * 0.1;
    let sine: Vec<f64> = (0..200).map(|i| (omega * f64::from(i)).sin()).collect();
    let found = gradient_sixth_order(&sine, 1.0).unwrap();
    for (i, slope) in found.iter().enumerate().take(197).skip(3) {
        let want = omega * (omega * i as f64).cos();
        assert!((slope - want).abs() < 5e-4 * omega);
    }
}
