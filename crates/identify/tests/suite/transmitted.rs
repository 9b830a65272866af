//! Friction in proportion to what a gear transmits, on joints that `stiction_testkit::geared` simulates.

use crate::common::chance::neither_too_narrow_nor_too_wide;
use stiction_identify::{
    Conditioning, Cutoff, Delay, Dependence, Error, Estimate, Law, LawKind, Objective, Record,
    Samples, Settings, Silent, Terms, Transmitted, condition, identify, predict, separable,
};
use stiction_testkit::geared::{Geared, Proportion, Recording};

const SECONDS: f64 = 24.0;

/// What identification takes of a recording; `known` adds what the load asked for as a torque from outside.
fn samples(recording: &Recording, known: bool) -> Samples {
    let external: Vec<f64> = match known {
        true => recording.load.iter().map(|load| -load).collect(),
        false => recording.external.clone(),
    };
    let force = recording.torque.iter().zip(&external).map(|(u, e)| u + e);
    Samples {
        time: recording.time.clone(),
        position: Some(recording.position.clone()),
        force: force.collect(),
        external: external.iter().any(|x| *x != 0.0).then_some(external),
        ..Samples::default()
    }
}

fn record(samples: Samples, bristle: bool) -> Record {
    let conditioning = Conditioning {
        source_cutoff: Cutoff::Hz(100.0),
        common_cutoff: Cutoff::Hz(60.0),
        min_speed: if bristle { 0.0 } else { 0.1 },
        ..Conditioning::default()
    };
    condition(&[samples], &conditioning).unwrap()
}

fn dependences() -> [Dependence; 2] {
    let open = Transmitted::default();
    [
        Dependence::CoulombTransmitted(open),
        Dependence::CoulombDriven(open),
    ]
}

/// A weight that is fitted, and these dependences.
fn terms(dependences: &[Dependence]) -> Terms {
    Terms {
        gravity: true,
        delay: Delay::Fitted,
        dependences: dependences.to_vec(),
        ..Terms::default()
    }
}

fn fit(record: &Record, law: Law, terms: &Terms) -> Estimate {
    let terms = terms.about(record);
    identify(record, law, &terms, 0.0, &Settings::default(), &mut Silent).unwrap()
}

/// Relative error of a law on a recording that it was not fitted to.
fn held_out(fitted: &Estimate, record: &Record) -> f64 {
    let series = predict(record, fitted);
    let square = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
    let left = series.residual();
    (square(&left) / square(&series.measured)).sqrt()
}

/// The joint that a law describes.
fn joint(kind: LawKind) -> Geared {
    let ratio = if kind.has_stribeck() { 1.5 } else { 1.0 };
    Geared {
        stribeck: (ratio, 0.3),
        bristle: kind.has_bristle().then_some((400.0, 0.3)),
        ..Geared::default()
    }
}

const LAWS: [LawKind; 3] = [LawKind::CoulombViscous, LawKind::Stribeck, LawKind::LuGre];

/// What an estimate should have found.
fn truth(geared: &Geared, found: &Estimate) -> Vec<(&'static str, f64)> {
    let [driving, driven] = geared.per_torque;
    let reference = found.value("transmitted_reference").unwrap();
    let mut truth = vec![
        ("coulomb", geared.coulomb + driving * reference),
        ("coulomb_transmitted", driving),
    ];
    match found.terms.gravity {
        true => truth.extend([
            ("gravity_sin", geared.weight[0]),
            ("gravity_cos", geared.weight[1]),
        ]),
        false => truth.push(("coulomb_driven", driven - driving)),
    }
    truth
}

/// How many intervals hold the truth, of how many.
fn inside(geared: &Geared, found: &Estimate) -> (usize, usize) {
    let truth = truth(geared, found);
    let holds = |(name, truth): &(&str, f64)| {
        let parameter = found.parameter(*name).unwrap();
        assert!(parameter.identifiable, "{name}: {}", parameter.reason);
        let (low, high) = parameter.ci95.unwrap();
        assert!(
            (parameter.value - truth).abs() < 0.02 * truth.abs().max(0.1),
            "{name}: {}",
            parameter.value
        );
        low <= *truth && *truth <= high
    };
    (truth.iter().filter(|of| holds(of)).count(), truth.len())
}

