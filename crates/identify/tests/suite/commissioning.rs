//! Logs of a commissioning: rests, then slow reversals, then fast strokes. Each regime is seen in a part of the log only.

use crate::common::{MACHINE, Noise};
use std::f64::consts::TAU;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_identify::{
    Conditioning, Cutoff, Law, LawKind, Samples, Settings, Silent, Terms, choose, condition,
    cross_validate, estimate, separable,
};

const STEP: f64 = 2e-3;
const SECONDS: f64 = 24.0;
const MASS: f64 = 5.0;
/// Steps of the simulation in a sample.
const FINE: u32 = 20;

/// Velocity, m/s, and acceleration, m/s^2.
fn motion(t: f64) -> [f64; 2] {
    let sine = |amplitude: f64, hertz: f64, start: f64| {
        let (w, at) = (TAU * hertz, t - start);
        [amplitude * (w * at).sin(), amplitude * w * (w * at).cos()]
    };
    match t {
        3.0..13.0 => sine(2.5e-3, 0.4, 3.0),
        15.0..21.0 => sine(0.15, 0.5, 15.0),
        _ => [0.0; 2],
    }
}

/// The law that the data choose on a log of LuGre with these levels backwards, relative to those forwards.
fn chosen(backwards: f64) -> (LawKind, bool) {
    let side = |factor: f64| Direction {
        coulomb: factor * MACHINE.coulomb,
        static_friction: factor * MACHINE.fixed,
        stribeck_velocity: MACHINE.velocity,
        viscous: MACHINE.sigma2,
    };
    let curve = Stribeck::new(Shape::Gaussian, side(1.0), side(backwards), 0.0).unwrap();
    let law = LuGre::new(MACHINE.sigma0, Damping::Constant(MACHINE.sigma1), curve).unwrap();
    let mut noise = Noise::new(3);
    let many = (SECONDS / STEP) as usize;
    let h = STEP / f64::from(FINE);
    let mut z = 0.0;
    let mut samples = Samples::default();
    let mut velocity = Vec::new();
    for i in 0..many {
        let t = i as f64 * STEP;
        if i > 0 {
            for k in 0..FINE {
                let s = t - STEP + f64::from(k) * h;
                z = law.step_record(z, h, motion(s)[0], motion(s + h)[0]);
            }
        }
        let [v, a] = motion(t);
        samples.time.push(t);
        velocity.push(v);
        samples
            .force
            .push(law.force(z, v) + MASS * a + 0.2 * noise.normal());
    }
    samples.velocity = Some(velocity);
    let raw = Conditioning {
        source_cutoff: Cutoff::Off,
        common_cutoff: Cutoff::Off,
        ..Conditioning::default()
    };
    let record = condition(&[samples], &raw).unwrap();
    let scores: Vec<_> = [
        LawKind::CoulombViscous,
        LawKind::Stribeck,
        LawKind::Dahl,
        LawKind::LuGre,
    ]
    .into_iter()
    .flat_map(|kind| [Law::new(kind), Law::new(kind).asymmetric()])
    .map(|law| {
        let terms = Terms {
            offset: !law.asymmetric,
            ..Terms::default()
        };
        let found = separable(&record, law, &terms, &Settings::default(), &mut Silent).unwrap();
        let fitted = estimate(&record, law, &terms, &found, 1e-3);
        cross_validate(&record, &fitted, &found, 4, &mut Silent)
    })
    .collect();
    let standings = choose(&scores);
    for (score, standing) in scores.iter().zip(&standings) {
        let held_out = score.held_out.map(|f| f.relative_error_percent);
        println!("{:?}: {held_out:?} {standing:?}", score.law);
    }
    let best = standings.iter().position(|s| s.best).unwrap();
    (scores[best].law.kind, scores[best].law.asymmetric)
}

#[test]
fn a_log_of_regimes_in_turn_shows_its_law() {
    assert_eq!(chosen(1.0), (LawKind::LuGre, false));
}

#[test]
fn a_log_of_regimes_in_turn_shows_its_asymmetry() {
    assert_eq!(chosen(1.05), (LawKind::LuGre, true));
}

/// Fast strokes cross the whole Stribeck range within a few samples. The search sees it nevertheless, whatever the noise: it
/// does not end in a law without one, of which a descent on few samples never comes back.
#[test]
fn reversals_at_speed_show_the_stribeck_effect() {
    let both = Direction {
        coulomb: 21.6,
        static_friction: 30.0,
        stribeck_velocity: 4e-3,
        viscous: 45.0,
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0).unwrap();
    let law = LuGre::new(7.2e5, Damping::Constant(900.0), curve).unwrap();
    let wave = [
        (0.6, 0.41, 5.24),
        (0.28, 1.7, 3.75),
        (0.12, 5.3, 1.81),
        (0.03, 17.0, 0.27),
    ];
    let velocity = |t: f64| {
        let start = (t / 0.3).min(1.0);
        let sum = |(part, hertz, phase): (f64, f64, f64)| part * (TAU * hertz * t + phase).sin();
        0.2 * start * wave.into_iter().map(sum).sum::<f64>()
    };
    let (step, fine, count) = (5e-4, 20, 1e-7);
    let (v, u) = crate::common::force_along(&law, 28_001, step, fine, velocity);
    let h = step / fine as f64;
    let mut position = vec![0.0];
    for i in 1..v.len() {
        let from = (i - 1) as f64 * step;
        let moved: f64 = (0..fine)
            .map(|k| h * velocity(from + (k as f64 + 0.5) * h))
            .sum();
        position.push(position[i - 1] + moved);
    }
    for seed in 0..12 {
        let mut noise = Noise::new(seed);
        let phase = noise.uniform();
        let time: Vec<f64> = (0..v.len()).map(|i| i as f64 * step).collect();
        let accelerated = |t: f64| 8.0 * (velocity(t + 1e-5) - velocity(t - 1e-5)) / 2e-5;
        let samples = Samples {
            force: time
                .iter()
                .zip(&u)
                .map(|(t, u)| u + accelerated(*t) - 0.8 + 0.12 * noise.normal())
                .collect(),
            position: Some(
                position
                    .iter()
                    .map(|x| ((x / count + phase).round() - phase) * count)
                    .collect(),
            ),
            time,
            ..Samples::default()
        };
        let conditioning = Conditioning {
            resolution: Some(count),
            source_cutoff: Cutoff::Hz(400.0),
            common_cutoff: Cutoff::Hz(100.0),
            ..Conditioning::default()
        };
        let record = condition(&[samples], &conditioning).unwrap();
        let (law, terms) = (Law::new(LawKind::LuGre), Terms::default());
        let found = separable(&record, law, &terms, &Settings::default(), &mut Silent).unwrap();
        let fitted = estimate(&record, law, &terms, &found, count);
        let error = fitted.fit.relative_error_percent;
        assert!(error < 0.5, "{seed}: {error} % of the force left");
        let fixed = fitted.value("static").unwrap();
        assert!((fixed / 30.0 - 1.0).abs() < 0.02, "{seed}: Fs {fixed}");
    }
}
