//! The record that is searched: three seconds of a sine at 10 kHz, and the force with noise.

use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use std::f64::consts::TAU;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};

/// One sample, or a zero of the velocity put between two.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Since the point before, s.
    pub step: f64,
    /// m/s
    pub velocity: f64,
    /// Direction of motion since the point before.
    pub sign: f64,
    /// Measured force, N.
    pub force: f64,
    /// 1 for a sample, 0 for a zero crossing.
    pub weight: f64,
}

/// A velocity record with its zero crossings put in, so that no step changes its direction.
pub struct Record {
    pub points: Vec<Point>,
    /// Samples that count.
    pub counted: f64,
}

pub const STEP: f64 = 1e-4;
const SAMPLES: usize = 30_001;
/// Deviation of the noise over the largest force.
const NOISE: f64 = 0.01;

pub fn velocity(t: f64) -> f64 {
    0.05 * (TAU * t).sin()
}

/// Parameters `[sigma0, sigma1, sigma2, Fc, Fs, vs]` of the two axes, SI.
pub const SETS: [(&str, [f64; 6]); 2] = [
    ("paper", [1e5, 316.2, 0.4, 1.0, 1.5, 0.001]),
    ("machine", [1.2e5, 600.0, 60.0, 20.0, 30.0, 0.005]),
];

pub fn law(p: &[f64; 6]) -> LuGre<f64> {
    let side = Direction {
        coulomb: p[3],
        static_friction: p[4],
        stribeck_velocity: p[5],
        viscous: p[2],
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, side, 0.0).expect("a curve");
    LuGre::new(p[0], Damping::Constant(p[1]), curve).expect("a law")
}

/// Force at every sample, with `over` steps of the law between two.
pub fn forces(p: &[f64; 6], over: usize) -> Vec<f64> {
    let law = law(p);
    let (h, mut z) = (STEP / over as f64, 0.0);
    let at = |k: usize, i: usize| velocity(STEP * (k as f64 + i as f64 / over as f64));
    (0..SAMPLES)
        .map(|k| {
            if k > 0 {
                for i in 0..over {
                    z = law.step_record(z, h, at(k - 1, i), at(k - 1, i + 1));
                }
            }
            law.force(z, velocity(STEP * k as f64))
        })
        .collect()
}

/// The measured force: fifty steps a sample, and white noise.
pub fn measured(p: &[f64; 6], seed: u64) -> Vec<f64> {
    let clean = forces(p, 50);
    let largest = clean.iter().fold(0.0f64, |a, f| a.max(f.abs()));
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut unit = || (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let noise = |f: &f64| {
        let radius = (-2.0 * (1.0 - unit()).ln()).sqrt();
        f + NOISE * largest * radius * (TAU * unit()).cos()
    };
    clean.iter().map(noise).collect()
}

impl Record {
    /// One sample in `every`, from the first.
    pub fn new(force: &[f64], every: usize) -> Self {
        let mut points: Vec<Point> = Vec::new();
        let step = STEP * every as f64;
        for (k, &force) in force.iter().enumerate().step_by(every) {
            let now = velocity(STEP * k as f64);
            let mut rest = step;
            if let Some(&Point {
                velocity: before, ..
            }) = points.last()
            {
                if before * now < 0.0 {
                    let share = before / (before - now);
                    points.push(Point {
                        step: share * step,
                        velocity: 0.0,
                        sign: before.signum(),
                        force: 0.0,
                        weight: 0.0,
                    });
                    rest = (1.0 - share) * step;
                }
                let sign = if now != 0.0 { now } else { before }.signum();
                points.push(Point {
                    step: rest,
                    velocity: now,
                    sign,
                    force,
                    weight: 1.0,
                });
            } else {
                points.push(Point {
                    step: 0.0,
                    velocity: now,
                    sign: 1.0,
                    force,
                    weight: 1.0,
                });
            }
        }
        let counted = points.iter().map(|p| p.weight).sum();
        Self { points, counted }
    }
}
