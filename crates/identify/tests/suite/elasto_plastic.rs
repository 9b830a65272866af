//! The elasto-plastic law: the friction crate as oracle, and what is found from simulated records.

use crate::common;
use crate::common::trials::at_once;
use crate::common::{MACHINE, Noise, Set, record};
use std::f64::consts::TAU;
use stiction_friction::{Damping, Direction, ElastoPlastic, LuGre, Shape, Stribeck};
use stiction_identify::{
    Estimate, Law, LawKind, Mass, Objective, Record, SearchBox, Settings, Silent, Status, Terms,
    cross_validate, estimate, predict, separable,
};

/// Presliding strokes of many depths beside sliding through the whole Stribeck range.
fn motion(t: f64) -> f64 {
    0.02 * (TAU * t).sin() + 0.012 * (TAU * 6.3 * t + 0.4).sin()
}

fn axis(set: &Set, ratio: f64) -> ElastoPlastic<f64> {
    ElastoPlastic::new(set.law(), ratio).unwrap()
}

fn lopsided(ratio: f64) -> ElastoPlastic<f64> {
    let side = |coulomb, static_friction, stribeck_velocity, viscous| Direction {
        coulomb,
        static_friction,
        stribeck_velocity,
        viscous,
    };
    let (pos, neg) = (side(20.0, 30.0, 5e-3, 60.0), side(24.0, 31.0, 4e-3, 80.0));
    let curve = Stribeck::new(Shape::Gaussian, pos, neg, 0.0).unwrap();
    let bristle = LuGre::new(1.2e5, Damping::Constant(600.0), curve).unwrap();
    ElastoPlastic::new(bristle, ratio).unwrap()
}

/// Velocity and force of `n` samples, with `fine` steps of the friction crate in each.
fn along(law: &ElastoPlastic<f64>, n: usize, step: f64, fine: usize) -> (Vec<f64>, Vec<f64>) {
    let h = step / fine as f64;
    let mut z = 0.0;
    let (mut v, mut u) = (Vec::new(), Vec::new());
    for i in 0..n {
        for k in 0..if i > 0 { fine } else { 0 } {
            let t = |k: usize| (i - 1) as f64 * step + k as f64 * h;
            z = law.step_record(z, h, motion(t(k)), motion(t(k + 1)));
        }
        let now = motion(i as f64 * step);
        v.push(now);
        u.push(law.force(z, now));
    }
    (v, u)
}

fn terms() -> Terms {
    Terms {
        mass: Mass::Absent,
        offset: false,
        ..Terms::default()
    }
}

fn elasto_plastic(asymmetric: bool) -> Law {
    let law = Law::new(LawKind::ElastoPlastic);
    if asymmetric { law.asymmetric() } else { law }
}

fn fit(record: &Record, law: Law, seed: u64) -> Estimate {
    let settings = Settings {
        seed,
        ..Settings::default()
    };
    let found = separable(record, law, &terms(), &settings, &mut Silent).unwrap();
    assert_eq!(found.status, Status::Converged);
    estimate(record, law, &terms(), &found, 1e-3)
}

fn truth(law: &ElastoPlastic<f64>, asymmetric: bool) -> Vec<(String, f64)> {
    let bristle = law.bristle();
    let curve = bristle.curve();
    let mut out = vec![
        ("sigma0".to_string(), bristle.stiffness()),
        ("sigma1".to_string(), bristle.damping().at_rest()),
        ("breakaway_ratio".to_string(), law.breakaway()),
    ];
    let sides: &[_] = if asymmetric {
        &[("_pos", curve.positive()), ("_neg", curve.negative())]
    } else {
        &[("", curve.positive())]
    };
    for (suffix, side) in sides {
        for (name, value) in [
            ("coulomb", side.coulomb),
            ("static", side.static_friction),
            ("stribeck_velocity", side.stribeck_velocity),
            ("sigma2", side.viscous),
        ] {
            out.push((format!("{name}{suffix}"), value));
        }
    }
    out
}

