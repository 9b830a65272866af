//! What cannot be simulated, and numbers that no machine has.

use super::stopped::Short;
use super::*;

#[test]
fn what_cannot_be_simulated_is_refused() {
    let law = Law::new(LawKind::LuGre);
    let try_with = |log: Recording, terms: &Terms, simulation: &Simulation| {
        output_error(&[log], law, terms, simulation, &mut Silent).unwrap_err()
    };
    let good = open(1.0, 0.0, 0.0, 0.0, 1);
    let with = Simulation {
        controller: Some(controller(&CASCADE)),
        ..Simulation::default()
    };
    let e = try_with(good.clone(), &Terms::default(), &with);
    assert!(e.to_string().contains("no reference"), "{e}");
    let absent = Terms {
        mass: Mass::Absent,
        ..Terms::default()
    };
    let e = try_with(good.clone(), &absent, &Simulation::default());
    assert!(matches!(e, Error::NotSimulated { .. }), "{e}");
    let mut blind = good.clone();
    blind.samples.velocity = blind.samples.position.take();
    let e = try_with(blind, &Terms::default(), &Simulation::default());
    assert!(e.to_string().contains("no position"), "{e}");
    let mut still = good.clone();
    still.samples.position = Some(vec![0.25; still.samples.time.len()]);
    let e = try_with(still, &Terms::default(), &Simulation::default());
    assert!(matches!(e, Error::NoMotion { .. }), "{e}");
    let mut loose = good.clone();
    loose.samples.force.fill(0.0);
    let e = try_with(loose, &Terms::default(), &Simulation::default());
    assert!(matches!(e, Error::NoForce { .. }), "{e}");
    let mut short = good;
    short.reference = Some(vec![0.0; 3]);
    let e = try_with(short.clone(), &Terms::default(), &with);
    assert!(
        matches!(
            e,
            Error::Length {
                channel: "reference",
                ..
            }
        ),
        "{e}"
    );
    short.reference = Some(vec![0.0; short.samples.time.len()]);
    for (name, bad) in [
        (
            "rate",
            Controller {
                rate: Some(1234.5),
                ..controller(&CASCADE)
            },
        ),
        (
            "gain",
            Controller {
                speed_gain: f64::NAN,
                ..controller(&CASCADE)
            },
        ),
        (
            "limit",
            Controller {
                force_limit: 0.0,
                ..controller(&CASCADE)
            },
        ),
    ] {
        let simulation = Simulation {
            controller: Some(bad),
            hold: Hold::Held,
            ..Simulation::default()
        };
        let e = try_with(short.clone(), &Terms::default(), &simulation);
        assert!(matches!(e, Error::Setting { .. }), "{name}: {e}");
    }
}

/// Numbers at the ends of their range, few samples, absurd rates: an error or a result, never a panic.
#[test]
fn hostile_numbers_are_survived() {
    let law = Law::new(LawKind::LuGre).asymmetric();
    let base = open(0.4, 0.0, 0.0, 0.0, 1);
    let scales = [1e-300, 1e-150, 1e-9, 1.0, 1e9, 1e150, 1e300];
    let mut refused = 0;
    for x in scales {
        for u in scales {
            for t in [1e-12, 1.0, 1e12] {
                let mut log = base.clone();
                let scaled = |v: &mut Vec<f64>, k: f64| v.iter_mut().for_each(|v| *v *= k);
                scaled(log.samples.position.as_mut().unwrap(), x);
                scaled(&mut log.samples.force, u);
                scaled(&mut log.samples.time, t);
                log.samples.position.as_mut().unwrap().truncate(150);
                log.samples.force.truncate(150);
                log.samples.time.truncate(150);
                log.reference = log.samples.position.clone();
                let simulation = Simulation {
                    controller: (x > u).then(|| controller(&CASCADE)),
                    ..Simulation::default()
                };
                let found =
                    output_error(&[log], law, &Terms::default(), &simulation, &mut Short(40));
                match found {
                    Ok(found) => assert!(!found.fitted.parameters.is_empty()),
                    Err(_) => refused += 1,
                }
            }
        }
    }
    println!("{refused} refused");
    for n in 0..30 {
        let mut log = base.clone();
        log.samples.position.as_mut().unwrap().truncate(n);
        log.samples.force.truncate(n);
        log.samples.time.truncate(n);
        let e = output_error(
            &[log],
            law,
            &Terms::default(),
            &Simulation::default(),
            &mut Silent,
        );
        assert!(matches!(e, Err(Error::TooFewSamples { .. })), "{n}");
    }
    let none = output_error(
        &[],
        law,
        &Terms::default(),
        &Simulation::default(),
        &mut Silent,
    );
    assert!(matches!(none, Err(Error::TooFewSamples { .. })));
}

/// Gains that are not those of the drive: no axis follows under them, and that is said instead of numbers.
#[test]
fn a_controller_that_is_not_stable_is_refused() {
    let wild = Controller {
        position_gain: 1e15,
        force_limit: f64::INFINITY,
        ..controller(&CASCADE)
    };
    let simulation = Simulation {
        controller: Some(wild),
        ..Simulation::default()
    };
    let log = closed(&CASCADE, 0.5, 0.0, 0.0, 1);
    let law = Law::new(LawKind::LuGre);
    let refused = output_error(&[log], law, &Terms::default(), &simulation, &mut Silent);
    let e = refused.unwrap_err();
    let Error::Diverged { log, time, .. } = e else {
        panic!("{e}");
    };
    assert!(log == 1 && (0.0..0.1).contains(&time), "{e}");
    assert!(
        e.to_string().contains("position_gain 1000000000000000 1/s"),
        "{e}"
    );
}
