//! Several logs of one axis: what is said where they tell the same, and where they do not.

use crate::common::identified::{Fit, identified};
use stiction_codes::Code;
use stiction_files::Axis;
use stiction_files::result::{Action, Origin};
use stiction_testkit::gate;
use stiction_testkit::worlds::{Machine, Motion, World, record};
use stiction_workflows::identify::Options;

/// What the seed of a second log is more than that of the first.
const LATER: u64 = 1_000_000;

/// Two logs of a joint, the second of them with friction that has risen by a factor.
fn twice(seed: u64, motion: Motion, factor: f64) -> (Fit, [Machine; 2]) {
    twice_on(&Axis::default(), seed, motion, factor)
}

/// The same with what an axis file says.
fn twice_on(axis: &Axis, seed: u64, motion: Motion, factor: f64) -> (Fit, [Machine; 2]) {
    let machine = Machine::joint(seed);
    let machines = [machine, machine.with_friction(factor)];
    let logs = [(&machines[0], seed), (&machines[1], seed + LATER)]
        .map(|(machine, seed)| record(machine, motion, World::Faithful, seed));
    let fit = identified(&machine, &logs, axis, &Options::default()).unwrap();
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

/// The table, the verdict and the result say the same of every parameter.
fn open_is_what_is_not_identifiable(fit: &Fit) {
    let result = fit.result();
    let fitted = result
        .parameters
        .iter()
        .filter(|p| p.origin == Origin::Identified);
    let open: Vec<&str> = fitted
        .filter(|p| !p.identifiable)
        .map(|p| p.name.as_str())
        .collect();
    assert_eq!(result.trust.open, open);
}

#[test]
fn logs_that_tell_the_same_are_not_named() {
    let (mut inside, mut stated) = (0, 0);
    for seed in gate(2, 1..21) {
        let (fit, [machine, _]) = twice(seed, Motion::Sine, 1.0);
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
fn a_fifth_between_logs_is_named_and_counted() {
    for seed in gate(1, 1..4) {
        let (fit, machines) = twice(seed, Motion::Sine, 1.2);
        let named = disagreements(&fit);
        assert!(named.iter().any(|w| w.contains("coulomb")), "{named:?}");
        // The interval of another day holds the level of both.
        for p in fit.parameters().filter(|p| p.name().starts_with("coulomb")) {
            let (low, high) = p.interval().unwrap();
            for machine in &machines {
                let inside = low <= machine.coulomb && machine.coulomb <= high;
                assert!(inside, "seed {seed}: {low} {} {high}", machine.coulomb);
            }
        }
    }
    let (fit, _) = twice(1, Motion::Sine, 1.2);
    insta::assert_snapshot!(disagreements(&fit).join("\n"));
}

/// A common level of friction that is half as large as in one log and half as large again as in the other is of neither.
#[test]
fn logs_of_two_axes_are_not_used_as_one() {
    let (fit, _) = twice(1, Motion::Sine, 3.0);
    let trust = &fit.result().trust;
    assert!(!trust.trustworthy && trust.next == Action::FirstLog);
    assert!(trust.reasons[0].contains("coulomb"), "{:?}", trust.reasons);
}

#[test]
fn a_twentieth_between_logs_is_inside_the_interval_of_the_level() {
    for seed in gate(1, 1..4) {
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

/// Each log with levels of its own: nothing is left to disagree, the levels hold those of the logs, and what the logs share is
/// found from both.
#[test]
fn levels_of_each_log_are_found() {
    let file = "[terms]\ncoulomb_log = true\nsigma2_log = true\n";
    let axis: Axis = Axis::parse(file).unwrap();
    let (mut inside, mut stated) = (0, 0);
    for seed in gate(1, 1..4) {
        let (fit, [first, second]) = twice_on(&axis, seed, Motion::Sine, 1.2);
        assert_eq!(disagreements(&fit), [""; 0], "seed {seed}");
        let mut truth = first.truth().to_vec();
        truth.push(("coulomb_log2", second.coulomb - first.coulomb));
        truth.push(("sigma1_log2", second.sigma1 - first.sigma1));
        truth.push(("sigma2_log2", second.sigma2 - first.sigma2));
        for (name, truth) in truth {
            let Some(p) = fit.parameter(name) else {
                continue;
            };
            println!(
                "{seed} {name} {truth} {} {:?} {}",
                p.value(),
                p.interval(),
                p.is_identifiable()
            );
            if let (true, Some((low, high))) = (p.is_identifiable(), p.interval()) {
                stated += 1;
                inside += usize::from(low <= truth && truth <= high);
            }
        }
        assert!(fit.parameter("coulomb_log2").unwrap().is_identifiable());
        open_is_what_is_not_identifiable(&fit);
        let model = stiction_files::ModelFile::from_result(fit.result());
        assert!(model.parameter.iter().all(|p| !p.name.contains("_log")));
    }
    assert!(10 * inside >= 9 * stated, "{inside} of {stated} inside");
}

/// The axis file of several logs is good for each of them too.
#[test]
fn a_level_for_each_log_is_that_of_the_only_one() {
    let axis = Axis::parse("[terms]\ncoulomb_log = true\nsigma2_log = true\n").unwrap();
    let machine = Machine::joint(1);
    let log = record(&machine, Motion::Sine, World::Faithful, 1);
    let options = Options::default();
    let logs = std::slice::from_ref(&log);
    let [with, without] =
        [axis, Axis::default()].map(|axis| identified(&machine, logs, &axis, &options).unwrap());
    assert_eq!(
        format!("{:?}", with.result().parameters),
        format!("{:?}", without.result().parameters)
    );
}

/// A log whose force has the other sign is named, and nothing else is made of it. Of trapezoids the work shows it; of fast motion,
/// which is nearly all inertia, the mass does.
#[test]
fn a_log_with_the_sign_turned_is_named() {
    let cases = [
        (Machine::joint(2).with_friction(0.1), Motion::Sine),
        (Machine::joint(1), Motion::Trapezoid),
    ];
    for (machine, motion) in gate(1, cases) {
        let mut logs = [1, 1 + LATER].map(|seed| record(&machine, motion, World::Faithful, seed));
        let fit = |logs: &[_]| identified(&machine, logs, &Axis::default(), &Options::default());
        let named = |fit: &Fit| -> Vec<String> {
            let all = fit.warnings().iter();
            let all = all.filter(|w| w.code == Code::ForceSign);
            all.map(|w| w.message.clone()).collect()
        };
        assert_eq!(named(&fit(&logs).unwrap()), [""; 0], "{motion:?}");
        logs[1].force.iter_mut().for_each(|force| *force = -*force);
        let fit = fit(&logs).unwrap();
        let [message] = &named(&fit)[..] else {
            panic!("{motion:?}: {:#?}", fit.warnings());
        };
        let says = "the force of log-2.csv has the opposite sign of that of log-1.csv";
        assert!(message.starts_with(says), "{motion:?}: {message}");
        let trust = &fit.result().trust;
        assert!(
            !trust.trustworthy && trust.reasons[0] == *message,
            "{trust:#?}"
        );
        assert!(
            trust.next == Action::FirstLog && trust.cause.is_none(),
            "{trust:#?}"
        );
        assert!(
            trust.better.is_none() && trust.constants.is_empty(),
            "{trust:#?}"
        );
        assert_eq!(disagreements(&fit), [""; 0], "{motion:?}");
    }
}

/// A log too short for any sample of it to be fitted is not passed over: what it holds is compared with nothing.
#[test]
fn a_log_of_which_nothing_is_fitted_is_no_part_of_a_result() {
    let machine = Machine::joint(1);
    let whole = record(&machine, Motion::Commissioning, World::Faithful, 1);
    let mut short = record(&machine, Motion::Commissioning, World::Faithful, 1 + LATER);
    let rows = 150;
    short.time.truncate(rows);
    short.force.truncate(rows);
    if let Some(position) = &mut short.position {
        position.truncate(rows);
    }
    for (k, force) in short.force.iter_mut().enumerate() {
        *force = 100.0 * (k as f64).sin();
    }
    let fit = |logs: &[_]| identified(&machine, logs, &Axis::default(), &Options::default());
    let alone = fit(std::slice::from_ref(&whole)).unwrap();
    assert!(alone.result().trust.trustworthy);
    let both = fit(&[whole, short]).unwrap();
    let trust = &both.result().trust;
    let says = |reason: &String| reason.starts_with("no sample of log-2.csv is fitted");
    assert!(
        !trust.trustworthy && trust.reasons.iter().any(says),
        "{trust:#?}"
    );
}
