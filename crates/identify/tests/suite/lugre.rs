//! Six LuGre parameters from 30 001 samples, by every seed, from boxes of four decades.

use crate::common;
use crate::common::{C95, MACHINE, MOTOR, Noise, Set, record, sine_record};
use stiction_identify::{
    Law, LawKind, Mass, Objective, SearchBox, Settings, Silent, Status, Terms, estimate, separable,
};

const SEEDS: u64 = 100;

fn friction_only() -> Terms {
    Terms {
        mass: Mass::Absent,
        offset: false,
        gravity: false,
        cogging: Vec::new(),
        ..Terms::default()
    }
}

/// Two decades to each side of a point that is off the truth.
fn four_decades(set: &Set) -> SearchBox {
    let truth = [
        (set.sigma0 / set.coulomb).ln() + 0.4,
        (set.fixed / set.coulomb - 1.0).ln() - 0.3,
        set.velocity.ln() + 0.5,
    ];
    SearchBox::around(&truth, 2.0)
}

fn noise_free(set: &Set) {
    let (v, u) = sine_record(set);
    let record = record(1e-4, v, u);
    let law = Law::new(LawKind::LuGre);
    let terms = friction_only();
    let mut worst: (f64, &str) = (0.0, "");
    let mut evaluations = 0;
    for seed in 0..SEEDS {
        let settings = Settings {
            seed,
            bounds: Some(four_decades(set)),
            ..Settings::default()
        };
        let found = separable(&record, law, &terms, &settings, &mut Silent).unwrap();
        assert_eq!(found.status, Status::Converged, "{} seed {seed}", set.name);
        evaluations += found.counts.total() - found.counts.coarse();
        let estimate = estimate(&record, law, &terms, &found, 0.0);
        for (name, truth) in set.truth() {
            let error = (estimate.value(name).unwrap() / truth - 1.0).abs();
            if error > worst.0 {
                worst = (error, name);
            }
            assert!(
                error < 1e-5,
                "{} seed {seed}: {name} is off by {error:.2e}",
                set.name
            );
        }
    }
    println!(
        "{}: worst error {:.2e} % ({}), {:.1} full-record evaluations a run",
        set.name,
        100.0 * worst.0,
        worst.1,
        evaluations as f64 / SEEDS as f64
    );
}

#[test]
fn c95_noise_free_by_every_seed() {
    noise_free(&C95);
}

#[test]
fn machine_noise_free_by_every_seed() {
    noise_free(&MACHINE);
}

#[test]
fn motor_noise_free_by_every_seed() {
    noise_free(&MOTOR);
}

/// With noise the data have their own optimum: the one that a descent from the truth reaches.
fn noisy(set: &Set) {
    let (v, clean) = sine_record(set);
    let law = Law::new(LawKind::LuGre);
    let terms = friction_only();
    let truth = [
        (set.sigma0 / set.coulomb).ln(),
        (set.fixed / set.coulomb - 1.0).ln(),
        set.velocity.ln(),
    ];
    let mut worst: f64 = 0.0;
    for seed in 0..SEEDS {
        let mut noise = Noise::new(seed + 1);
        let u = clean
            .iter()
            .map(|f| f + 0.01 * set.coulomb * noise.normal())
            .collect();
        let record = record(1e-4, v.clone(), u);
        let settings = Settings {
            seed,
            bounds: Some(four_decades(set)),
            ..Settings::default()
        };
        let found = separable(&record, law, &terms, &settings, &mut Silent).unwrap();
        // A box so small that only the basin of the truth is in it.
        let local = Settings {
            bounds: Some(SearchBox::around(&truth, 0.2)),
            ..Settings::default()
        };
        let best = separable(&record, law, &terms, &local, &mut Silent).unwrap();
        let excess = found.evaluation.cost / best.evaluation.cost - 1.0;
        worst = worst.max(excess);
        assert!(
            excess < 1e-6,
            "{} seed {seed}: cost above the optimum by {excess:.2e}",
            set.name
        );
    }
    println!(
        "{}: worst relative excess of the cost {worst:.2e}",
        set.name
    );
}

#[test]
fn c95_noisy_reaches_the_global_optimum() {
    noisy(&C95);
}