/// A trial at the truth leaves what rounding leaves of data stepped by the friction crate on the same samples: the two
/// write the same scheme.
#[test]
fn the_recursion_is_that_of_the_friction_crate() {
    for (law, asymmetric) in [(axis(&MACHINE, 0.7), false), (lopsided(0.4), true)] {
        let (v, u) = along(&law, 8000, 5e-4, 1);
        let record = record(5e-4, v, u);
        let objective = Objective::new(&record, elasto_plastic(asymmetric), &terms());
        let odds = (law.breakaway() / (1.0 - law.breakaway())).ln();
        let (pos, neg) = (
            law.bristle().curve().positive(),
            law.bristle().curve().negative(),
        );
        let mut p = vec![
            (law.bristle().stiffness() / pos.coulomb).ln(),
            (pos.static_friction / pos.coulomb - 1.0).ln(),
            pos.stribeck_velocity.ln(),
        ];
        if asymmetric {
            p.extend([
                (neg.coulomb / pos.coulomb).ln(),
                (neg.static_friction / neg.coulomb - 1.0).ln(),
                neg.stribeck_velocity.ln(),
            ]);
        }
        p.push(odds);
        let at = objective.evaluate(&p, true);
        assert!(
            objective.relative(at.cost) < 1e-12,
            "{:e}",
            objective.relative(at.cost)
        );
        // And nowhere near is as good.
        for i in 0..p.len() {
            let mut off = p.clone();
            off[i] += 0.05;
            let cost = objective.evaluate(&off, false).cost;
            assert!(objective.relative(cost) > 1e-5, "unknown {i}");
        }
    }
}

/// Six parameters and the break-away part to .1 % from data without noise, integrated twenty times finer than they are
/// sampled, by every seed and for every part.
#[test]
fn found_without_noise() {
    for (law, asymmetric) in [
        (axis(&MACHINE, 0.3), false),
        (axis(&MACHINE, 0.7), false),
        (axis(&MACHINE, 0.9), false),
        (lopsided(0.6), true),
    ] {
        let (v, u) = along(&law, 20_001, 1e-4, 20);
        let record = record(1e-4, v, u);
        let mut worst = (0.0, String::new());
        for seed in 0..if asymmetric { 2 } else { 5 } {
            let found = fit(&record, elasto_plastic(asymmetric), seed);
            for (name, truth) in truth(&law, asymmetric) {
                let error = (found.value(&name).unwrap() / truth - 1.0).abs();
                if error > worst.0 {
                    worst = (error, name.clone());
                }
                assert!(
                    error < 1e-3,
                    "part {}, seed {seed}: {name} off by {error:.1e}",
                    law.breakaway()
                );
            }
        }
        println!(
            "part {}: worst {:.1e} ({})",
            law.breakaway(),
            worst.0,
            worst.1
        );
    }
}

/// With noise, 95 % intervals hold the truth in most of many runs.
#[test]
fn intervals_hold_the_truth() {
    let law = axis(&MACHINE, 0.7);
    let (v, clean) = along(&law, 4001, 5e-4, 1);
    let (mut hits, mut all) = (0, 0);
    let mut ratio = (0, 0);
    for run in 0..100 {
        let mut noise = Noise::new(500 + run);
        let u = clean.iter().map(|u| u + 0.3 * noise.normal()).collect();
        let record = record(5e-4, v.clone(), u);
        // That the search is global is tested above; here it only has to be quick.
        let p = [
            6000_f64.ln(),
            0.5_f64.ln(),
            5e-3_f64.ln(),
            (0.7_f64 / 0.3).ln(),
        ];
        let settings = Settings {
            bounds: Some(SearchBox::around(&p, 0.5)),
            scan: 4,
            starts: 1,
            ..Settings::default()
        };
        let found = separable(
            &record,
            elasto_plastic(false),
            &terms(),
            &settings,
            &mut Silent,
        );
        let found = estimate(
            &record,
            elasto_plastic(false),
            &terms(),
            &found.unwrap(),
            1e-3,
        );
        for (name, truth) in truth(&law, false) {
            let p = found.parameter(&name).unwrap();
            if let Some((low, high)) = at_once(p) {
                let inside = u32::from(low <= truth && truth <= high);
                hits += inside;
                all += 1;
                if name == "breakaway_ratio" {
                    ratio = (ratio.0 + inside, ratio.1 + 1);
                    assert!(0.0 < low && high < 1.0);
                }
            }
        }
    }
    println!(
        "{hits} of {all} intervals, {} of {} of the break-away part",
        ratio.0, ratio.1
    );
    assert!(all > 600, "only {all} intervals");
    assert!(f64::from(hits) > 0.9 * f64::from(all), "{hits} of {all}");
    assert!(
        ratio.1 > 90 && f64::from(ratio.0) > 0.85 * f64::from(ratio.1),
        "{ratio:?}"
    );
}

