//! The identification against the friction crate: data stepped by [`LuGre::step_record`] on the very
//! samples that are fitted, so the optimum must be the truth to rounding.

use crate::common;
use crate::common::{MACHINE, Noise, record};
use std::f64::consts::TAU;
use stiction_friction::{CoulombViscous, Dahl, Damping, Direction, LuGre, Shape, Stribeck};
use stiction_identify::{
    Control, Estimate, Law, LawKind, Mass, Objective, Observer, Optimum, Progress, Record,
    Settings, Silent, Status, Terms, cross_validate, estimate, predict, separable,
};

const STEP: f64 = 5e-4;

/// Two tones: reversals of many depths, and speeds through the whole Stribeck range.
fn motion(n: usize) -> Vec<f64> {
    (0..n)
        .map(|i| {
            let t = i as f64 * STEP;
            0.02 * (TAU * t).sin() + 0.012 * (TAU * 6.3 * t + 0.4).sin()
        })
        .collect()
}

/// Force along the samples, one step of the friction crate a sample.
fn stepped(law: &LuGre<f64>, v: &[f64]) -> Vec<f64> {
    let mut z = 0.0;
    let mut out = Vec::with_capacity(v.len());
    for (i, &now) in v.iter().enumerate() {
        if i > 0 {
            z = law.step_record(z, STEP, v[i - 1], now);
        }
        out.push(law.force(z, now));
    }
    out
}

fn side(coulomb: f64, fixed: f64, velocity: f64, viscous: f64) -> Direction<f64> {
    Direction {
        coulomb,
        static_friction: fixed,
        stribeck_velocity: velocity,
        viscous,
    }
}

const POS: (f64, f64, f64, f64) = (20.0, 30.0, 5e-3, 60.0);
const NEG: (f64, f64, f64, f64) = (24.0, 31.0, 4e-3, 80.0);

fn direction((c, s, v, d): (f64, f64, f64, f64)) -> Direction<f64> {
    side(c, s, v, d)
}

fn law(kind: LawKind, asymmetric: bool, exponent: f64) -> Law {
    let mut law = Law::new(kind);
    law.asymmetric = asymmetric;
    law.exponent = exponent;
    law
}

fn terms(offset: bool) -> Terms {
    Terms {
        mass: Mass::Absent,
        offset,
        ..Terms::default()
    }
}

fn fit(record: &Record, law: Law, terms: &Terms) -> Estimate {
    let found = separable(record, law, terms, &Settings::default(), &mut Silent).unwrap();
    assert_eq!(found.status, Status::Converged, "{:?}", law.kind);
    estimate(record, law, terms, &found, 1e-3)
}

/// Every number to `tolerance`, relative; numbers that are 0 in truth against the Coulomb level.
fn same(estimate: &Estimate, truth: &[(&str, f64)], tolerance: f64) {
    for &(name, truth) in truth {
        let value = estimate.value(name).unwrap_or_else(|| panic!("no {name}"));
        let size = if truth == 0.0 { POS.0 } else { truth.abs() };
        let off = (value - truth).abs() / size;
        assert!(off < tolerance, "{name} = {value}, not {truth} ({off:.1e})");
    }
}

fn lugre(exponent: f64, asymmetric: bool, offset: f64) {
    let shape = if exponent == 2.0 {
        Shape::Gaussian
    } else {
        Shape::Power(exponent)
    };
    let neg = if asymmetric { NEG } else { POS };
    let curve = Stribeck::new(shape, direction(POS), direction(neg), offset).unwrap();
    let truth = LuGre::new(1.2e5, Damping::Constant(600.0), curve).unwrap();
    let v = motion(8000);
    let record = record(STEP, v.clone(), stepped(&truth, &v));
    let fitted = fit(
        &record,
        law(LawKind::LuGre, asymmetric, exponent),
        &terms(true),
    );
    assert!(
        fitted.fit.relative_error_percent < 1e-9,
        "{} %",
        fitted.fit.relative_error_percent
    );
    let mut expected = vec![("sigma0", 1.2e5), ("sigma1", 600.0), ("offset", offset)];
    if asymmetric {
        expected.extend([
            ("coulomb_pos", POS.0),
            ("static_pos", POS.1),
            ("stribeck_velocity_pos", POS.2),
            ("sigma2_pos", POS.3),
            ("coulomb_neg", NEG.0),
            ("static_neg", NEG.1),
            ("stribeck_velocity_neg", NEG.2),
            ("sigma2_neg", NEG.3),
        ]);
    } else {
        expected.extend([
            ("coulomb", POS.0),
            ("static", POS.1),
            ("stribeck_velocity", POS.2),
            ("sigma2", POS.3),
        ]);
    }
    same(&fitted, &expected, 1e-8);
    // And what it predicts on another motion is what the friction crate says there.
    let other: Vec<f64> = motion(6000).iter().rev().map(|v| 0.7 * v).collect();
    let force = stepped(&truth, &other);
    let unseen = common::record(STEP, other, force.clone());
    for (model, force) in predict(&unseen, &fitted).model.iter().zip(&force) {
        assert!((model - force).abs() < 1e-8 * POS.1);
    }
}

