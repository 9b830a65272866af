//! Filters against `scipy.signal`.

use crate::common::{Case, error, reference};
use stiction_signal::{Section, SignalError, Sos};

fn designed(case: &Case) -> Sos {
    let (order, cutoff) = (case.count("order"), case.number("cutoff"));
    match case.text("band") {
        "lowpass" => Sos::butterworth_low_pass(order, cutoff, 2.0).unwrap(),
        "highpass" => Sos::butterworth_high_pass(order, cutoff, 2.0).unwrap(),
        other => panic!("{other}"),
    }
}

/// Rows `b0 b1 b2 1 a1 a2` as scipy lays them out.
fn rows(filter: &Sos) -> Vec<f64> {
    filter
        .sections()
        .iter()
        .flat_map(|Section { b, a }| [b[0], b[1], b[2], 1.0, a[0], a[1]])
        .collect()
}

fn from_rows(rows: &[f64]) -> Sos {
    let section = |row: &[f64]| Section {
        b: [row[0], row[1], row[2]],
        a: [row[4], row[5]],
    };
    Sos::new(rows.chunks(6).map(section).collect()).unwrap()
}

#[test]
fn butterworth_sections_and_response() {
    for case in reference("butterworth") {
        let filter = designed(&case);
        let name = format!(
            "{} {} {}",
            case.text("band"),
            filter.sections().len(),
            case.number("cutoff")
        );
        // Denominators on the scale of their leading 1; numerators each on its own, as the first
        // section's carries a gain down to 1e-14.
        for (place, (found, expected)) in rows(&filter).iter().zip(case.signal("sos")).enumerate() {
            let scale = if place % 6 < 3 { expected.abs() } else { 1.0 };
            assert!(
                (found - expected).abs() <= 1e-12 * scale,
                "{name}: {found} for {expected}"
            );
        }
        let gain: Vec<f64> = case
            .signal("frequency")
            .iter()
            .map(|&f| filter.gain(f))
            .collect();
        let expected = case.signal("gain");
        assert!(error(&gain, &expected, &expected) < 1e-12, "{name}");
    }
}

/// So low, a last digit of the denominators is 1e-8 of the gain at rest. The poles are those of
/// scipy, and the gain is made to fit them, so that it is 1 all the same.
#[test]
fn butterworth_at_a_very_low_cutoff() {
    for case in reference("low_cutoff") {
        let (order, cutoff) = (case.count("order"), case.number("cutoff"));
        let filter = Sos::butterworth_low_pass(order, cutoff, 2.0).unwrap();
        for (found, expected) in rows(&filter).chunks(6).zip(case.signal("sos").chunks(6)) {
            assert!(
                (found[4] - expected[4]).abs() < 1e-12 && (found[5] - expected[5]).abs() < 1e-12
            );
        }
        let ours = (filter.gain(0.0) - 1.0).abs();
        assert!(ours < 1e-14, "order {order}: gain at rest off by {ours}");
        assert!(
            (filter.gain(0.5 * cutoff) - 0.5f64.sqrt()).abs() < 1e-7,
            "order {order}"
        );
    }
}

/// Errors on the scale of the input signal: a high-pass filter returns little of it.
#[test]
fn causal_and_zero_phase_filtering() {
    let mut worst: f64 = 0.0;
    for case in reference("filtering") {
        let signal = case.signal("x");
        let check = |filter: &Sos, name: &str, limit: f64| {
            let mut causal = signal.clone();
            filter.filter(&mut causal);
            let both_ways = filter.zero_phase(&signal).unwrap();
            let state = filter.settled_state().into_flattened();
            let errors = [
                error(&causal, &case.signal("causal"), &signal),
                error(&both_ways, &case.signal("zero_phase"), &signal),
                error(&state, &case.signal("state"), &state),
            ];
            let [band, order, cutoff] = [
                case.text("band"),
                &case.count("order").to_string(),
                &case.number("cutoff").to_string(),
            ];
            let good = errors.iter().all(|&error| error < limit);
            assert!(good, "{name} {band} {order} {cutoff}: {errors:?}");
            (causal, errors.into_iter().fold(0.0, f64::max))
        };
        let (_, error) = check(&designed(&case), "own coefficients", 1e-12);
        worst = worst.max(error);
        // With scipy's coefficients the same operations are done in the same order.
        let (causal, _) = check(
            &from_rows(&case.signal("sos")),
            "scipy's coefficients",
            1e-12,
        );
        assert_eq!(causal, case.signal("causal"));
    }
    println!("largest error {worst:.1e}");
}

#[test]
fn the_same_signals_are_too_short() {
    for case in reference("shortest") {
        let (filter, shortest) = (designed(&case), case.count("shortest"));
        assert!(filter.zero_phase(&vec![0.0; shortest]).is_ok());
        let refusal = filter.zero_phase(&vec![0.0; shortest - 1]);
        let expected = SignalError::TooShort {
            operation: "zero-phase filtering",
            found: shortest - 1,
            needed: shortest,
        };
        assert_eq!(refusal, Err(expected));
    }
}
