//! Dimensions of what a study file gives.

use stiction_log::{Dimension, Motion};

/// Dimensions that depend on the kind of axis.
pub(super) struct Dimensions {
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

    /// `a` over `b`; the dimensions here are far from overflow.
    pub fn per(a: Dimension, b: Dimension) -> Dimension {
        a.per(b).unwrap_or(a)
    }
}
