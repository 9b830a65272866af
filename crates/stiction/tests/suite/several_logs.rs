//! Several logs of one axis: what is said where they tell the same, and where they do not.

use stiction::{Axis, Code, Column, Fit, Log, Options, identify};
use stiction_testkit::worlds::{Machine, Motion, World, record};

/// What the seed of a second log is more than that of the first.
const LATER: u64 = 1_000_000;

/// Two logs of a joint, the second of them with friction that has risen by a factor.
fn twice(seed: u64, motion: Motion, factor: f64) -> (Fit, [Machine; 2]) {
    let machine = Machine::joint(seed);
    let machines = [machine, machine.with_friction(factor)];
    let axis = Axis::default();
    let logs: Vec<Log> = machines
        .iter()
        .zip([("morning.csv", seed), ("noon.csv", seed + LATER)])
        .map(|(machine, (name, seed))| {
            let log = record(machine, motion, World::Faithful, seed);
            let column = |name: &str, unit: &str, values: Vec<f64>| Column {
                name: name.into(),
                unit: Some(unit.into()),
                values,
            };
            let columns = vec![
                column("time", "s", log.time),
                column("position", "rad", log.position.unwrap()),
                column("torque", "N*m", log.force),
            ];
            Log::from_columns(name, columns, &axis).unwrap()
        })
        .collect();
    let fit = identify(&logs, &axis, &Options::default()).unwrap();
    (fit, machines)
}

fn disagreements(fit: &Fit) -> Vec<&str> {
    let all = fit.warnings().iter();
    all.filter(|w| w.code == Code::LogsDisagree)
        .map(|w| w.message.as_str())
        .collect()
}

/// Names of the parameters of this kind that are listed as constants of the machine.
fn constants(fit: &Fit, kind: &str) -> usize {
    let all = fit.result().trust.constants.iter();
    all.filter(|name| name.starts_with(kind)).count()
}

fn alike(seeds: std::ops::Range<u64>, motion: Motion) {
    let (mut inside, mut stated) = (0, 0);
    for seed in seeds {
        let (fit, [machine, _]) = twice(seed, motion, 1.0);
        assert_eq!(disagreements(&fit), [""; 0], "seed {seed}");
        assert!(constants(&fit, "coulomb") > 0, "seed {seed}");
        for p in fit.parameters().filter(|p| p.is_identifiable()) {
            let base = p.name().trim_end_matches("_pos").trim_end_matches("_neg");
            let truth = machine.truth().into_iter().find(|t| t.0 == base);
            if let (Some((_, truth)), Some((low, high))) = (truth, p.interval()) {
                stated += 1;
                inside += usize::from(low <= truth && truth <= high);
            }
        }
    }
    assert!(10 * inside >= 9 * stated, "{inside} of {stated} inside");
}

#[test]
fn logs_that_tell_the_same_are_not_named() {
    alike(1..4, Motion::Sine);
}

#[test]
#[ignore = "soak: the same for twenty axes"]
fn logs_of_twenty_axes_that_tell_the_same_are_not_named() {
    alike(1..21, Motion::Sine);
}

#[test]
fn a_fifth_between_logs_is_named_and_is_no_constant() {
    for seed in 1..4 {
        let (fit, _) = twice(seed, Motion::Sine, 1.2);
        let named = disagreements(&fit);
        assert!(named.iter().any(|w| w.contains("coulomb")), "{named:?}");
        for kind in ["coulomb", "static"] {
            assert_eq!(constants(&fit, kind), 0, "seed {seed}: {kind}");
        }
    }
    let (fit, _) = twice(1, Motion::Sine, 1.2);
    insta::assert_snapshot!(disagreements(&fit).join("\n"));
}

#[test]
fn a_twentieth_between_logs_is_inside_the_interval_of_the_level() {
    for seed in 1..4 {
        let (fit, machines) = twice(seed, Motion::Sine, 1.05);
        let named = disagreements(&fit);
        assert!(named.iter().any(|w| w.contains("coulomb")), "{named:?}");
        let levels = fit.parameters().filter(|p| p.name().starts_with("coulomb"));
        for p in levels.filter(|p| p.is_identifiable()) {
            let (low, high) = p.interval().unwrap();
            for machine in &machines {
                let inside = low <= machine.coulomb && machine.coulomb <= high;
                assert!(inside, "seed {seed}: {low} {} {high}", machine.coulomb);
            }
        }
    }
}
