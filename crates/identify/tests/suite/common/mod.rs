//! Records with known truth: a velocity that is a closed formula, the force by the friction crate on
//! a far finer grid than the record.
#![allow(dead_code)]

pub mod chance;
pub mod closed_loop;
pub mod maxwell;
pub mod trials;

use std::f64::consts::TAU;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_identify::{Conditioning, Cutoff, Record, Samples, condition};

/// Parameters of a LuGre axis.
#[derive(Clone, Copy, Debug)]
pub struct Set {
    pub name: &'static str,
    pub sigma0: f64,
    pub sigma1: f64,
    pub sigma2: f64,
    pub coulomb: f64,
    pub fixed: f64,
    pub velocity: f64,
    /// Amplitude of the velocity sine, m/s.
    pub amplitude: f64,
}

pub const C95: Set = Set {
    name: "C95",
    sigma0: 1e5,
    sigma1: 316.227_766_016_837_94,
    sigma2: 0.4,
    coulomb: 1.0,
    fixed: 1.5,
    velocity: 1e-3,
    amplitude: 10e-3,
};
pub const MACHINE: Set = Set {
    name: "machine",
    sigma0: 1.2e5,
    sigma1: 600.0,
    sigma2: 60.0,
    coulomb: 20.0,
    fixed: 30.0,
    velocity: 5e-3,
    amplitude: 10e-3,
};
pub const MOTOR: Set = Set {
    name: "motor",
    sigma0: 2e6,
    sigma1: 1.5e3,
    sigma2: 30.0,
    coulomb: 12.0,
    fixed: 18.0,
    velocity: 3e-3,
    amplitude: 10e-3,
};

impl Set {
    pub fn law(&self) -> LuGre<f64> {
        let both = Direction {
            coulomb: self.coulomb,
            static_friction: self.fixed,
            stribeck_velocity: self.velocity,
            viscous: self.sigma2,
        };
        let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0).unwrap();
        LuGre::new(self.sigma0, Damping::Constant(self.sigma1), curve).unwrap()
    }

    pub fn truth(&self) -> [(&'static str, f64); 6] {
        [
            ("sigma0", self.sigma0),
            ("sigma1", self.sigma1),
            ("sigma2", self.sigma2),
            ("coulomb", self.coulomb),
            ("static", self.fixed),
            ("stribeck_velocity", self.velocity),
        ]
    }
}

/// Force of a law along a velocity given as a function of time, with `fine` steps a sample.
pub fn force_along(
    law: &LuGre<f64>,
    n: usize,
    step: f64,
    fine: usize,
    velocity: impl Fn(f64) -> f64,
) -> (Vec<f64>, Vec<f64>) {
    let h = step / fine as f64;
    let mut z = 0.0;
    let (mut v, mut u) = (Vec::with_capacity(n), Vec::with_capacity(n));
    for i in 0..n {
        if i > 0 {
            for k in 0..fine {
                let t = (i - 1) as f64 * step + k as f64 * h;
                z = law.step_record(z, h, velocity(t), velocity(t + h));
            }
        }
        let now = velocity(i as f64 * step);
        v.push(now);
        u.push(law.force(z, now));
    }
    (v, u)
}

/// 30 001 samples of 3 s at 10 kHz, a velocity sine of 1 Hz.
pub fn sine_record(set: &Set) -> (Vec<f64>, Vec<f64>) {
    force_along(&set.law(), 30_001, 1e-4, 20, |t| {
        set.amplitude * (TAU * t).sin()
    })
}

/// A record from velocity and force, unfiltered.
pub fn record(step: f64, v: Vec<f64>, u: Vec<f64>) -> Record {
    let samples = Samples {
        time: (0..v.len()).map(|i| i as f64 * step).collect(),
        position: None,
        velocity: Some(v),
        force: u,
        ..Samples::default()
    };
    let raw = Conditioning {
        source_cutoff: Cutoff::Off,
        common_cutoff: Cutoff::Off,
        ..Conditioning::default()
    };
    condition(&[samples], &raw).unwrap()
}

/// Deterministic standard normal numbers (xorshift and Box-Muller), so that tests need no crate.
pub struct Noise(u64);

impl Noise {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn normal(&mut self) -> f64 {
        let r = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        r * (TAU * self.uniform()).cos()
    }
}
