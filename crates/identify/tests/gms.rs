//! The generalised Maxwell-slip law against its own equations, integrated by brute force.

mod common;
#[path = "common/maxwell.rs"]
mod maxwell;

use common::{Noise, record};
use maxwell::{Maxwell, four, motion};
use stiction_identify::{
    Error, Estimate, Fit, Law, LawKind, Mass, Objective, Optimum, Record, Settings, Silent, Status,
    Terms, estimate, predict, separable,
};

fn friction_only() -> Terms {
    Terms {
        mass: Mass::Absent,
        offset: false,
        ..Terms::default()
    }
}

fn gms(elements: usize) -> Law {
    Law {
        elements,
        ..Law::new(LawKind::Gms)
    }
}

/// The nonlinear unknowns of a law in the order in which the search has them.
fn unknowns(truth: &Maxwell, law: &Law) -> Vec<f64> {
    let excess = |side: usize| (truth.fixed[side] / truth.coulomb[side] - 1.0).ln();
    let mut out = vec![excess(0), truth.velocity[0].ln()];
    if law.asymmetric {
        out.push((truth.fixed[1] / truth.fixed[0]).ln());
        out.extend([excess(1), truth.velocity[1].ln()]);
    }
    out.push((truth.attraction / truth.fixed[0]).ln());
    out.extend((0..truth.elements.len()).map(|i| truth.yields(i).ln()));
    out
}

fn fit(record: &Record, law: Law, terms: &Terms) -> (Optimum, Estimate) {
    let found = separable(record, law, terms, &Settings::default(), &mut Silent).unwrap();
    let estimate = estimate(record, law, terms, &found, 1e-4);
    (found, estimate)
}

fn asymmetric() -> Maxwell {
    let mut truth = four();
    truth.coulomb[1] = 15.0;
    truth.fixed[1] = 21.0;
    truth.velocity[1] = 1e-3;
    truth.exponent = 1.5;
    truth
}

/// What the true unknowns leave of a force that was integrated on a grid 200 times finer falls with
/// the square of the step.
#[test]
fn recursion_follows_the_equations() {
    for (truth, sides) in [(four(), false), (asymmetric(), true)] {
        let law = Law {
            asymmetric: sides,
            exponent: truth.exponent,
            ..gms(4)
        };
        let left: Vec<f64> = [2e-3, 1e-3, 5e-4]
            .into_iter()
            .map(|step| {
                let n = (5.0 / step) as usize;
                let (v, u) = truth.along(n, step, 200, motion);
                let record = record(step, v, u);
                let objective = Objective::new(&record, law, &friction_only());
                objective.relative(objective.evaluate(&unknowns(&truth, &law), false).cost)
            })
            .collect();
        assert!(left[2] < 2e-4, "{left:?}");
        assert!(
            left[1] < 0.35 * left[0] && left[2] < 0.35 * left[1],
            "{left:?}"
        );
    }
}

/// The reduced gradient equals central differences of the cost.
#[test]
fn gradient_matches_finite_differences() {
    for sides in [false, true] {
        let truth = if sides { asymmetric() } else { four() };
        let (v, u) = truth.along(4000, 1e-3, 20, motion);
        let record = record(1e-3, v, u);
        let law = Law {
            asymmetric: sides,
            exponent: truth.exponent,
            ..gms(4)
        };
        // Off the truth, so that there is a slope.
        let start: Vec<f64> = unknowns(&truth, &law)
            .iter()
            .enumerate()
            .map(|(i, p)| p + 0.2 * (i as f64 * 1.7).sin())
            .collect();
        let objective = Objective::new(&record, law, &friction_only());
        let slope = objective.descent(&start);
        for i in 0..start.len() {
            let h = 1e-5;
            let cost = |d: f64| {
                let mut p = start.clone();
                p[i] += d;
                objective.evaluate(&p, false).cost
            };
            let numeric = -(cost(h) - cost(-h)) / (4.0 * h);
            assert!(
                (slope[i] / numeric - 1.0).abs() < 1e-4,
                "asymmetric {sides}, unknown {i}: {} against {numeric}",
                slope[i]
            );
        }
    }
}

