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