#[test]
fn lugre_symmetric_gaussian() {
    lugre(2.0, false, -1.5);
}

#[test]
fn lugre_symmetric_exponent_1() {
    lugre(1.0, false, 0.0);
}

#[test]
fn lugre_asymmetric_gaussian() {
    lugre(2.0, true, 2.0);
}

#[test]
fn lugre_asymmetric_exponent_1() {
    lugre(1.0, true, -0.5);
}

/// A trial's residual is exactly what the friction crate leaves, also far from the optimum.
#[test]
fn no_trial_undercuts_the_truth() {
    let truth = MACHINE.law();
    let v = motion(4000);
    let record = record(STEP, v.clone(), stepped(&truth, &v));
    let objective = Objective::new(&record, Law::new(LawKind::LuGre), &terms(true));
    let at = |s0: f64, fixed: f64, velocity: f64| {
        objective.evaluate(
            &[
                (s0 / MACHINE.coulomb).ln(),
                (fixed / MACHINE.coulomb - 1.0).ln(),
                velocity.ln(),
            ],
            false,
        )
    };
    let best = at(MACHINE.sigma0, MACHINE.fixed, MACHINE.velocity);
    assert!(objective.relative(best.cost) < 1e-12, "{}", best.cost);
    for factor in [0.5, 0.9, 1.1, 2.0] {
        for trial in [
            at(MACHINE.sigma0 * factor, MACHINE.fixed, MACHINE.velocity),
            at(MACHINE.sigma0, MACHINE.fixed, MACHINE.velocity * factor),
        ] {
            assert!(objective.relative(trial.cost) > 1e-4);
        }
    }
}

#[test]
fn dahl() {
    let truth = Dahl::new(1.2e5, [20.0, 20.0], 1.0).unwrap();
    let v = motion(8000);
    let record = record(STEP, v.clone(), stepped(truth.law(), &v));
    let fitted = fit(&record, law(LawKind::Dahl, false, 2.0), &terms(true));
    let expected = [("sigma0", 1.2e5), ("coulomb", 20.0), ("offset", 1.0)];
    same(&fitted, &expected, 1e-8);
    assert!(fitted.value("sigma2").unwrap() < 1e-6);
}

#[test]
fn dahl_asymmetric() {
    let truth = Dahl::new(1.2e5, [20.0, 24.0], 0.0).unwrap();
    let v = motion(8000);
    let record = record(STEP, v.clone(), stepped(truth.law(), &v));
    let fitted = fit(&record, law(LawKind::Dahl, true, 2.0), &terms(false));
    let expected = [
        ("sigma0", 1.2e5),
        ("coulomb_pos", 20.0),
        ("coulomb_neg", 24.0),
    ];
    same(&fitted, &expected, 1e-8);
}

#[test]
fn coulomb_and_viscous() {
    let v = motion(2000);
    let truth = CoulombViscous::symmetric(20.0, 60.0, -3.0).unwrap();
    let u = v.iter().map(|&v| truth.force(v)).collect();
    let fitted = fit(
        &record(STEP, v.clone(), u),
        law(LawKind::CoulombViscous, false, 2.0),
        &terms(true),
    );
    let expected = [("coulomb", 20.0), ("sigma2", 60.0), ("offset", -3.0)];
    same(&fitted, &expected, 1e-10);

    let truth = CoulombViscous::new([20.0, 24.0], [60.0, 80.0], 0.0).unwrap();
    let u = v.iter().map(|&v| truth.force(v)).collect();
    let fitted = fit(
        &record(STEP, v, u),
        law(LawKind::CoulombViscous, true, 2.0),
        &terms(false),
    );
    let expected = [
        ("coulomb_pos", 20.0),
        ("coulomb_neg", 24.0),
        ("sigma2_pos", 60.0),
        ("sigma2_neg", 80.0),
    ];
    same(&fitted, &expected, 1e-10);
}

