//! Logs of an axis that rests in much of them: laws from the counts of the encoder.

use stiction_identify::{
    Conditioning, Cutoff, Delay, Estimate, IntervalKind, Law, LawKind, Quantity, Samples, Settings,
    Silent, Terms, condition, fit_law, intervals,
};
use stiction_testkit::worlds::{Machine, Motion, World, record};

const SEED: u64 = 1;

/// A ball screw, as identified with cut-offs that suit it.
fn identified(machine: &Machine, motion: Motion, world: World) -> Estimate {
    let log = record(machine, motion, world, SEED);
    let samples = Samples {
        time: log.time,
        position: log.position,
        force: log.force,
        ..Samples::default()
    };
    let conditioning = Conditioning {
        resolution: Some(machine.count),
        source_cutoff: Cutoff::Hz(machine.rate / 7.0),
        common_cutoff: Cutoff::Hz(machine.rate / 28.0),
        ..Conditioning::default()
    };
    let record = condition(&[samples], &conditioning).unwrap();
    let terms = Terms {
        delay: Delay::Fitted,
        ..Terms::default()
    };
    let law = Law::new(LawKind::LuGre);
    let settings = Settings::default();
    let (mut estimate, optimum) =
        fit_law(&record, law, &terms, 0.0, &settings, &mut Silent).unwrap();
    intervals(&record, &optimum, &mut estimate, &mut Silent);
    estimate
}

fn stands_on_counts(estimate: &Estimate) -> bool {
    let own = |p: &stiction_identify::Parameter| p.interval == IntervalKind::StateSpace;
    estimate.parameters.iter().any(own)
}

#[test]
fn dwells_are_no_error_of_the_law() {
    let machine = Machine::screw(SEED);
    let found = identified(&machine, Motion::Trapezoid, World::Faithful);
    for (name, truth) in machine.truth() {
        let p = found.parameter(name).unwrap();
        let (low, high) = p.ci95.unwrap();
        assert_eq!(p.interval, IntervalKind::StateSpace);
        // Micro-damping too: the fit of the force knows closer than half a sample where the delay is.
        assert!(
            (low..=high).contains(&truth),
            "{name}: {truth} in {low}..{high}"
        );
        assert!((p.value / truth - 1.0).abs() < 0.05, "{name}: {}", p.value);
    }
    let at = found.covariance.place(Quantity::Sigma0.into()).unwrap();
    let std = found.parameter("sigma0").unwrap().std.unwrap();
    assert!((found.covariance.matrix[at][at] / (std * std) - 1.0).abs() < 1e-12);
}

#[test]
fn a_force_that_the_law_lacks_is_not_made_up_for() {
    let found = identified(&Machine::screw(SEED), Motion::Trapezoid, World::Cogging);
    assert!(!stands_on_counts(&found));
}

#[test]
fn an_axis_that_does_not_rest_keeps_the_fit_of_its_force() {
    let found = identified(&Machine::screw(SEED), Motion::Sine, World::Faithful);
    assert!(!stands_on_counts(&found));
}
