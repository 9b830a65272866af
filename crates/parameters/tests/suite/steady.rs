//! Friction at constant velocity, against the laws and against differences.

use stiction_parameters::{FrictionLaw, LawKind, Name, ParameterSet, Quantity, SteadyCurve};

fn set(kind: LawKind, values: &[(&str, f64)]) -> ParameterSet {
    ParameterSet::from_text(kind, values.iter().copied())
}

const SPEEDS: [f64; 6] = [1e-6, 1e-3, -4e-3, 5e-3, 0.05, -0.4];

fn stribeck(exponent: f64) -> ParameterSet {
    set(
        LawKind::Stribeck,
        &[
            ("coulomb_pos", 20.0),
            ("coulomb_neg", 24.0),
            ("static_pos", 30.0),
            ("static_neg", 31.0),
            ("stribeck_velocity", 5e-3),
            ("sigma2_pos", 60.0),
            ("sigma2_neg", 80.0),
            ("stribeck_exponent", exponent),
            ("quadratic_viscous", 3.0),
        ],
    )
}

/// The curve is that of the law, with the quadratic term that no law has.
#[test]
fn it_is_the_curve_of_the_law() {
    for exponent in [0.7, 1.0, 2.0] {
        let set = stribeck(exponent);
        let FrictionLaw::Stribeck(law) = set.law().unwrap() else {
            panic!();
        };
        let curve = SteadyCurve::of(&set);
        for v in SPEEDS {
            let wanted = law.force(v) + 3.0 * v * v.abs();
            assert!((curve.force(v) - wanted).abs() < 1e-13 * wanted.abs());
        }
    }
    let plain = set(
        LawKind::CoulombViscous,
        &[("coulomb", 20.0), ("sigma2", 60.0)],
    );
    for v in SPEEDS {
        let wanted = 20.0 * v.signum() + 60.0 * v;
        assert_eq!(SteadyCurve::of(&plain).force(v), wanted);
    }
}

#[test]
fn slopes_are_those_of_differences() {
    for exponent in [0.7, 1.0, 2.0] {
        let set = stribeck(exponent);
        let names: Vec<(Name, f64)> = set.iter().collect();
        for (name, value) in names {
            for v in SPEEDS {
                // Beside 1 and 2 the exponent is a power, at them it is not: the derivative has to be the same.
                let step = 1e-5 * value;
                let at = |x: f64| {
                    let mut set = set.clone();
                    set.insert(name, x);
                    SteadyCurve::of(&set).force(v)
                };
                let numeric = (at(value + step) - at(value - step)) / (2.0 * step);
                let slope = SteadyCurve::of(&set).slope(name, v);
                let size = 30.0 / value;
                assert!(
                    (slope - numeric).abs() < 1e-7 * size,
                    "{name} {exponent} {v}: {slope} {numeric}"
                );
            }
        }
        let curve = SteadyCurve::of(&set);
        assert_eq!(curve.slope(Quantity::Mass.into(), 0.1), 0.0);
        assert_eq!(curve.slope("sigma2_neg".parse().unwrap(), 0.1), 0.0);
    }
}

/// What a law refuses is drawn all the same: a level of 0, and a static level below the Coulomb level.
#[test]
fn any_numbers_have_a_curve() {
    let nothing = set(LawKind::Stribeck, &[]);
    assert_eq!(SteadyCurve::of(&nothing).force(0.1), 0.0);
    let odd = set(
        LawKind::Stribeck,
        &[
            ("coulomb", 20.0),
            ("static", 18.0),
            ("stribeck_velocity", 1e-3),
        ],
    );
    assert!(odd.law().is_err());
    assert!((SteadyCurve::of(&odd).force(1e-9) - 18.0).abs() < 1e-9);
    let flat = set(LawKind::MaxwellSlip, &[("coulomb", 20.0)]);
    let curve = SteadyCurve::of(&flat);
    assert_eq!(curve.force(-1e-3), -20.0);
    assert_eq!(curve.slope(Quantity::Coulomb.into(), -1e-3), -1.0);
}