#[test]
fn beside_a_weight_that_is_fitted_the_intervals_hold_the_truth() {
    let (mut hits, mut all) = (0, 0);
    for kind in LAWS {
        let geared = joint(kind);
        for seed in 1..4 {
            let record = record(
                samples(&geared.record(SECONDS, seed), false),
                kind.has_bristle(),
            );
            let found = fit(&record, Law::new(kind), &terms(&dependences()[..1]));
            let (own, of) = inside(&geared, &found);
            (hits, all) = (hits + own, all + of);
        }
    }
    neither_too_narrow_nor_too_wide("a weight that is fitted", hits, all);
}

/// Where the weight is known, driving and being driven are told apart.
#[test]
fn beside_a_weight_that_is_known_both_directions_of_the_torque_are_found() {
    let (mut hits, mut all) = (0, 0);
    for kind in LAWS {
        let geared = Geared {
            per_torque: [0.15, 0.08],
            external: 1.0,
            ..joint(kind)
        };
        for seed in 1..3 {
            let record = record(
                samples(&geared.record(SECONDS, seed), true),
                kind.has_bristle(),
            );
            let known = Terms {
                gravity: false,
                ..terms(&dependences())
            };
            let found = fit(&record, Law::new(kind), &known);
            let (own, of) = inside(&geared, &found);
            (hits, all) = (hits + own, all + of);
        }
    }
    neither_too_narrow_nor_too_wide("a weight that is known", hits, all);
}

/// A weight that is fitted and a torque from outside that is known add up.
#[test]
fn a_weight_and_a_torque_from_outside_are_transmitted_together() {
    let geared = Geared {
        external: 2.0,
        ..joint(LawKind::CoulombViscous)
    };
    let record = record(samples(&geared.record(SECONDS, 5), false), false);
    let law = Law::new(LawKind::CoulombViscous);
    let found = fit(&record, law, &terms(&dependences()[..1]));
    let (hits, all) = inside(&geared, &found);
    neither_too_narrow_nor_too_wide("both", hits, all);
    // The shape that is assumed is that which is fitted.
    let of = found.terms.transmitted().unwrap();
    for (assumed, name) in [(of.sine, "gravity_sin"), (of.cosine, "gravity_cos")] {
        let fitted = found.value(name).unwrap();
        assert!(
            (assumed / fitted - 1.0).abs() < 1e-5,
            "{assumed} for {fitted}"
        );
    }
}

#[test]
fn of_a_weight_that_is_fitted_what_the_load_drives_is_left_open() {
    let geared = joint(LawKind::CoulombViscous);
    let record = record(samples(&geared.record(SECONDS, 1), false), false);
    let found = fit(
        &record,
        Law::new(LawKind::CoulombViscous),
        &terms(&dependences()),
    );
    let driven = found.parameter("coulomb_driven").unwrap();
    assert!(!driven.identifiable);
    assert!(
        driven.advice.contains("[columns] external"),
        "{}",
        driven.advice
    );
}

/// A weight that is only lifted looks like less of it with more friction.
#[test]
fn of_a_weight_that_is_only_lifted_nothing_is_claimed() {
    let geared = joint(LawKind::CoulombViscous);
    let mut recording = geared.record(SECONDS, 1);
    // The longest way up to one side.
    let up = |i: &usize| {
        let step = recording.position[i + 100] - recording.position[*i];
        step > 5e-3 && recording.load[*i] > 0.0
    };
    let ways: Vec<bool> = (0..recording.time.len() - 100).map(|i| up(&i)).collect();
    let (mut best, mut from) = (0..0, 0);
    for (i, on) in ways.iter().enumerate() {
        if !on {
            from = i + 1;
        } else if i - from > best.len() {
            best = from..i;
        }
    }
    for column in [
        &mut recording.time,
        &mut recording.position,
        &mut recording.torque,
        &mut recording.external,
    ] {
        *column = column[best.clone()].to_vec();
    }
    let record = record(samples(&recording, false), false);
    let found = fit(
        &record,
        Law::new(LawKind::CoulombViscous),
        &terms(&dependences()[..1]),
    );
    let part = found.parameter("coulomb_transmitted").unwrap();
    assert!(!part.identifiable, "{part:?}");
}