/// Held-out error tells it from LuGre, in both directions.
#[test]
fn held_out_error_names_the_law() {
    let held_out = |record: &Record, kind| {
        let law = Law::new(kind);
        let found = separable(record, law, &terms(), &Settings::default(), &mut Silent).unwrap();
        let fitted = estimate(record, law, &terms(), &found, 1e-3);
        cross_validate(record, &fitted, &found, 4, &mut Silent)
            .held_out
            .unwrap()
            .rmse
    };
    let noisy = |clean: Vec<f64>| {
        let mut noise = Noise::new(21);
        clean.iter().map(|u| u + 0.2 * noise.normal()).collect()
    };
    let (v, u) = along(&axis(&MACHINE, 0.7), 8000, 5e-4, 4);
    let truly = record(5e-4, v.clone(), noisy(u));
    let right = held_out(&truly, LawKind::ElastoPlastic);
    let wrong = held_out(&truly, LawKind::LuGre);
    assert!(
        (right / 0.2 - 1.0).abs() < 0.05,
        "noise of .2 N, held out {right}"
    );
    assert!(wrong > 1.5 * right, "{wrong} against {right}");

    let (v, u) = common::force_along(&MACHINE.law(), 8000, 5e-4, 4, motion);
    let other = record(5e-4, v, noisy(u));
    let right = held_out(&other, LawKind::LuGre);
    let wrong = held_out(&other, LawKind::ElastoPlastic);
    assert!(wrong > 1.2 * right, "{wrong} against {right}");
}

/// What a fit predicts on another motion is what the friction crate says there.
#[test]
fn prediction_is_the_law() {
    let law = axis(&MACHINE, 0.5);
    let (v, u) = along(&law, 8000, 5e-4, 1);
    let fitted = fit(&record(5e-4, v, u), elasto_plastic(false), 0);
    let v: Vec<f64> = (0..6000)
        .map(|i| 0.7 * motion(3.0 - 5e-4 * f64::from(i)))
        .collect();
    let mut z = 0.0;
    let force: Vec<f64> = (0..v.len())
        .map(|i| {
            if i > 0 {
                z = law.step_record(z, 5e-4, v[i - 1], v[i]);
            }
            law.force(z, v[i])
        })
        .collect();
    let unseen = record(5e-4, v, force.clone());
    for (model, force) in predict(&unseen, &fitted).model.iter().zip(&force) {
        assert!(
            (model - force).abs() < 1e-6 * MACHINE.fixed,
            "{model} {force}"
        );
    }
}

/// A closed loop as a drive logs it: encoder of 100 nm, noise on the force, mass and offset unknown. The velocity that
/// drives the law is what the filters leave of the position.
#[test]
fn found_in_a_closed_loop() {
    use stiction_servo::cascade::Cascade;
    use stiction_servo::closed_loop::{ClosedLoop, ForceLog};
    use stiction_servo::encoder::Encoder;
    use stiction_servo::{known, path::Path, plant::Plant};

    let axis = known::find("machine").unwrap();
    let law = ElastoPlastic::new(axis.law, 0.7).unwrap();
    let log = ClosedLoop {
        plant: Plant::new(axis.mass, law).unwrap(),
        controller: Cascade::tuned(axis.mass, 50.0, 500.0).unwrap(),
        path: Path::three_segments(0.196, 9.0).unwrap(),
        encoder: Encoder::new(100e-9).unwrap(),
        rate: 4000.0,
        substeps: 5,
        force_noise: 0.2,
        force_log: ForceLog::Centred,
        seed: 3,
    }
    .run()
    .unwrap();
    let samples = stiction_identify::Samples {
        time: log.time,
        position: Some(log.position),
        force: log.force,
        ..Default::default()
    };
    let record = stiction_identify::condition(&[samples], &Default::default()).unwrap();
    let law_to_fit = elasto_plastic(false);
    let terms = Terms::default();
    let found = separable(
        &record,
        law_to_fit,
        &terms,
        &Settings::default(),
        &mut Silent,
    )
    .unwrap();
    let fitted = estimate(&record, law_to_fit, &terms, &found, 1e-3);
    for (name, truth) in truth(&law, false)
        .into_iter()
        .chain([("mass".to_string(), axis.mass)])
    {
        let p = fitted.parameter(&name).unwrap();
        let off = p.value / truth - 1.0;
        println!("{name}: {:+.2} %, {:?}", 100.0 * off, p.ci95);
        assert!(off.abs() < 0.02, "{name} = {}, not {truth}", p.value);
    }
}
