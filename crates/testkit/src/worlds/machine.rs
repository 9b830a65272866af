//! Axes with parameters of their own for every seed.

pub(super) mod drawn;

use crate::random::Random;

/// Part of its value by which a parameter is at most above or below that of its kind of axis, as a logarithm.
const SPREAD: f64 = 0.2;

/// A servo axis: a mass (kg; inertia, kg m^2) with LuGre friction under a cascade. SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Machine {
    /// `linear` or `rotary`.
    pub kind: &'static str,
    /// Bristle stiffness, N/m.
    pub sigma0: f64,
    /// Bristle damping, N s/m.
    pub sigma1: f64,
    /// Viscous friction, N s/m.
    pub sigma2: f64,
    /// Coulomb friction, N.
    pub coulomb: f64,
    /// Static friction, N.
    pub static_friction: f64,
    /// Stribeck velocity, m/s.
    pub stribeck_velocity: f64,
    /// Moved mass, kg.
    pub mass: f64,
    /// Highest speed of the motions, m/s.
    pub top_speed: f64,
    /// Acceleration of moves, m/s^2.
    pub acceleration: f64,
    /// Encoder count, m.
    pub count: f64,
    /// Sampling rate of controller and log, Hz.
    pub rate: f64,
    /// Standard deviation of the noise of the logged force, N.
    pub noise: f64,
    /// Bandwidth of the speed loop, Hz.
    pub bandwidth: f64,
    /// Frequency of the fast segment of the commissioning motion, Hz.
    pub fast: f64,
}

impl Machine {
    /// A stage with a linear motor: 50 nm, 4 kHz.
    pub fn stage(seed: u64) -> Self {
        Machine {
            kind: "linear",
            sigma0: 1.5e6,
            sigma1: 1.5e3,
            sigma2: 40.0,
            coulomb: 14.0,
            static_friction: 20.0,
            stribeck_velocity: 4e-3,
            mass: 4.6,
            top_speed: 0.2,
            acceleration: 4.0,
            count: 50e-9,
            rate: 4000.0,
            noise: 0.5,
            bandwidth: 60.0,
            fast: 25.0,
        }
        .varied(seed)
    }

    /// A table on a ball screw: 100 nm, 2 kHz.
    pub fn screw(seed: u64) -> Self {
        Machine {
            kind: "linear",
            sigma0: 2.5e7,
            sigma1: 1.5e4,
            sigma2: 600.0,
            coulomb: 120.0,
            static_friction: 170.0,
            stribeck_velocity: 3e-3,
            mass: 60.0,
            top_speed: 0.15,
            acceleration: 2.0,
            count: 100e-9,
            rate: 2000.0,
            noise: 2.0,
            bandwidth: 35.0,
            fast: 15.0,
        }
        .varied(seed)
    }

    /// A rotary joint, direct drive: 2^19 counts a turn, 1 kHz.
    pub fn joint(seed: u64) -> Self {
        Machine {
            kind: "rotary",
            sigma0: 4000.0,
            sigma1: 12.0,
            sigma2: 0.8,
            coulomb: 4.0,
            static_friction: 5.6,
            stribeck_velocity: 0.04,
            mass: 0.12,
            top_speed: 2.0,
            acceleration: 20.0,
            count: std::f64::consts::TAU / 524_288.0,
            rate: 1000.0,
            noise: 0.05,
            bandwidth: 18.0,
            fast: 8.0,
        }
        .varied(seed)
    }

    /// The three of a seed, with their names.
    pub fn all(seed: u64) -> [(&'static str, Self); 3] {
        [
            ("stage", Self::stage(seed)),
            ("screw", Self::screw(seed)),
            ("joint", Self::joint(seed)),
        ]
    }

    /// The same axis with friction that is so many times what it was.
    #[must_use]
    pub fn with_friction(self, factor: f64) -> Self {
        Self {
            sigma0: factor * self.sigma0,
            sigma1: factor * self.sigma1,
            sigma2: factor * self.sigma2,
            coulomb: factor * self.coulomb,
            static_friction: factor * self.static_friction,
            ..self
        }
    }

    /// Every parameter moved at random; the difference of Fs and Fc as one of them.
    fn varied(mut self, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let mut factor = || (SPREAD * (2.0 * random.uniform() - 1.0)).exp();
        let rise = (self.static_friction - self.coulomb) * factor();
        for p in [
            &mut self.sigma0,
            &mut self.sigma1,
            &mut self.sigma2,
            &mut self.coulomb,
            &mut self.stribeck_velocity,
            &mut self.mass,
        ] {
            *p *= factor();
        }
        self.static_friction = self.coulomb + rise;
        self
    }

    /// Steady friction at a speed (m/s, not negative) without its viscous part, N; the fall-off has the exponent 2, or
    /// `exponent`.
    pub(super) fn level(&self, speed: f64, exponent: f64) -> f64 {
        let rise = self.static_friction - self.coulomb;
        let ratio = speed / self.stribeck_velocity;
        let power = if exponent == 2.0 {
            ratio * ratio
        } else {
            ratio.powf(exponent)
        };
        self.coulomb + rise * (-power).exp()
    }

    /// The parameters that an identification of LuGre looks for, by name.
    pub fn truth(&self) -> [(&'static str, f64); 7] {
        [
            ("sigma0", self.sigma0),
            ("sigma1", self.sigma1),
            ("sigma2", self.sigma2),
            ("coulomb", self.coulomb),
            ("static", self.static_friction),
            ("stribeck_velocity", self.stribeck_velocity),
            ("mass", self.mass),
        ]
    }
}
