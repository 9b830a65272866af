//! The unit of the force is a choice: nothing in an identification depends on how large its numbers are.

use crate::common::identified::{Fit, identified};
use stiction_files::Axis;
use stiction_testkit::worlds::{Machine, Motion, World, record};
use stiction_workflows::identify::Options;

fn scaled(machine: &Machine, by: f64) -> Fit {
    let mut log = record(machine, Motion::Commissioning, World::Faithful, 1);
    log.force.iter_mut().for_each(|force| *force *= by);
    identified(machine, &[log], &Axis::default(), &Options::default()).unwrap()
}

/// What a parameter is worth where the force is `by` as large.
fn unit(name: &str, by: f64) -> f64 {
    match name {
        "stribeck_velocity" | "stribeck_exponent" | "delay" => 1.0,
        _ => by,
    }
}

/// With a power of two every number of the force keeps its digits, and so does every number of the result.
#[test]
fn a_force_in_another_unit_has_the_same_result() {
    let (_, machine) = Machine::all(1)[0];
    let one = scaled(&machine, 1.0);
    let by = 1.0 / 512.0;
    let other = scaled(&machine, by);
    for (a, b) in one.parameters().zip(other.parameters()) {
        let unit = unit(a.name(), by);
        assert_eq!(a.name(), b.name());
        assert_eq!(a.value() * unit, b.value(), "{}", a.name());
        let ends = a.interval().map(|(low, high)| (low * unit, high * unit));
        assert_eq!(ends, b.interval(), "{}", a.name());
        assert_eq!(a.is_identifiable(), b.is_identifiable(), "{}", a.name());
    }
    let codes = |fit: &Fit| fit.warnings().iter().map(|w| w.code).collect::<Vec<_>>();
    assert_eq!(codes(&one), codes(&other));
    let [mine, theirs] = [&one, &other].map(|fit| fit.result().fit.relative_error_percent);
    assert_eq!(mine, theirs);
}

/// With another factor the last digits are rounded elsewhere. The fit of the force stays; the simulated logs that its bias is seen
/// on get other counts where a rounding decides one, and with these another noise: less than a deviation of each parameter.
#[test]
fn a_force_that_is_rounded_elsewhere_has_the_same_result_within_its_deviation() {
    let (_, machine) = Machine::all(1)[0];
    let by = 1.0 / 628.3185;
    let [one, other] = [1.0, by].map(|by| scaled(&machine, by));
    for (a, b) in one.parameters().zip(other.parameters()) {
        let Some((low, high)) = a.interval().filter(|_| a.is_identifiable()) else {
            continue;
        };
        let apart = (b.value() / unit(a.name(), by) - a.value()).abs();
        assert!(
            apart < 0.25 * (high - low),
            "{}: {apart} of {low} .. {high}",
            a.name()
        );
        assert!(b.is_identifiable(), "{}", a.name());
    }
    let [mine, theirs] = [&one, &other].map(|fit| fit.result().fit.relative_error_percent);
    assert!((mine / theirs - 1.0).abs() < 1e-9, "{mine} {theirs}");
}