/// Four elements with noise of half a percent, mass and offset unknown: what the law predicts is
/// right, and so is every parameter that is said to be known.
#[test]
fn four_elements_are_found() {
    let truth = four();
    let step = 5e-4;
    let n = 20_000;
    let (v, mut u) = truth.along(n, step, 50, motion);
    let mut noise = Noise::new(3);
    for (i, u) in u.iter_mut().enumerate() {
        let h = 1e-6;
        let t = i as f64 * step;
        let a = (motion(t + h) - motion(t - h)) / (2.0 * h);
        *u += 12.0 * a + 1.5 + 0.15 * noise.normal();
    }
    let record = record(step, v, u);
    let (found, estimate) = fit(&record, gms(0), &Terms::default());
    assert_eq!(found.law.elements, 4, "{:?}", found.elements);
    assert_eq!(found.status, Status::Converged);
    assert!(estimate.fit.rmse < 0.155, "residual {}", estimate.fit.rmse);
    // Another motion, without noise.
    let other = |t: f64| 0.7 * motion(1.3 * t + 0.4);
    let (v, u) = truth.along(n, step, 50, other);
    let clean = common::record(step, v, u);
    let series = predict(&clean, &estimate);
    let residual: Vec<f64> = series
        .residual()
        .iter()
        .zip(&series.other)
        .map(|(r, other)| r + other)
        .collect();
    let unseen = Fit::new(&series.measured, &residual).unwrap();
    assert!(unseen.relative_error_percent < 0.5, "{unseen:?}");
    let value = |name: &str| estimate.value(name).unwrap();
    for x in [0.5e-6_f64, 1e-6, 3e-6, 1e-5, 2e-5, 5e-5] {
        let virgin: f64 = (1..=found.law.elements)
            .map(|k| {
                let (stiffness, at) = (format!("stiffness_{k}"), format!("yield_{k}"));
                value(&stiffness) * x.min(value(&at))
            })
            .sum();
        let off = virgin / truth.virgin(x) - 1.0;
        assert!(off.abs() < 0.02, "virgin curve at {x}: off by {off}");
    }
    let mut checked = 0;
    let mut all: Vec<(String, f64)> = vec![
        ("sigma0".to_string(), truth.stiffness()),
        ("sigma2".into(), truth.viscous),
        ("coulomb".into(), 20.0),
        ("static".into(), 30.0),
        ("stribeck_velocity".into(), 2e-3),
        ("attraction".into(), truth.attraction / 30.0),
        ("mass".into(), 12.0),
        ("offset".into(), 1.5),
    ];
    for i in 0..4 {
        all.push((format!("stiffness_{}", i + 1), truth.elements[i].0));
        all.push((format!("yield_{}", i + 1), truth.yields(i)));
    }
    for (name, truth) in all {
        let p = estimate.parameter(&name).unwrap();
        if p.identifiable {
            // Of some fifteen intervals one may miss by chance, but not by much.
            let (low, high) = p.ci95.unwrap();
            let half = 0.5 * (high - low);
            assert!(
                low - 0.5 * half <= truth && truth <= high + 0.5 * half,
                "{name}: {truth} outside {low} .. {high}"
            );
            checked += 1;
        }
    }
    assert!(checked >= 8, "only {checked} parameters are identifiable");
}

/// Elements that the data do not ask for are dropped.
#[test]
fn elements_without_stiffness_are_dropped() {
    let mut truth = four();
    truth.elements = vec![(12.0 / 3e-6, 0.4), (18.0 / 20e-6, 0.6)];
    let (v, mut u) = truth.along(8000, 5e-4, 50, motion);
    let mut noise = Noise::new(5);
    u.iter_mut().for_each(|u| *u += 0.1 * noise.normal());
    let (found, estimate) = fit(&record(5e-4, v, u), gms(8), &friction_only());
    assert!(found.law.elements < 8, "{:?}", found.law);
    assert!(estimate.fit.rmse < 0.102, "{:?}", estimate.fit);
    for k in 1..=found.law.elements {
        assert!(estimate.value(&format!("stiffness_{k}")).unwrap() > 0.0);
        assert!(
            k == 1
                || estimate.value(&format!("yield_{k}"))
                    > estimate.value(&format!("yield_{}", k - 1))
        );
    }
    let off = estimate.value("sigma0").unwrap() / truth.stiffness() - 1.0;
    assert!(off.abs() < 0.02, "total stiffness off by {off}");
}

#[test]
fn too_many_elements_are_refused() {
    let (v, u) = four().along(2000, 1e-3, 10, motion);
    let found = separable(
        &record(1e-3, v, u),
        gms(11),
        &friction_only(),
        &Settings::default(),
        &mut Silent,
    );
    assert!(matches!(
        found,
        Err(Error::Setting {
            name: "elements",
            ..
        })
    ));
}
