//! Runs that were not fitted, and what their error and their motion are.

use super::*;

#[test]
#[ignore = "soak: of a simpler law beside it"]
fn an_unseen_run_is_predicted_to_a_count() {
    let simulation = Simulation {
        quantum: Some(1e-6),
        ..Simulation::default()
    };
    let found = fit(&[open(4.0, 0.0, 1e-6, 0.0, 1)], &simulation);
    let unseen = simulate_unseen(&[open(3.0, 1.1, 1e-6, 0.0, 2)], &found, &mut Silent).unwrap();
    // Pieces that begin while the axis slides find their starts as well.
    let short = unseen.short.unwrap().position;
    assert!(short.rmse < 1e-6, "{short:?}");
    // A bristle that lets go a little early moves the whole slip that follows; still below one count.
    assert!(unseen.position.rmse < 1e-6, "{:?}", unseen.position);
    assert!(
        found.position.rmse < 1.02 * found.floor.unwrap(),
        "{:?}",
        found.position
    );
    assert!(unseen.force.is_none());
}

/// However short the pieces of the fit were, what was not fitted runs whole: position and velocity go on from sample to
/// sample without a jump.
#[test]
fn an_unseen_run_is_never_restarted() {
    let fitted = open(2.0, 0.0, 1e-6, 0.0, 1);
    let unseen = open(3.0, 1.1, 1e-6, 0.0, 2);
    let law = Law::new(LawKind::CoulombViscous);
    for segment in gate(1, [Some(0.5), Some(0.25), None]) {
        let simulation = Simulation {
            segment,
            quantum: Some(1e-6),
            ..Simulation::default()
        };
        let terms = Terms::default();
        let logs = std::slice::from_ref(&fitted);
        let found = output_error(logs, law, &terms, &simulation, &mut Silent).unwrap();
        let pieces = segment.map_or(1, |s| (2.0 / s) as usize);
        assert_eq!((found.runs, found.stretches), (pieces, 1));
        assert_eq!((found.starts(), found.segment()), (3 * pieces, segment));
        assert_eq!(found.whole.is_some(), segment.is_some());
        let seen = simulate_unseen(std::slice::from_ref(&unseen), &found, &mut Silent).unwrap();
        assert_eq!(seen.runs, 1);
        let (x, v) = (&seen.signals.simulated, &seen.signals.velocity);
        for k in 1..x.len() {
            let jump = x[k] - x[k - 1] - 0.5e-3 * (v[k] + v[k - 1]);
            assert!(jump.abs() < 2e-5, "{segment:?} {k}: {jump}");
        }
        // The error over a short horizon is named as such, and has less time to grow.
        let short = seen.short.unwrap();
        assert_eq!(short.seconds, segment.unwrap_or(1.0));
        assert!(short.position.rmse < seen.position.rmse, "{seen:?}");
    }
}

#[test]
fn two_stretches_with_a_gap_between_them_are_two_runs() {
    let fitted = open(2.0, 0.0, 1e-6, 0.0, 1);
    let mut gap = open(3.0, 1.1, 1e-6, 0.0, 2);
    for t in &mut gap.samples.time[1500..] {
        *t += 1.0;
    }
    let law = Law::new(LawKind::CoulombViscous);
    let (terms, simulation) = (Terms::default(), Simulation::default());
    let found = output_error(&[fitted], law, &terms, &simulation, &mut Silent).unwrap();
    let seen = simulate_unseen(&[gap], &found, &mut Silent).unwrap();
    assert_eq!(seen.runs, 2);
}

/// The error is against the motion, wherever the encoder has its origin.
#[test]
fn the_origin_of_the_encoder_does_not_matter() {
    let near = open(1.0, 0.0, 1e-6, 0.0, 1);
    let mut far = near.clone();
    for x in far.samples.position.as_mut().unwrap() {
        *x += 10.0;
    }
    let simulation = Simulation::default();
    let [near, far] = [near, far].map(|log| {
        let law = Law::new(LawKind::CoulombViscous);
        output_error(&[log], law, &Terms::default(), &simulation, &mut Silent).unwrap()
    });
    let [a, b] = [&near, &far].map(|found| found.position.relative_error_percent);
    assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
    // R2 is about the mean as well.
    let r2 = 1.0 - (a / 100.0) * (a / 100.0);
    assert!((near.position.r2 - r2).abs() < 1e-9, "{:?}", near.position);
}

/// Presliding of two counts on top of a rise of six: the encoder shows motion in one direction only.
#[test]
fn presliding_of_a_few_counts_goes_both_ways() {
    let plant = machine();
    let mut motion = Motion::default();
    let mut samples = Samples::default();
    let mut position = Vec::new();
    for k in 0..2000 {
        let t = f64::from(k) * 1e-3;
        let force = 2.0 + 12.0 * (5.0 * t).min(1.0) + 1.0 * (30.0 * t).sin();
        samples.time.push(t);
        samples.force.push(force);
        position.push(2e-5 * (motion.position / 2e-5).round());
        for _ in 0..FINE {
            motion = plant
                .step(motion, 1e-3 / FINE as f64, Load::force(force))
                .motion;
        }
    }
    samples.position = Some(position);
    let log = Recording {
        samples,
        reference: None,
    };
    let simulation = Simulation {
        quantum: Some(2e-5),
        ..Simulation::default()
    };
    let law = Law::new(LawKind::Dahl);
    let terms = Terms {
        mass: Mass::Given(MASS),
        ..Terms::default()
    };
    let found = output_error(&[log], law, &terms, &simulation, &mut Silent).unwrap();
    assert!(
        found.position.rmse < 1.5 * found.floor.unwrap(),
        "{:?}",
        found.position
    );
    assert!(found.signals.moves_both_ways(Some(2e-5)));
    // The same record beside a simulation that only rises.
    let mut highest = f64::NEG_INFINITY;
    let rise = found.signals.position.iter().map(|x| {
        highest = highest.max(*x);
        highest
    });
    let recorded_only = stiction_identify::Signals {
        simulated: rise.collect(),
        ..found.signals.clone()
    };
    assert!(!recorded_only.moves_both_ways(Some(2e-5)));
}
