//! Records and candidates for the tests.
#![allow(dead_code)]

use proptest::prelude::*;
use stiction_lanes::{Candidate, Segment, Time, Track, Trial};

/// A sine that starts at rest and passes through zero between samples.
pub fn sine(samples: usize, step: f64, amplitude: f64, hertz: f64) -> Vec<f64> {
    let w = 2.0 * std::f64::consts::PI * hertz * step;
    (0..samples)
        .map(|k| amplitude * libm::sin(w * (k as f64 + 0.31)))
        .collect()
}

/// Something to be measured, no model's output.
pub fn force(velocity: &[f64]) -> Vec<f64> {
    velocity
        .iter()
        .enumerate()
        .map(|(k, v)| 19.0 * v.signum() + 50.0 * v + libm::sin(k as f64))
        .collect()
}

/// A track of one segment.
pub fn track(step: f64, velocity: &[f64], force: &[f64]) -> Track {
    Track::new(&[Segment {
        time: Time::Step(step),
        velocity,
        force,
        keep: &[],
        columns: &[],
    }])
    .unwrap()
}

/// Candidates spread over decades, by a fixed rule; every third with an exponent of its own.
pub fn spread(count: usize, exponents: bool) -> Vec<Candidate> {
    (0..count)
        .map(|i| {
            let u =
                |k: usize| 2.0 * ((i * (2 * k + 3) + k) as f64 * 0.618_033_988_749_895 % 1.0) - 1.0;
            let by = |k: usize, decades: f64| libm::exp(std::f64::consts::LN_10 * decades * u(k));
            let coulomb = 20.0 * by(0, 0.5);
            Candidate {
                stiffness: 1.2e5 * by(1, 2.0),
                micro_damping: 600.0 * by(2, 1.0),
                viscous: 60.0 * by(3, 1.0),
                coulomb,
                static_friction: coulomb * (1.0 + by(4, 1.0)),
                stribeck_velocity: 5e-3 * by(5, 1.0),
                exponent: if exponents && i % 3 == 1 {
                    1.0 + 0.5 * u(6)
                } else {
                    2.0
                },
            }
        })
        .collect()
}

/// Any law.
pub fn candidate() -> impl Strategy<Value = Candidate> {
    (
        -2.0..12.0,
        0.0..1e4,
        0.0..1e3,
        -3.0..4.0,
        0.0..4.0,
        -6.0..2.0,
        prop_oneof![Just(2.0), 0.3..4.0],
    )
        .prop_map(|(s0, s1, s2, fc, ratio, vs, exponent)| {
            let ten = |x: f64| libm::pow(10.0, x);
            Candidate {
                stiffness: ten(s0),
                micro_damping: s1,
                viscous: s2,
                coulomb: ten(fc),
                static_friction: ten(fc) * (1.0 + ratio),
                stribeck_velocity: ten(vs),
                exponent,
            }
        })
}

/// Any motion, with standstills and reversals.
pub fn motion() -> impl Strategy<Value = Vec<f64>> {
    let v = prop_oneof![3 => -0.3..0.3_f64, 2 => -1e-3..1e-3_f64, 1 => Just(0.0)];
    prop::collection::vec(v, 2..200)
}

/// The nonlinear part of a candidate.
pub fn trial(c: &Candidate) -> Trial {
    Trial {
        ln_kappa: libm::log(c.stiffness / c.coulomb),
        ln_excess: libm::log(c.static_friction / c.coulomb - 1.0),
        ln_velocity: libm::log(c.stribeck_velocity),
        exponent: c.exponent,
    }
}