#[test]
fn stribeck() {
    let v = motion(4000);
    for exponent in [2.0, 1.0] {
        let shape = Shape::Power(exponent);
        let truth = Stribeck::symmetric(shape, direction(POS), 1.0).unwrap();
        let u = v.iter().map(|&v| truth.force(v)).collect();
        let fitted = fit(
            &record(STEP, v.clone(), u),
            law(LawKind::Stribeck, false, exponent),
            &terms(true),
        );
        let expected = [
            ("coulomb", POS.0),
            ("static", POS.1),
            ("stribeck_velocity", POS.2),
            ("sigma2", POS.3),
            ("offset", 1.0),
        ];
        same(&fitted, &expected, 1e-8);

        let truth = Stribeck::new(shape, direction(POS), direction(NEG), 0.0).unwrap();
        let u = v.iter().map(|&v| truth.force(v)).collect();
        let fitted = fit(
            &record(STEP, v.clone(), u),
            law(LawKind::Stribeck, true, exponent),
            &terms(false),
        );
        let expected = [
            ("coulomb_pos", POS.0),
            ("static_pos", POS.1),
            ("stribeck_velocity_pos", POS.2),
            ("sigma2_pos", POS.3),
            ("coulomb_neg", NEG.0),
            ("static_neg", NEG.1),
            ("stribeck_velocity_neg", NEG.2),
            ("sigma2_neg", NEG.3),
        ];
        same(&fitted, &expected, 1e-8);
    }
}

/// LuGre data with noise and inertia.
fn noisy(n: usize, seed: u64) -> (Vec<f64>, Vec<f64>) {
    let v = motion(n);
    let mut noise = Noise::new(seed);
    let mut u = stepped(&MACHINE.law(), &v);
    for i in 0..n {
        let a = (v[(i + 1).min(n - 1)] - v[i.saturating_sub(1)]) / (2.0 * STEP);
        u[i] += 10.0 * a + 0.2 * noise.normal();
    }
    (v, u)
}

