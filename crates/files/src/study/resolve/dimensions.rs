//! Dimensions of what a study file gives.

use stiction_formats::Dimension;
use stiction_log::Motion;
use stiction_parameters::{Dimension as Measured, Quantity};

/// Dimensions that depend on the kind of axis.
pub(in crate::study) struct Dimensions {
    pub length: Dimension,
    pub speed: Dimension,
    pub force: Dimension,
    pub mass: Dimension,
}

impl Dimensions {
    pub fn of(motion: Motion) -> Self {
        Dimensions {
            length: motion.position(),
            speed: motion.velocity(),
            force: motion.force(),
            mass: match motion {
                Motion::Linear => Dimension::MASS,
                Motion::Rotary => Dimension::INERTIA,
            },
        }
    }

    /// That of a parameter of the law.
    pub fn of_parameter(&self, quantity: Quantity) -> Dimension {
        match quantity.dimension() {
            Measured::Stiffness => Self::per(self.force, self.length),
            Measured::Damping => Self::per(self.force, self.speed),
            Measured::Speed => self.speed,
            Measured::One => Dimension::ONE,
            _ => self.force,
        }
    }

    /// `a` over `b`; the dimensions here are far from overflow.
    pub fn per(a: Dimension, b: Dimension) -> Dimension {
        a.per(b).unwrap_or(a)
    }
}
