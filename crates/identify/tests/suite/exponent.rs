//! The Stribeck exponent as an unknown, against the friction crate.

use crate::common::record;
use crate::common::trials::at_once;
use crate::common::trials::{motion, quantised_law, stepped};
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_identify::{
    Conditioning, Cutoff, Estimate, Law, LawKind, Mass, Objective, Record, Settings, Silent,
    Status, Terms, estimate, intervals, separable,
};

const STEP: f64 = 5e-4;

fn side(coulomb: f64, fixed: f64, velocity: f64, viscous: f64) -> Direction<f64> {
    Direction {
        coulomb,
        static_friction: fixed,
        stribeck_velocity: velocity,
        viscous,
    }
}

fn curve(exponent: f64, asymmetric: bool) -> Stribeck<f64> {
    let pos = side(20.0, 30.0, 5e-3, 60.0);
    let neg = if asymmetric {
        side(24.0, 31.0, 4e-3, 80.0)
    } else {
        pos
    };
    Stribeck::new(Shape::Power(exponent), pos, neg, 0.0).unwrap()
}

fn terms() -> Terms {
    Terms {
        mass: Mass::Absent,
        offset: false,
        ..Terms::default()
    }
}

fn fit(record: &Record, law: Law) -> Estimate {
    let found = separable(record, law, &terms(), &Settings::default(), &mut Silent).unwrap();
    assert_eq!(found.status, Status::Converged, "{law:?}");
    estimate(record, law, &terms(), &found, 1e-3)
}

/// Data of the friction crate without noise give its exponent back, with everything else.
#[test]
fn the_exponent_is_found() {
    let v = motion(8000);
    for (exponent, asymmetric) in [(0.7, false), (1.3, false), (2.0, false), (1.3, true)] {
        let curve = curve(exponent, asymmetric);
        let lugre = LuGre::new(1.2e5, Damping::Constant(600.0), curve).unwrap();
        let data = [
            (
                LawKind::Stribeck,
                v.iter().map(|&v| curve.force(v)).collect(),
            ),
            (LawKind::LuGre, stepped(&lugre, &v)),
        ];
        for (kind, force) in data {
            let mut law = Law::new(kind).with_fitted_exponent();
            law.asymmetric = asymmetric;
            let fitted = fit(&record(STEP, v.clone(), force), law);
            let suffix = if asymmetric { "_pos" } else { "" };
            let mut truth = vec![
                ("stribeck_exponent".to_string(), exponent),
                (format!("static{suffix}"), 30.0),
                (format!("stribeck_velocity{suffix}"), 5e-3),
                (format!("coulomb{suffix}"), 20.0),
            ];
            if kind == LawKind::LuGre {
                truth.push(("sigma0".into(), 1.2e5));
            }
            for (name, truth) in truth {
                let p = fitted.parameter(&name).unwrap();
                let off = (p.value / truth - 1.0).abs();
                assert!(
                    off < 1e-6,
                    "{kind} {exponent} {asymmetric}: {name} = {} instead of {truth}",
                    p.value
                );
                assert!(p.identified && at_once(p).is_some(), "{name}: {}", p.reason);
            }
        }
    }
}

/// The reduced gradient equals central differences of the cost, in every unknown.
#[test]
fn the_gradient_matches_finite_differences() {
    let v = motion(2000);
    let lugre = LuGre::new(1.2e5, Damping::Constant(600.0), curve(1.3, true)).unwrap();
    let record = record(STEP, v.clone(), stepped(&lugre, &v));
    let starts: [(LawKind, bool, &[f64]); 4] = [
        (LawKind::Stribeck, false, &[-0.5, -5.0, 0.1]),
        (LawKind::Stribeck, true, &[-0.5, -5.0, 0.1, -0.8, -4.8, 0.5]),
        (LawKind::LuGre, false, &[8.2, -0.5, -5.0, 0.1]),
        (
            LawKind::LuGre,
            true,
            &[8.2, -0.5, -5.0, 0.1, -0.8, -4.8, 0.5],
        ),
    ];
    for (kind, asymmetric, start) in starts {
        let mut law = Law::new(kind).with_fitted_exponent();
        law.asymmetric = asymmetric;
        assert_eq!(law.nonlinear(), start.len());
        let objective = Objective::new(&record, law, &terms());
        let slope = objective.descent(start);
        for i in 0..start.len() {
            let h = 1e-5;
            let cost = |d: f64| {
                let mut p = start.to_vec();
                p[i] += d;
                objective.evaluate(&p, false).cost
            };
            let numeric = -(cost(h) - cost(-h)) / (4.0 * h);
            assert!(
                (slope[i] / numeric - 1.0).abs() < 1e-5,
                "{kind} {asymmetric}: unknown {i}: {} against {numeric}",
                slope[i]
            );
        }
    }
}

/// With an encoder and a mass the intervals come from simulated logs of the fitted axis. They have the
/// exponent that was fitted: with another one their fits end elsewhere, and all of the difference would
/// count as what encoder and filters shift (.19 to 5.3 of a true exponent of 1, simulated with 2).
#[test]
fn replicas_have_the_fitted_exponent() {
    const TRUTH: f64 = 1.0;
    let filters = Conditioning {
        source_cutoff: Cutoff::Hz(400.0),
        common_cutoff: Cutoff::Hz(200.0),
        ..Conditioning::default()
    };
    let lugre = LuGre::new(1.2e5, Damping::Constant(600.0), curve(TRUTH, false)).unwrap();
    let law = Law::new(LawKind::LuGre).with_fitted_exponent();
    let mut wide = Vec::new();
    for run in 0..3 {
        let trial = quantised_law(lugre, 1e-6, 0.05, &filters, run);
        let (record, terms) = (&trial.record, &trial.terms);
        let settings = Settings::default();
        let found = separable(record, law, terms, &settings, &mut Silent).unwrap();
        let mut fitted = estimate(record, law, terms, &found, 1e-3);
        intervals(record, &found, &mut fitted, &mut Silent);
        for (name, truth) in trial
            .truth
            .into_iter()
            .chain([("stribeck_exponent", TRUTH)])
        {
            let p = fitted.parameter(name).unwrap();
            println!(
                "{run} {name} {} {:?} {:?} {:?}",
                p.value, p.std, p.bias, p.ci95
            );
            assert!(p.bias.is_some(), "{name}: no replica was made");
            assert!(at_once(p).is_some(), "{name}: {}", p.reason);
            let off = (p.value - truth).abs() / p.std.unwrap();
            assert!(off < 5.0, "{name} is off by {off:.1} deviations");
        }
        let (low, high) = fitted.parameter("stribeck_exponent").unwrap().ci95.unwrap();
        if !(low > 0.8 && high < 1.25) {
            wide.push(run);
        }
    }
    // Two of three miss that: of few strokes and for another day one of them has .74 to 1.49.
    assert_eq!(wide, [1, 2]);
}
