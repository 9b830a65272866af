//! What must hold for any filter and any signal.

use proptest::collection::vec;
use proptest::prelude::*;
use stiction_signal::{Section, SignalError, Sos, anti_alias, decimate};

fn any_filter() -> impl Strategy<Value = Sos> {
    (1usize..=8, 0.02..0.9, any::<bool>()).prop_map(|(order, cutoff, low)| {
        let design = if low {
            Sos::butterworth_low_pass
        } else {
            Sos::butterworth_high_pass
        };
        design(order, cutoff, 2.0).unwrap()
    })
}

fn low_pass() -> impl Strategy<Value = Sos> {
    (1usize..=8, 1e-4..0.9)
        .prop_map(|(n, cutoff)| Sos::butterworth_low_pass(n, cutoff, 2.0).unwrap())
}

fn signal() -> impl Strategy<Value = Vec<f64>> {
    vec(-1.0..1.0, 40..300)
}

fn largest_difference(x: &[f64], y: &[f64]) -> f64 {
    assert_eq!(x.len(), y.len());
    x.iter()
        .zip(y)
        .map(|(x, y)| (x - y).abs())
        .fold(0.0, f64::max)
}

proptest! {
    #[test]
    fn linear(filter in any_filter(), x in signal(), factor in -3.0..3.0) {
        let y: Vec<f64> = (0..x.len()).map(|k| (0.3 * k as f64).cos()).collect();
        let sum: Vec<f64> = x.iter().zip(&y).map(|(x, y)| x + factor * y).collect();
        let (fx, fy) = (filter.zero_phase(&x).unwrap(), filter.zero_phase(&y).unwrap());
        let expected: Vec<f64> = fx.iter().zip(&fy).map(|(x, y)| x + factor * y).collect();
        prop_assert!(largest_difference(&filter.zero_phase(&sum).unwrap(), &expected) < 1e-10);
    }

    /// A signal and its mirror image are filtered alike, so there is no delay. Only what lies
    /// further inside than the ends reach is the same: the passes come in another order.
    #[test]
    fn the_same_in_both_directions_of_time(filter in any_filter(), x in signal()) {
        let far = filter.settling_samples();
        let padded: Vec<f64> = [vec![0.0; 4 * far], x, vec![0.0; 4 * far]].concat();
        let mirror: Vec<f64> = padded.iter().rev().copied().collect();
        let mut back = filter.zero_phase(&mirror).unwrap();
        back.reverse();
        prop_assert!(largest_difference(&filter.zero_phase(&padded).unwrap(), &back) < 1e-9);
    }

    #[test]
    fn a_constant_passes_a_low_pass_filter(filter in low_pass(), level in -1e3..1e3) {
        prop_assert!((filter.gain(0.0) - 1.0).abs() < 1e-13);
        let constant = vec![level; 100];
        let found = filter.zero_phase(&constant).unwrap();
        // Rounding in a slow filter's state is amplified by 1 / cutoff^2, 1e7 at the lowest.
        prop_assert!(largest_difference(&found, &constant) <= 1e-7 * level.abs());
    }

    #[test]
    fn columns_side_by_side_give_the_same_bits(filter in any_filter(), count in 0usize..=9) {
        let column = |c: usize| (0..60).map(|k| (0.1 * (k * (c + 1)) as f64).sin()).collect();
        let mut columns: Vec<Vec<f64>> = (0..count).map(column).collect();
        let one_by_one: Vec<Vec<f64>> =
            columns.iter().map(|x| filter.zero_phase(x).unwrap()).collect();
        let mut slices: Vec<&mut [f64]> = columns.iter_mut().map(Vec::as_mut_slice).collect();
        filter.zero_phase_columns(&mut slices).unwrap();
        prop_assert_eq!(&columns, &one_by_one);
        if let [a, b, c, ..] = &one_by_one[..] {
            let mut rows: Vec<[f64; 3]> =
                (0..60).map(|k| [0, 1, 2].map(|c| (0.1 * (k * (c + 1)) as f64).sin())).collect();
            filter.zero_phase_rows(&mut rows).unwrap();
            let right: Vec<[f64; 3]> = (0..60).map(|k| [a[k], b[k], c[k]]).collect();
            prop_assert_eq!(rows, right);
        }
    }

    /// A sine well inside a long record comes out with the gain squared and no phase.
    #[test]
    fn a_sine_keeps_its_phase(filter in any_filter(), frequency in 0.02f64..0.45) {
        let wave = |k: usize| (2.0 * core::f64::consts::PI * frequency * k as f64).sin();
        let sine: Vec<f64> = (0..6000).map(wave).collect();
        let gain = filter.gain(frequency);
        let found = filter.zero_phase(&sine).unwrap();
        let expected: Vec<f64> = sine.iter().map(|x| gain * gain * x).collect();
        prop_assert!(largest_difference(&found[2500..3500], &expected[2500..3500]) < 1e-9);
    }

    /// What lies beyond an end reaches no further in than promised.
    #[test]
    fn settling_bounds_the_reach_of_the_ends(filter in any_filter(), beyond in vec(-1.0..1.0, 200)) {
        let (far, inside) = (filter.settling_samples(), 50);
        let length = far + inside;
        let mut with = vec![0.0; length];
        with.extend(&beyond);
        with.extend(vec![0.0; 100]);
        let without = vec![0.0; with.len()];
        let change = largest_difference(
            &filter.zero_phase(&with).unwrap()[..inside],
            &filter.zero_phase(&without).unwrap()[..inside],
        );
        let mut impulse = vec![0.0; 20_000];
        impulse[0] = 1.0;
        filter.filter(&mut impulse);
        let sum: f64 = impulse.iter().map(|h| h.abs()).sum();
        prop_assert!(change <= 1e-3 * sum * sum, "{change} for {sum}");
    }
}

