//! Closed-loop logs as drives write them: quantised, noisy, half a sample late, mass and offset unknown.

#[path = "common/closed_loop.rs"]
mod closed_loop;

use closed_loop::{error, identified, three_segments, truth};

/// Every parameter of each log within `most` percent of the truth, and the intervals hold it as often as
/// chance lets them: 17 of 20 at least.
fn holds(logs: &[(&str, f64, f64)]) {
    let (mut inside, mut all) = (0, 0);
    for &(name, count, most) in logs {
        let log = three_segments(name, count, 0.5, 0);
        let (tuned, found) = identified(&log, count);
        assert!(!tuned.trials.is_empty(), "{name}: nothing was tried");
        for (parameter, truth) in truth(name) {
            let parameter = found.parameter(parameter).unwrap();
            let (off, covered) = error(parameter, truth);
            println!(
                "{name} {:.0} nm {} {off:+.2} % {covered}",
                1e9 * count,
                parameter.name
            );
            assert!(
                off.abs() < most,
                "{name}, {:.0} nm: {} is off by {off:.2} %",
                1e9 * count,
                parameter.name
            );
            inside += usize::from(covered);
            all += 1;
        }
        // The force is held from its sample to the next.
        let delay = found.value("delay").unwrap();
        assert!((delay + 1.25e-4).abs() < 5e-5, "{name}: delay {delay}");
    }
    assert!(20 * inside >= 17 * all, "{inside} of {all} intervals hold");
}

#[test]
fn fine_encoders_within_two_percent() {
    holds(&[
        ("machine", 50e-9, 2.0),
        ("machine", 100e-9, 2.0),
        ("motor", 50e-9, 2.0),
        ("motor", 100e-9, 2.0),
    ]);
}

#[test]
fn coarse_encoders_within_ten_percent() {
    holds(&[("machine", 1e-6, 10.0), ("motor", 1e-6, 10.0)]);
}
