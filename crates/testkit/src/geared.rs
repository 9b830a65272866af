//! A joint behind a gear whose friction grows with the torque that it transmits, under its own weight and a torque from outside.
//!
//! Nothing here is the plant that identification assumes. Without a bristle friction is set-valued, as Duclusaud, Passault and
//! Ly (2025, arXiv 2410.08650) simulate servo motors: what would stop the joint in this step, as far as the level lets it. With
//! one it is that of the bristle by small explicit steps.

use crate::random::Random;
use std::f64::consts::TAU;

/// Steps of the simulation in a control period.
const FINE: usize = 40;
/// Control period and time between samples, s.
const PERIOD: f64 = 1e-3;

/// What the level of friction is in proportion to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Proportion {
    /// What the load asks for: its weight less what acts from outside.
    Load,
    /// The published law: the difference of the motor's torque and what acts on the load, both counted towards positive angles.
    Published,
}

/// The joint; torques in N m.
#[derive(Clone, Copy, Debug)]
pub struct Geared {
    /// kg m^2, the rotor's counted in.
    pub inertia: f64,
    /// Amplitudes of the weight, of the sine and the cosine of the angle.
    pub weight: [f64; 2],
    /// Coulomb level without load.
    pub coulomb: f64,
    /// Static over Coulomb level, and the Stribeck velocity, rad/s.
    pub stribeck: (f64, f64),
    /// N m s/rad.
    pub viscous: f64,
    /// Level for each N m that is transmitted while the motor drives, and while the load drives.
    pub per_torque: [f64; 2],
    /// What it is in proportion to.
    pub proportion: Proportion,
    /// Stiffness of the bristle over the level, 1/rad, and its damping, N m s/rad; `None` for friction without one.
    pub bristle: Option<(f64, f64)>,
    /// Amplitude of what acts from outside.
    pub external: f64,
    /// Standard deviation of the torque that is logged.
    pub noise: f64,
    /// Encoder step, rad.
    pub encoder: f64,
}

/// What was logged, a sample each millisecond.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    /// s.
    pub time: Vec<f64>,
    /// rad.
    pub position: Vec<f64>,
    /// Torque of the motor.
    pub torque: Vec<f64>,
    /// Torque from outside.
    pub external: Vec<f64>,
    /// What the load asked for.
    pub load: Vec<f64>,
}

impl Default for Geared {
    fn default() -> Self {
        Self {
            inertia: 0.02,
            weight: [4.0, 0.6],
            coulomb: 0.3,
            stribeck: (1.0, 0.05),
            viscous: 0.15,
            per_torque: [0.12, 0.12],
            proportion: Proportion::Load,
            bristle: None,
            external: 0.0,
            noise: 0.02,
            encoder: 1e-5,
        }
    }
}

impl Geared {
    /// A recording of so many seconds of a motion that a seed draws.
    pub fn record(&self, seconds: f64, seed: u64) -> Recording {
        let mut random = Random::new(seed);
        let parts: Vec<(f64, f64, f64)> = [(0.9, 0.11), (0.5, 0.31), (0.2, 0.83)]
            .iter()
            .map(|(size, hz)| (*size, hz * (0.9 + 0.2 * random.uniform()), random.uniform()))
            .collect();
        let reference = |t: f64| {
            let each = parts.iter().map(|(size, hz, phase)| {
                let (sine, cosine) = (TAU * (hz * t + phase)).sin_cos();
                (size * sine, size * TAU * hz * cosine)
            });
            each.fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1))
        };
        let gust = random.uniform();
        let outside = |t: f64| self.external * (TAU * (0.17 * t + gust)).sin();
        let (mut q, mut w) = (reference(0.0).0, 0.0);
        let mut eta = 0.0;
        let h = PERIOD / FINE as f64;
        let mut out = Recording::default();
        for k in 0..(seconds / PERIOD) as usize {
            let t = k as f64 * PERIOD;
            let (at, speed) = reference(t);
            let motor = 120.0 * (at - q) + 3.0 * (speed - w);
            // As a drive logs: the position that it read, and the torque that it made of that and holds until the next.
            let read = (q / self.encoder).round() * self.encoder;
            let external = outside(t);
            out.time.push(t);
            out.position.push(read);
            out.torque.push(motor + self.noise * random.normal());
            out.external.push(external);
            out.load.push(self.weight(q) - external);
            for i in 0..FINE {
                let acts = outside(t + i as f64 * h) - self.weight(q);
                let friction = self.friction((w, &mut eta), motor, acts, h);
                w += h / self.inertia * (motor + acts - friction);
                q += h * w;
            }
        }
        out
    }

    fn weight(&self, q: f64) -> f64 {
        self.weight[0] * q.sin() + self.weight[1] * q.cos()
    }

    /// Level of friction in a direction.
    fn level(&self, direction: f64, w: f64, motor: f64, acts: f64) -> f64 {
        let of_load = match self.proportion {
            Proportion::Load => {
                let drives = -acts * direction > 0.0;
                self.per_torque[usize::from(!drives)] * acts.abs()
            }
            Proportion::Published => self.per_torque[0] * (motor - acts).abs(),
        };
        let (ratio, velocity) = self.stribeck;
        (self.coulomb + of_load) * (1.0 + (ratio - 1.0) * (-(w / velocity).powi(2)).exp())
    }

    fn friction(&self, (w, eta): (f64, &mut f64), motor: f64, acts: f64, h: f64) -> f64 {
        let slip = |direction| self.level(direction, w, motor, acts);
        match self.bristle {
            Some((kappa, damping)) => {
                let rest = self.level(*eta, 1e9, motor, acts);
                let rate = w - w.abs() * *eta * rest / slip(*eta);
                *eta += h * kappa * rate;
                rest * *eta + damping * rate + self.viscous * w
            }
            None => {
                let stop = motor + acts + self.inertia * w / h - self.viscous * w;
                let level = slip(stop);
                stop.clamp(-level, level) + self.viscous * w
            }
        }
    }
}
