//! A law that is run by itself: in real time and along a record.

use stiction_parameters::{FrictionLaw, LawKind, ParameterSet, Quantity};
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
        let along = forces_along(&law.clone().into(), &time, &[0.1; 8000]).unwrap();
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
    let law = laws().pop().unwrap().into();
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

/// Force per squared speed, of each direction: 20 N + 60 N s/m v - 30 N s^2/m^2 v^2 forward, + 50 N s^2/m^2 back.
#[test]
fn quadratic_viscous_friction_is_part_of_a_law() {
    let (fc, fs) = ((Quantity::Coulomb, 20.0), (Quantity::Static, 30.0));
    let lugre = [
        (Quantity::Sigma0, 1e5),
        (Quantity::Sigma1, 0.0),
        fs,
        (Quantity::StribeckVelocity, 1e-3),
    ];
    let viscous = (Quantity::Sigma2, 60.0);
    let both = [
        ("quadratic_viscous_pos", -30.0),
        ("quadratic_viscous_neg", 50.0),
    ];
    for (kind, more) in [(LawKind::LuGre, &lugre[..]), (LawKind::CoulombViscous, &[])] {
        let always = [fc, viscous];
        let own = always
            .iter()
            .chain(more)
            .map(|&(quantity, value)| (stiction::Name::from(quantity), value));
        let both = both.map(|(name, value)| (name.parse().unwrap(), value));
        let none = own.clone().chain(both.map(|(name, _)| (name, f64::NAN)));
        assert!(stiction::Law::new(kind, none).is_err());
        let law = stiction::Law::new(kind, own.chain(both)).unwrap();
        for (v, force) in [(0.5, 20.0 + 30.0 - 7.5), (-0.5, -20.0 - 30.0 - 12.5)] {
            assert!(
                (law.steady(v) - force).abs() < 1e-9,
                "{kind}: {}",
                law.steady(v)
            );
            let mut stepped = law.stepped();
            for _ in 0..400 {
                stepped.step(1e-3, v);
            }
            assert!(
                (stepped.force() - force).abs() < 1e-9,
                "{kind}: {}",
                stepped.force()
            );
            assert_eq!(stepped.step(1e-3, f64::NAN), stepped.force());
            let time: Vec<f64> = (0..400).map(|k| 1e-3 * f64::from(k)).collect();
            let along = law.along(&time, &[v; 400]).unwrap();
            assert!((along[399] - force).abs() < 1e-9, "{kind}: {}", along[399]);
        }
    }
}