/// A change of the units of force, length and time changes the parameters by their dimension only.
#[test]
fn units_do_not_matter() {
    let (v, u) = noisy(4000, 3);
    let law = Law::new(LawKind::LuGre);
    let base = fit(&record(STEP, v.clone(), u.clone()), law, &Terms::default());
    for (f, l, t) in [
        (3.7e-3, 1.0, 1.0),
        (1.0, 1e3, 1.0),
        (1.0, 1.0, 7.3),
        (9e4, 2e-5, 31.0),
    ] {
        let scaled = record(
            STEP * t,
            v.iter().map(|v| v * l / t).collect(),
            u.iter().map(|u| u * f).collect(),
        );
        let fitted = fit(&scaled, law, &Terms::default());
        for (name, factor) in [
            ("sigma0", f / l),
            ("sigma1", f * t / l),
            ("sigma2", f * t / l),
            ("coulomb", f),
            ("static", f),
            ("stribeck_velocity", l / t),
            ("mass", f * t * t / l),
            ("offset", f),
        ] {
            let (a, b) = (
                base.parameter(name).unwrap(),
                fitted.parameter(name).unwrap(),
            );
            let std = b.std.unwrap() / (factor * a.std.unwrap());
            // An offset near zero is as sharp as its deviation only.
            let size = a.value.abs().max(a.std.unwrap());
            let off = (b.value / factor - a.value).abs() / size;
            assert!(off < 1e-6, "{name} in units {f} {l} {t}: off by {off:.1e}");
            assert!((std - 1.0).abs() < 1e-5, "deviation of {name}: {std}");
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_bits() {
    let (v, u) = noisy(4000, 5);
    let record = record(STEP, v, u);
    for kind in LawKind::ALL {
        let law = Law::new(kind).asymmetric();
        let bits = || {
            let settings = Settings {
                seed: 42,
                ..Settings::default()
            };
            let found = separable(&record, law, &Terms::default(), &settings, &mut Silent).unwrap();
            let e = estimate(&record, law, &Terms::default(), &found, 1e-3);
            let mut bits: Vec<u64> = Vec::new();
            for p in &e.parameters {
                bits.push(p.value.to_bits());
                bits.push(p.std.map_or(0, f64::to_bits));
            }
            bits.extend(e.series.model.iter().map(|x| x.to_bits()));
            bits
        };
        assert!(bits() == bits(), "{kind}");
    }
}

/// Counts calls, and stops from the one asked for.
struct StopAfter {
    calls: usize,
    most: usize,
}

impl Observer for StopAfter {
    fn progress(&mut self, progress: &Progress) -> Control {
        assert!((0.0..=1.0).contains(&progress.fraction), "{progress:?}");
        self.calls += 1;
        if self.calls >= self.most {
            Control::Stop
        } else {
            Control::Continue
        }
    }
}

#[test]
fn a_search_stops_whenever_asked() {
    let (v, u) = noisy(4000, 7);
    let record = record(STEP, v, u);
    for law in [
        Law::new(LawKind::LuGre),
        Law::new(LawKind::LuGre).asymmetric(),
        Law::new(LawKind::Stribeck).asymmetric(),
        Law::new(LawKind::Dahl),
    ] {
        let run = |most| -> (Optimum, usize) {
            let mut observer = StopAfter { calls: 0, most };
            let found = separable(
                &record,
                law,
                &Terms::default(),
                &Settings::default(),
                &mut observer,
            )
            .unwrap();
            (found, observer.calls)
        };
        let (whole, calls) = run(usize::MAX);
        let stops = [1, 2, 5, 20, 80, calls / 2, calls - 3];
        // A short search is over before the later ones.
        for most in stops.into_iter().filter(|&most| most < calls) {
            let (found, seen) = run(most);
            assert_eq!(
                found.status,
                Status::Interrupted,
                "{law:?} after {most} of {calls}"
            );
            assert!(
                seen <= most + 30,
                "{law:?}: {seen} calls after a stop at {most}"
            );
            assert!(found.counts.total() <= whole.counts.total());
            let e = estimate(&record, law, &Terms::default(), &found, 1e-3);
            for p in &e.parameters {
                assert!(
                    p.value.is_finite(),
                    "{law:?} after {most}: {} {}",
                    p.name,
                    p.value
                );
            }
            assert!(e.fit.rmse.is_finite());
        }
    }
}

fn held_out(record: &Record, kind: LawKind) -> f64 {
    let law = Law::new(kind);
    let terms = Terms::default();
    let found = separable(record, law, &terms, &Settings::default(), &mut Silent).unwrap();
    let e = estimate(record, law, &terms, &found, 1e-3);
    let score = cross_validate(record, &e, &found, 4, &mut Silent);
    score.held_out.unwrap().rmse
}

/// On held-out blocks no law beats the true one by more than chance.
#[test]
fn held_out_error_names_the_law() {
    let n = 8000;
    let v = motion(n);
    let mut noise = Noise::new(11);
    let truth = CoulombViscous::symmetric(20.0, 60.0, 1.0).unwrap();
    let u = v.iter().map(|&v| truth.force(v) + noise.normal()).collect();
    let plain = record(STEP, v, u);
    let simple = held_out(&plain, LawKind::CoulombViscous);
    for kind in [LawKind::Stribeck, LawKind::Dahl, LawKind::LuGre] {
        let rich = held_out(&plain, kind);
        assert!(rich > 0.999 * simple, "{kind}: {rich} against {simple}");
    }

    let (v, u) = noisy(n, 13);
    let bristle = record(STEP, v, u);
    let lugre = held_out(&bristle, LawKind::LuGre);
    assert!(
        (lugre / 0.2 - 1.0).abs() < 0.05,
        "noise of .2 N, held out {lugre}"
    );
    for kind in [LawKind::CoulombViscous, LawKind::Stribeck, LawKind::Dahl] {
        let other = held_out(&bristle, kind);
        assert!(other > 2.0 * lugre, "{kind}: {other} against {lugre}");
    }
}
