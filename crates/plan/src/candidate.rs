//! An axis that may be the one to be measured.

use stiction_friction::{Damping, Direction, LuGre, ParamError, Shape, Stribeck};

/// Parameters that a plan is made for: those of LuGre with the Gaussian curve, and the mass.
pub const PARAMETERS: usize = 7;
/// Their names, in the order of [`Candidate::values`].
pub const NAMES: [&str; PARAMETERS] = [
    "sigma0",
    "sigma1",
    "sigma2",
    "coulomb",
    "static",
    "stribeck_velocity",
    "mass",
];

/// An axis with its friction; all > 0, Fs above Fc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// N/m (N m/rad)
    pub sigma0: f64,
    /// N s/m (N m s/rad)
    pub sigma1: f64,
    /// N s/m (N m s/rad)
    pub sigma2: f64,
    /// N (N m)
    pub coulomb: f64,
    /// N (N m)
    pub static_friction: f64,
    /// m/s (rad/s)
    pub stribeck_velocity: f64,
    /// kg (kg m^2)
    pub mass: f64,
}

impl Candidate {
    /// From the values in the order of [`NAMES`].
    pub fn from_values(values: [f64; PARAMETERS]) -> Self {
        let [
            sigma0,
            sigma1,
            sigma2,
            coulomb,
            static_friction,
            stribeck_velocity,
            mass,
        ] = values;
        Candidate {
            sigma0,
            sigma1,
            sigma2,
            coulomb,
            static_friction,
            stribeck_velocity,
            mass,
        }
    }

    /// In the order of [`NAMES`].
    pub fn values(&self) -> [f64; PARAMETERS] {
        [
            self.sigma0,
            self.sigma1,
            self.sigma2,
            self.coulomb,
            self.static_friction,
            self.stribeck_velocity,
            self.mass,
        ]
    }

    /// Fs/Fc - 1
    pub fn excess(&self) -> f64 {
        self.static_friction / self.coulomb - 1.0
    }

    /// Refuses values that are no such axis.
    pub fn validate(&self) -> Result<(), ParamError> {
        for (name, value) in NAMES.into_iter().zip(self.values()) {
            ParamError::positive(name, value)?;
        }
        if self.static_friction <= self.coulomb {
            let allowed = "above Coulomb friction";
            return Err(ParamError::new("static", self.static_friction, allowed));
        }
        self.law().map(|_| ())
    }

    /// Its law.
    pub fn law(&self) -> Result<LuGre<f64>, ParamError> {
        let both = Direction {
            coulomb: self.coulomb,
            static_friction: self.static_friction,
            stribeck_velocity: self.stribeck_velocity,
            viscous: self.sigma2,
        };
        let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0)?;
        LuGre::new(self.sigma0, Damping::Constant(self.sigma1), curve)
    }
}