/// On another motion the error is a small part of that of the same law without: also where the joint is that of the published
/// law, whose level follows both torques.
#[test]
fn another_motion_is_predicted_better() {
    for (proportion, less) in [(Proportion::Load, 0.1), (Proportion::Published, 0.2)] {
        for kind in LAWS {
            let geared = Geared {
                proportion,
                ..joint(kind)
            };
            let [one, other] = [1, 2].map(|seed| {
                record(
                    samples(&geared.record(SECONDS, seed), false),
                    kind.has_bristle(),
                )
            });
            let law = Law::new(kind);
            let with = held_out(&fit(&one, law, &terms(&dependences()[..1])), &other);
            let without = held_out(&fit(&one, law, &terms(&[])), &other);
            println!("{kind:?} {proportion:?}: {with:.4} with, {without:.4} without");
            assert!(with < less * without, "{kind:?}: {with} for {without}");
        }
    }
}

#[test]
fn where_friction_does_not_grow_nothing_is_found() {
    let geared = Geared {
        per_torque: [0.0; 2],
        ..joint(LawKind::CoulombViscous)
    };
    let [one, other] =
        [1, 2].map(|seed| record(samples(&geared.record(SECONDS, seed), false), false));
    let law = Law::new(LawKind::CoulombViscous);
    let with = fit(&one, law, &terms(&dependences()[..1]));
    let (low, high) = with.parameter("coulomb_transmitted").unwrap().ci95.unwrap();
    assert!(low < 0.0 && 0.0 < high && high - low < 2e-3, "{low} {high}");
    let without = fit(&one, law, &terms(&[]));
    let gain = held_out(&without, &other) / held_out(&with, &other);
    assert!((gain - 1.0).abs() < 0.01, "{gain}");
}

/// The sensitivities of a cost whose level depends on the sign of the deflection, against central differences.
#[test]
fn the_gradient_is_that_of_the_cost() {
    let geared = Geared {
        per_torque: [0.15, 0.08],
        ..joint(LawKind::LuGre)
    };
    let record = record(samples(&geared.record(4.0, 1), true), true);
    let known = Terms {
        gravity: false,
        delay: Delay::NONE,
        ..terms(&dependences())
    };
    let objective = Objective::new(&record, Law::new(LawKind::LuGre), &known.about(&record));
    let p = [6.2, -0.6, -1.3];
    let at = objective.evaluate(&p, true);
    for (i, column) in at.jacobian().iter().take(p.len()).enumerate() {
        let step = 1e-5;
        let cost = |by: f64| {
            let mut p = p;
            p[i] += by;
            objective.evaluate(&p, false).cost
        };
        let by_differences = (cost(step) - cost(-step)) / (2.0 * step);
        let product: f64 = column.iter().zip(at.residual()).map(|(j, r)| j * r).sum();
        assert!(
            (by_differences / (-2.0 * product) - 1.0).abs() < 1e-4,
            "{i}: {by_differences} {product}"
        );
    }
}

#[test]
fn without_a_torque_that_is_known_or_fitted_it_is_refused() {
    let geared = joint(LawKind::CoulombViscous);
    let record = record(samples(&geared.record(4.0, 1), false), false);
    let bare = Terms {
        gravity: false,
        ..terms(&dependences())
    };
    let found = separable(
        &record,
        Law::new(LawKind::CoulombViscous),
        &bare,
        &Settings::default(),
        &mut Silent,
    );
    assert_eq!(
        found.unwrap_err(),
        Error::MissingChannel {
            log: 1,
            channel: "external",
            term: "coulomb_transmitted",
        }
    );
}