#[test]
fn machine_noisy_reaches_the_global_optimum() {
    noisy(&MACHINE);
}

#[test]
fn motor_noisy_reaches_the_global_optimum() {
    noisy(&MOTOR);
}

/// The reduced gradient equals central differences of the cost, for every law.
#[test]
fn gradient_matches_finite_differences() {
    let (v, u) = sine_record(&MACHINE);
    let v: Vec<f64> = v.into_iter().step_by(10).collect();
    let u: Vec<f64> = u.into_iter().step_by(10).collect();
    let record = record(1e-3, v, u);
    let terms = Terms {
        mass: Mass::Absent,
        ..Terms::default()
    };
    for kind in LawKind::ALL {
        for law in [Law::new(kind), Law::new(kind).asymmetric()] {
            // The Maxwell-slip laws have a test of their own.
            if law.nonlinear() == 0 || kind.has_elements() {
                continue;
            }
            let start: &[f64] = match (kind, law.asymmetric) {
                (LawKind::Dahl, false) => &[8.2],
                (LawKind::Dahl, true) => &[8.2, 0.1],
                (LawKind::Stribeck, false) => &[-0.5, -5.0],
                (LawKind::Stribeck, true) => &[-0.5, -5.0, 0.1, -0.8, -4.8],
                (LawKind::ElastoPlastic, false) => &[8.2, -0.5, -5.0, 0.4],
                (LawKind::ElastoPlastic, true) => &[8.2, -0.5, -5.0, 0.1, -0.8, -4.8, 0.4],
                (_, false) => &[8.2, -0.5, -5.0],
                (_, true) => &[8.2, -0.5, -5.0, 0.1, -0.8, -4.8],
            };
            let objective = Objective::new(&record, law, &terms);
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
                    "{kind} {}: unknown {i}: {} against {numeric}",
                    law.asymmetric,
                    slope[i]
                );
            }
        }
    }
}

/// The asymmetric law finds each direction's own parameters, and an offset and a mass beside them.
#[test]
fn asymmetric_with_mass_and_offset() {
    use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
    let side = |c: f64, s: f64, vs: f64, d: f64| Direction {
        coulomb: c,
        static_friction: s,
        stribeck_velocity: vs,
        viscous: d,
    };
    let pos = side(20.0, 30.0, 5e-3, 60.0);
    let neg = side(24.0, 31.0, 4e-3, 80.0);
    let curve = Stribeck::new(Shape::Gaussian, pos, neg, 2.0).unwrap();
    let law = LuGre::new(1.2e5, Damping::Constant(600.0), curve).unwrap();
    let w = std::f64::consts::TAU;
    let motion = |t: f64| 0.04 * (w * t).sin() + 0.015 * (w * 6.5 * t).sin();
    let (v, friction) = common::force_along(&law, 30_001, 1e-4, 20, motion);
    let u = friction
        .iter()
        .enumerate()
        .map(|(i, f)| {
            let t = i as f64 * 1e-4;
            f + 10.0 * (0.04 * w * (w * t).cos() + 0.015 * 6.5 * w * (w * 6.5 * t).cos())
        })
        .collect();
    let record = record(1e-4, v, u);
    let law = Law::new(LawKind::LuGre).asymmetric();
    let found = separable(
        &record,
        law,
        &Terms::default(),
        &Settings::default(),
        &mut Silent,
    )
    .unwrap();
    let estimate = estimate(&record, law, &Terms::default(), &found, 0.0);
    for (name, truth) in [
        ("sigma0", 1.2e5),
        ("sigma1", 600.0),
        ("coulomb_pos", 20.0),
        ("coulomb_neg", 24.0),
        ("static_pos", 30.0),
        ("static_neg", 31.0),
        ("stribeck_velocity_pos", 5e-3),
        ("stribeck_velocity_neg", 4e-3),
        ("sigma2_pos", 60.0),
        ("sigma2_neg", 80.0),
        ("mass", 10.0),
        ("offset", 2.0),
    ] {
        let value = estimate.value(name).unwrap();
        // The acceleration is a difference of the velocity: (w h)^2/6 of it at 6.5 Hz is 3e-6.
        assert!(
            (value / truth - 1.0).abs() < 2e-4,
            "{name} = {value} instead of {truth}"
        );
    }
}
