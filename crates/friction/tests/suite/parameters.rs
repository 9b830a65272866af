//! What a law refuses to be built with, and what it says then.

use crate::common::direction;
use stiction_friction::{CoulombViscous, Dahl, Damping, LuGre, Shape, Stribeck, TanhRegularised};

#[test]
fn every_parameter_is_named_when_out_of_range() {
    let good = direction(20.0, 30.0, 5e-3, 60.0);
    let name = |fc, fs, vs, s2| {
        Stribeck::symmetric(Shape::Gaussian, direction(fc, fs, vs, s2), 0.0)
            .unwrap_err()
            .name
    };
    assert_eq!(name(0.0, 30.0, 5e-3, 60.0), "coulomb");
    assert_eq!(name(f64::NAN, 30.0, 5e-3, 60.0), "coulomb");
    assert_eq!(name(20.0, 19.9, 5e-3, 60.0), "static");
    assert_eq!(name(20.0, f64::INFINITY, 5e-3, 60.0), "static");
    assert_eq!(name(20.0, 30.0, 0.0, 60.0), "stribeck_velocity");
    assert_eq!(name(20.0, 30.0, 5e-3, -1.0), "sigma2");

    let bad = direction(20.0, 30.0, -5e-3, 60.0);
    let error = Stribeck::new(Shape::Gaussian, good, bad, 0.0).unwrap_err();
    assert_eq!(
        error.to_string(),
        "stribeck_velocity_neg = -0.005; allowed: finite and > 0"
    );
    let error = Stribeck::symmetric(Shape::Power(0.0), good, 0.0).unwrap_err();
    assert_eq!(error.name, "stribeck_exponent");
    let error = Stribeck::symmetric(Shape::Gaussian, good, f64::NAN).unwrap_err();
    assert_eq!(error.name, "offset");

    let curve = Stribeck::symmetric(Shape::Gaussian, good, 0.0).unwrap();
    let lugre = |s0, d| LuGre::new(s0, d, curve).unwrap_err().name;
    assert_eq!(lugre(-1.0, Damping::Constant(1.0)), "sigma0");
    assert_eq!(
        lugre(1e-308, Damping::Constant(1.0)),
        "sigma0",
        "deflection beyond the number type"
    );
    assert_eq!(lugre(1e5, Damping::Capped(-1.0)), "sigma1");
    assert_eq!(
        lugre(
            1e5,
            Damping::Olsson {
                sigma1: 1.0,
                velocity: 0.0
            }
        ),
        "damping_velocity"
    );

    assert_eq!(
        TanhRegularised::new(curve, 0.0).unwrap_err().name,
        "regularisation_velocity"
    );
    assert_eq!(
        Dahl::new(1e5, [1.0, 0.0], 0.0).unwrap_err().name,
        "coulomb_neg"
    );
    assert_eq!(
        CoulombViscous::new([1.0, 1.0], [0.0, -2.0], 0.0)
            .unwrap_err()
            .name,
        "sigma2_neg"
    );
    assert!(
        CoulombViscous::symmetric(0.0, 0.0, 0.0).is_ok(),
        "no friction is a law too"
    );
}

/// Every bit pattern either builds a law or is refused: nothing panics, nothing odd gets through.
#[test]
fn odd_numbers_are_refused_or_work() {
    let odd = [
        0.0,
        -0.0,
        5e-324,
        1e-300,
        1.0,
        1e300,
        f64::MAX,
        f64::INFINITY,
        f64::NAN,
        -1.0,
    ];
    for fc in odd {
        for fs in odd {
            for vs in odd {
                for s0 in odd {
                    let side = direction(fc, fs, vs, 1.0);
                    let Ok(curve) = Stribeck::symmetric(Shape::Gaussian, side, 0.0) else {
                        continue;
                    };
                    let Ok(law) = LuGre::new(s0, Damping::Capped(1.0), curve) else {
                        continue;
                    };
                    for v in [1e-300, 1e-3, 1e300] {
                        let z = law.step_record(0.0, 1e-3, 0.0, v);
                        assert!(
                            z.abs() <= law.bound() * (1.0 + 1e-12),
                            "{fc} {fs} {vs} {s0} {v}: {z}"
                        );
                        let mut state = law.rest();
                        assert!(law.step(&mut state, 1e-3, v).is_finite());
                    }
                }
            }
        }
    }
}

/// Dahl's law at constant speed: F = Fc (1 - exp(-sigma0 x/Fc)) in the path x, worked out by hand.
#[test]
fn dahl_loads_exponentially_in_the_path() {
    let dahl = Dahl::new(1e6, [20.0, 18.0], 0.0).unwrap();
    let mut z = 0.0;
    for _ in 0..200 {
        z = dahl.law().step_record(z, 1e-3, 1e-4, 1e-4); // 20 um in all
    }
    let expected = 20.0 * (1.0 - (-1.0_f64).exp());
    assert!((dahl.law().force(z, 1e-4) / expected - 1.0).abs() < 1e-12);
}

/// The tanh form meets its curve at speed and is smooth through zero.
#[test]
fn tanh_form_meets_its_curve() {
    let curve =
        Stribeck::symmetric(Shape::Exponential, direction(20.0, 30.0, 5e-3, 60.0), 1.0).unwrap();
    let smooth = TanhRegularised::new(curve, 1e-4).unwrap();
    for v in [-0.1, -3e-3, 3e-3, 0.1] {
        assert!((smooth.force(v) - curve.force(v)).abs() < 1e-12 * 30.0);
    }
    assert!((smooth.force(1e-9) - 1.0 - 30.0 * 1e-5).abs() < 1e-6);
}
