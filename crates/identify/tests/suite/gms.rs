//! The generalised Maxwell-slip law against its own equations, integrated by brute force.

use crate::common;
use crate::common::maxwell::{Maxwell, four, motion};
use crate::common::{Noise, record};
use stiction_identify::{
    Control, Delay, Error, Estimate, Fit, Law, LawKind, Mass, Objective, Optimum, Progress, Record,
    Settings, Silent, Stage, Status, Terms, estimate, identify, predict, separable,
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

/// The stage that takes longest says how far it is: it never falls back, and moves in between.
#[test]
fn the_longest_stage_says_how_far_it_is() {
    let (v, u) = four().along(4000, 1e-3, 20, motion);
    let record = record(1e-3, v, u);
    let mut fractions: Vec<f64> = Vec::new();
    let mut watch = |progress: &Progress| {
        if progress.stage == Stage::Fine {
            fractions.push(progress.fraction);
        }
        Control::Continue
    };
    let settings = Settings::default();
    separable(&record, gms(3), &friction_only(), &settings, &mut watch).unwrap();
    assert!(fractions.is_sorted(), "{fractions:?}");
    fractions.dedup();
    assert!(fractions.len() > 4, "{fractions:?}");
    assert_eq!((fractions[0], fractions[fractions.len() - 1]), (0.0, 1.0));
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

/// The same for the law without a curve, whose directions may differ in level.
#[test]
fn gradient_without_a_curve() {
    let (v, u) = asymmetric().along(4000, 1e-3, 20, motion);
    let record = record(1e-3, v, u);
    let yields = [3.1e-6_f64, 7.3e-6, 2.1e-5].map(f64::ln);
    for (law, mut start) in [
        (Law::new(LawKind::MaxwellSlip), vec![]),
        (Law::new(LawKind::MaxwellSlip).asymmetric(), vec![-0.3]),
    ] {
        start.extend(yields);
        let law = Law { elements: 3, ..law };
        let objective = Objective::new(&record, law, &friction_only());
        let slope = objective.descent(&start);
        assert_eq!(slope.len(), start.len());
        for i in 0..start.len() {
            let cost = |d: f64| {
                let mut p = start.clone();
                p[i] += d;
                objective.evaluate(&p, false).cost
            };
            let numeric = -(cost(1e-5) - cost(-1e-5)) / 4e-5;
            assert!(
                (slope[i] / numeric - 1.0).abs() < 1e-4,
                "{i}: {} {numeric}",
                slope[i]
            );
        }
    }
}

/// Without a curve the force is that of elastic elements between two stops: the sum of
/// `clamp(z + dx, -d, d)`, exact for any motion that turns around at its samples.
#[test]
fn without_a_curve_elements_are_stops() {
    let elements = [(2e6, 3e-6), (4e5, 1.2e-5), (1e5, 2.4e-5)];
    let step = 1e-3;
    let velocity = |i: usize| 1e-3 * ((i as f64 * 0.13).sin() + 0.8 * (i as f64 * 0.031).cos());
    let mut z = [0.0; 3];
    let (mut v, mut u) = (Vec::new(), Vec::new());
    for i in 0..6000 {
        let now = velocity(i);
        if i > 0 {
            let before: f64 = velocity(i - 1);
            // The stretch to the turn, if there is one, and the stretch after it.
            let theta = if before * now < 0.0 {
                before / (before - now)
            } else {
                1.0
            };
            let first = if theta < 1.0 {
                0.5 * theta * before
            } else {
                0.5 * (before + now)
            };
            let second = 0.5 * (1.0 - theta) * now;
            for (z, (_, d)) in z.iter_mut().zip(elements) {
                *z = (*z + first * step).clamp(-d, d);
                *z = (*z + second * step).clamp(-d, d);
            }
        }
        v.push(now);
        u.push(z.iter().zip(elements).map(|(z, (k, _))| k * z).sum::<f64>() + 30.0 * now);
    }
    let record = record(step, v, u);
    let law = Law {
        elements: 3,
        ..Law::new(LawKind::MaxwellSlip)
    };
    let objective = Objective::new(&record, law, &friction_only());
    let p: Vec<f64> = elements.iter().map(|(_, d): &(f64, f64)| d.ln()).collect();
    let left = objective.relative(objective.evaluate(&p, false).cost);
    assert!(left < 1e-12, "{left}");
    let (found, estimate) = fit(&record, law, &friction_only());
    assert_eq!(found.law.elements, 3);
    for (i, (k, d)) in elements.into_iter().enumerate() {
        let stiffness = estimate.value(&format!("stiffness_{}", i + 1)).unwrap();
        let at = estimate.value(&format!("yield_{}", i + 1)).unwrap();
        assert!(
            (stiffness / k - 1.0).abs() < 1e-6,
            "{stiffness} instead of {k}"
        );
        assert!((at / d - 1.0).abs() < 1e-6, "{at} instead of {d}");
    }
}

/// A recording that begins in the middle of a motion: its start, whose force depends on what was
/// before, is not fitted, and the elements come out right.
#[test]
fn a_start_in_the_middle_of_a_motion() {
    let truth = four();
    let (v, u) = truth.along(12_000, 5e-4, 50, motion);
    let cut = record(5e-4, v[2500..].to_vec(), u[2500..].to_vec());
    let settled = cut.settled();
    assert!(settled.kept() < cut.kept());
    assert!(
        settled
            .notes
            .iter()
            .any(|n| n.contains("at the start not fitted"))
    );
    let (_, with) = fit(&cut, gms(4), &friction_only());
    let (_, without) = fit(&settled, gms(4), &friction_only());
    let off = without.value("sigma0").unwrap() / truth.stiffness() - 1.0;
    assert!(off.abs() < 0.005, "total stiffness off by {off}");
    assert!(
        without.fit.rmse < 0.2 * with.fit.rmse,
        "{:?} {:?}",
        with.fit,
        without.fit
    );
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
    // The work done: more of it must be a decision, not an accident.
    let tried: Vec<usize> = found.elements.iter().map(|e| e.elements).collect();
    assert_eq!(tried, [7, 6, 5, 4, 3]);
    let counts = found.counts;
    assert_eq!(
        (
            counts.without_derivatives(),
            counts.with_derivatives(),
            counts.coarse(),
        ),
        (58, 464, 351)
    );
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

/// A command that is held from its row on is half a sample ahead of the motion that it causes. Elements cannot find that, and
/// without it the mass is off; held where LuGre finds it, it is inside.
#[test]
fn beside_a_delay_the_mass_is_that_of_the_axis() {
    let truth = four();
    let step = 5e-4;
    // Twice as fine, so that force and motion can be taken half a sample apart.
    let (v, mut u) = truth.along(40_000, 0.5 * step, 25, motion);
    let mut noise = Noise::new(3);
    for (i, u) in u.iter_mut().enumerate() {
        let (h, t) = (1e-6, 0.5 * i as f64 * step);
        *u += 6.0 * (motion(t + h) - motion(t - h)) / h + 0.15 * noise.normal();
    }
    let every_other = |x: &[f64], from: usize| x[from..].iter().step_by(2).copied().collect();
    let record = record(step, every_other(&v, 0), every_other(&u, 1));
    let fitted = |delay: Delay| {
        let terms = Terms {
            delay,
            ..Terms::default()
        };
        let settings = Settings::default();
        identify(&record, gms(4), &terms, 1e-4, &settings, &mut Silent).unwrap()
    };
    // Error and half of the interval.
    let mass = |found: &Estimate| {
        let found = found.parameter("mass").unwrap();
        let (low, high) = found.ci95.unwrap();
        ((12.0 - found.value).abs(), 0.5 * (high - low))
    };
    let [held, without] = [Delay::Fitted, Delay::NONE].map(fitted);
    println!("{:?} and {:?} without", mass(&held), mass(&without));
    assert!(mass(&without).0 > 5.0 * mass(&held).0);
    assert!(mass(&held).0 < mass(&held).1);
    let Delay::Given(delay) = held.terms.delay else {
        panic!("{:?}", held.terms.delay);
    };
    // The force belongs to a motion half a sample later. Four elements are no LuGre, which knows that it does not know it well.
    let off = delay / step + 0.5;
    let deviation = held.terms.delay_deviation / step;
    assert!(off.abs() < 3.0 * deviation, "{off} of {deviation}");
}

/// The error of a delay that another law has found is one of the mass and of all that feels it: their deviations are those beside
/// the held delay and of its error together, taken from fits at the ends of its interval.
#[test]
fn the_error_of_a_delay_that_is_held_is_counted() {
    let truth = four();
    let step = 5e-4;
    let (v, mut u) = truth.along(20_000, step, 50, motion);
    let mut noise = Noise::new(3);
    for (i, u) in u.iter_mut().enumerate() {
        let (h, t) = (1e-6, i as f64 * step);
        *u += 6.0 * (motion(t + h) - motion(t - h)) / h + 0.15 * noise.normal();
    }
    let record = record(step, v, u);
    let deviation = 0.2 * step;
    let at = |delay: f64, delay_deviation: f64| {
        let terms = Terms {
            delay: Delay::Given(delay),
            delay_deviation,
            ..Terms::default()
        };
        let settings = Settings::default();
        identify(&record, gms(4), &terms, 1e-4, &settings, &mut Silent).unwrap()
    };
    let [early, late] = [-deviation, deviation].map(|delay| at(delay, 0.0));
    let [known, held] = [0.0, deviation].map(|deviation| at(0.0, deviation));
    let mut felt = Vec::new();
    for name in ["mass", "sigma2", "coulomb", "static", "attraction"] {
        let moved = 0.5 * (late.value(name).unwrap() - early.value(name).unwrap());
        let [known, held] = [&known, &held].map(|e| e.parameter(name).unwrap().std.unwrap());
        println!("{name} moves by {moved}, {known} to {held}");
        let ratio = held / known.hypot(moved);
        assert!((ratio - 1.0).abs() < 0.1, "{name}: {ratio}");
        if moved.abs() > 0.5 * known {
            felt.push(name);
        }
    }
    assert!(felt.contains(&"mass"), "{felt:?}");
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