#[test]
fn settling_of_a_first_order_lag_is_known() {
    // h[n] = (1 - r) r^n leaves r^n after n samples: n = ln 1e-3 / ln r.
    let r: f64 = 0.9;
    let lag = Section {
        b: [1.0 - r, 0.0, 0.0],
        a: [-r, 0.0],
    };
    assert_eq!(Sos::new(vec![lag]).unwrap().settling_samples(), 66);
    assert_eq!((1e-3f64.ln() / r.ln()).ceil(), 66.0);
}

#[test]
fn the_lowest_cutoff_is_stable_and_settles() {
    for order in 1..=8 {
        let filter = Sos::butterworth_low_pass(order, 1e-4, 2.0).unwrap();
        let settling = filter.settling_samples();
        assert!(
            (10_000..400_000).contains(&settling),
            "order {order}: {settling}"
        );
        let mut step = vec![1.0; 400_000];
        filter.filter(&mut step);
        assert!((step[399_999] - 1.0).abs() < 1e-6, "order {order}");
    }
}

#[test]
fn decimation_keeps_the_slow_and_drops_the_fast() {
    let wave = |frequency: f64| move |k: usize| (frequency * k as f64).sin();
    let slow: Vec<f64> = (0..5000).map(wave(0.02)).collect();
    let mixed: Vec<f64> = (0..5000).map(|k| wave(0.02)(k) + wave(1.9)(k)).collect();
    let found = decimate(&mixed, 10).unwrap();
    let expected: Vec<f64> = slow.iter().step_by(10).copied().collect();
    // Twice as far in as the ends reach with 1e-3.
    let end = 2 * anti_alias(10).unwrap().settling_samples() / 10;
    let inside = end..500 - end;
    let worst = largest_difference(&found[inside.clone()], &expected[inside]);
    assert!(worst < 1e-6, "{worst}");
    assert_eq!(decimate(&mixed, 1).unwrap(), mixed);
    assert_eq!(decimate(&mixed[..4991], 10).unwrap().len(), 500);
    // The figures in the documentation of `anti_alias`, at frequencies in cycles per sample.
    let gain = |part: f64| anti_alias(10).unwrap().gain(0.05 * part).powi(2);
    assert!(gain(1.0) < 1.6e-5 && gain(1.0 / 3.0) > 1.0 - 2e-3);
}

#[test]
fn errors_name_what_was_found_and_what_is_allowed() {
    let message = |result: Result<Sos, SignalError>| result.unwrap_err().to_string();
    let low_pass = Sos::butterworth_low_pass;
    assert_eq!(
        message(low_pass(0, 1.0, 10.0)),
        "filter order is 0; allowed: 1 to 8"
    );
    assert!(message(low_pass(9, 1.0, 10.0)).contains("is 9"));
    assert_eq!(
        message(low_pass(2, 5.0, 10.0)),
        "cut-off frequency in Hz is 5; allowed: from 0.00005 to 4.99995, below half the sample rate"
    );
    for cutoff in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(message(low_pass(2, cutoff, 10.0)).starts_with("cut-off frequency in Hz"));
    }
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(message(low_pass(2, 1.0, rate)).starts_with("sample rate in Hz"));
    }
    assert!(message(Sos::new(vec![])).contains("number of sections is 0"));
    let unstable = Section {
        b: [1.0, 0.0, 0.0],
        a: [-2.0, 1.01],
    };
    assert!(message(Sos::new(vec![unstable])).contains("allowed: below 1 (stable)"));
    let broken = Section {
        b: [1.0, f64::NAN, 0.0],
        a: [0.0, 0.0],
    };
    assert!(message(Sos::new(vec![broken])).contains("section coefficient is NaN"));

    let filter = low_pass(2, 1.0, 10.0).unwrap();
    let mut spoiled = vec![0.0; 1000];
    spoiled[777] = f64::NAN;
    let error = filter.zero_phase(&spoiled).unwrap_err();
    assert!(matches!(error, SignalError::NotFinite { index: 777, found } if found.is_nan()));
    let (mut long, mut short) = (vec![0.0; 100], vec![0.0; 99]);
    let error = filter
        .zero_phase_columns(&mut [&mut long, &mut short])
        .unwrap_err();
    assert_eq!(error.to_string(), "a column has 99 samples, expected 100");
}
