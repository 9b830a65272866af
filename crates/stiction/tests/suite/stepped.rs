//! A law that is run by itself: in real time and along a record.

use stiction_parameters::ParameterSet;
use stiction_parameters::{FrictionLaw, LawKind};
use stiction_workflows::{SteppedLaw, forces_along};

/// Every family with one set of numbers.
fn laws() -> Vec<FrictionLaw> {
    let kinds = LawKind::ALL.into_iter();
    let law = |kind: LawKind| {
        let values = [
            ("sigma0", 1.2e5),
            ("sigma1", 300.0),
            ("sigma2", 60.0),
            ("coulomb", 20.0),
            ("static", 30.0),
            ("stribeck_velocity", 5e-3),
            ("breakaway_ratio", 0.7),
            ("attraction", 1e3),
            ("stiffness_1", 2e5),
            ("yield_1", 4e-5),
            ("stiffness_2", 5e4),
            ("yield_2", 2.4e-4),
            ("offset", -1.0),
        ];
        ParameterSet::from_text(kind, values).law().ok()
    };
    kinds.filter_map(law).collect()
}

#[test]
fn at_constant_velocity_both_end_at_the_steady_force() {
    let laws = laws();
    assert!(laws.len() >= 4, "{}", laws.len());
    for law in laws {
        let steady = law
            .curve()
            .map_or(20.0 + 6.0 - 1.0, |curve| curve.force(0.1));
        let mut stepped = SteppedLaw::new(law.clone());
        for _ in 0..8000 {
            stepped.step(250e-6, 0.1);
        }
        assert!(
            (stepped.force() - steady).abs() < 1e-6,
            "{law:?}: {}",
            stepped.force()
        );
        let time: Vec<f64> = (0..8000).map(|k| 250e-6 * f64::from(k)).collect();
        let along = forces_along(&law, &time, &[0.1; 8000]).unwrap();
        assert!(
            (along[7999] - steady).abs() < 1e-6,
            "{law:?}: {}",
            along[7999]
        );
        // What is no number changes nothing; a reset is the beginning.
        let before = stepped.state();
        assert_eq!(stepped.step(250e-6, f64::NAN), stepped.force());
        assert_eq!(stepped.state(), before);
        stepped.reset();
        assert!(stepped.state().iter().all(|z| *z == 0.0));
    }
}

#[test]
fn a_record_that_is_none_is_refused() {
    let law = laws().pop().unwrap();
    for (time, velocity) in [
        (vec![0.0, 1.0], vec![0.0]),
        (vec![0.0, 0.0], vec![0.0, 0.0]),
        (vec![1.0, 0.0], vec![0.0, 0.0]),
        (vec![0.0, f64::NAN], vec![0.0, 0.0]),
        (vec![0.0, 1.0], vec![0.0, f64::INFINITY]),
    ] {
        let refused = forces_along(&law, &time, &velocity).unwrap_err();
        assert_eq!(refused.code().as_str(), "usage");
    }
    assert_eq!(forces_along(&law, &[], &[]).unwrap(), Vec::<f64>::new());
}

/// In the middle of a motion to and fro.
#[test]
fn a_law_goes_on_from_what_it_remembers() {
    for law in laws() {
        let velocity = |k: i32| 0.02 * libm::sin(0.05 * f64::from(k));
        let mut one = SteppedLaw::new(law.clone());
        for k in 0..90 {
            one.step(1e-3, velocity(k));
        }
        let mut other = SteppedLaw::new(law.clone());
        assert!(other.recall(&one.memory()));
        assert!(!other.recall(&[]));
        for k in 90..300 {
            let force = one.step(1e-3, velocity(k));
            assert_eq!(force, other.step(1e-3, velocity(k)), "{law:?}");
        }
    }
}
