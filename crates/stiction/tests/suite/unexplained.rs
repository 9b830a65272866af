//! What a law takes up of an effect that it does not describe is no constant of the machine. Motions and forces by formulas of their
//! own.

use crate::common::{Bench, noise, options};
use std::f64::consts::TAU;
use stiction::commands::Outcome;
use stiction::{Code, LawKind, Silent};

fn fitted(bench: &Bench, rows: impl Iterator<Item = [f64; 3]>) -> Outcome {
    let rows: Vec<String> = rows
        .map(|[t, x, force]| format!("{t:.5},{:.5},{force:.4}\n", 1e3 * x))
        .collect();
    let text = format!("Time [s],Position [mm],Force [N]\n{}", rows.concat());
    let log = bench.write("log.csv", &text);
    let mut asked = options(&[&log], LawKind::LuGre);
    asked.law = None;
    asked.identify(&mut Silent).unwrap()
}

/// A screw on one sine of 1 Hz: five generalized Maxwell-slip elements (Al-Bender, Lampaert, Swevers 2005) whose slipping forces follow the
/// Stribeck curve within tenths of a second, under a cascade with a filtered speed. Time, position (m), force (N).
fn slowly_attracted() -> Vec<[f64; 3]> {
    const PARTS: [f64; 5] = [0.1, 0.2, 0.3, 0.25, 0.15];
    const STIFFNESS: [f64; 5] = [0.45, 0.25, 0.15, 0.1, 0.05];
    let (sigma0, sigma2, excess, stribeck, attraction) = (5e6, 250.0, 32.0, 0.008, 300.0);
    let (rate, substeps, count) = (2000.0, 100, 7.63e-8);
    let step = 1.0 / rate;
    let fine = step / f64::from(substeps);
    let wanted = |t: f64| {
        let begun = (t / 0.3).min(1.0);
        0.04 * begun * begun * (3.0 - 2.0 * begun) * (TAU * t).sin()
    };
    let (mut x, mut v) = (0.0, 0.0_f64);
    let (mut read, mut filtered, mut integral) = (0.0, 0.0, 0.0);
    let (mut forces, mut slips) = ([0.0_f64; 5], [false; 5]);
    let mut out = Vec::new();
    for k in 0..20_000 {
        let t = k as f64 * step;
        let now = (x / count + 0.5_f64).floor() * count;
        filtered += step / (0.001 + step) * ((now - read) * rate - filtered);
        read = now;
        let asked = if k == 0 {
            0.0
        } else {
            (wanted(t) - wanted(t - step)) * rate
        };
        let error = 35.0 * (wanted(t) - now) + asked - filtered;
        let force = MASS * 180.0 * (error + integral);
        integral += error * step / 0.03;
        out.push([t, now, force + 2.0 * noise(5, k)]);
        for _ in 0..substeps {
            let level = COULOMB + excess * (-(v / stribeck) * (v / stribeck)).exp();
            for i in 0..5 {
                let (part, stiffness) = (PARTS[i], STIFFNESS[i] * sigma0);
                if slips[i] {
                    let way = v.signum();
                    forces[i] += way * attraction * (part - way * forces[i] / level) * fine;
                    slips[i] = v * forces[i] >= 0.0;
                } else {
                    forces[i] += stiffness * v * fine;
                    slips[i] = forces[i].abs() >= part * level;
                }
            }
            let friction = forces.iter().sum::<f64>() + sigma2 * v;
            v += fine * (force - friction - 4.0) / MASS;
            x += fine * v;
        }
    }
    out
}

const COULOMB: f64 = 80.0;
const MASS: f64 = 45.0;

/// The levels lag behind the speed, of which mass and Coulomb friction take up what they can; what is left is mostly how it began.
#[test]
fn levels_that_lag_leave_no_constants_on_one_sine() {
    let bench = Bench::new();
    let found = fitted(&bench, slowly_attracted().into_iter());
    let result = &found.result;
    let wrong = |name: &str, truth: f64| {
        let p = result.parameters.iter().find(|p| p.name == name).unwrap();
        let [low, high] = p.ci95.map(|end| end.map(Option::unwrap)).unwrap();
        !(low..=high).contains(&truth)
    };
    assert!(wrong("coulomb", COULOMB) && wrong("mass", MASS));
    assert!(
        result.trust.constants.is_empty(),
        "{:?}",
        result.trust.constants
    );
    let named = |w: &&stiction::Warning| w.code == Code::CorrelatedResidual;
    let warning = result.warnings.iter().find(named).unwrap();
    assert!(
        warning
            .message
            .contains("none of them is given as a constant"),
        "{warning:?}"
    );
}

/// One reversal at constant acceleration: the inertia is a part of the constant force, and where between two samples the axis turned
/// back is not known, which is all that such a log has of a delay.
#[test]
fn one_reversal_at_constant_acceleration_tells_no_offset_and_no_delay() {
    let (sigma2, coulomb, mass, a, rate) = (60.0, 20.0, 10.0, -0.04, 4000.0);
    for (seed, begin) in [(1, 0.1), (2, 0.099_995), (3, 0.1)] {
        let rows = (0..20_000).map(|k| {
            let t = k as f64 / rate;
            let v: f64 = begin + a * t;
            let x = begin * t + 0.5 * a * t * t;
            let force = mass * a + sigma2 * v + coulomb * v.signum();
            [t, (x / 5e-8).round() * 5e-8, force + 0.5 * noise(seed, k)]
        });
        let bench = Bench::new();
        let found = fitted(&bench, rows);
        let result = &found.result;
        let of = |name: &str| result.parameters.iter().find(|p| p.name == name).unwrap();
        for name in ["mass", "offset"] {
            assert!(!of(name).identifiable, "{:?}", of(name));
        }
        let delay = of("delay");
        let [low, high] = delay.ci95.map(|end| end.map(Option::unwrap)).unwrap();
        assert!(
            !delay.identifiable && (low..=high).contains(&0.0),
            "delay: {low} {high}"
        );
        for (name, truth) in [("sigma2", sigma2), ("coulomb", coulomb)] {
            let [low, high] = of(name).ci95.map(|end| end.map(Option::unwrap)).unwrap();
            assert!((low..=high).contains(&truth), "{name}: {low} {high}");
        }
    }
}
