//! Friction at constant velocity.

use crate::{Name, ParameterSet, Quantity, Side};
use stiction_friction::{Direction, Shape};

/// Friction at constant velocity of a set of parameters, offset left out, with its derivatives. Unlike a law it takes any
/// numbers: also a level of 0, and a static level that a correction has put below the Coulomb level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteadyCurve {
    shape: Shape<f64>,
    sides: [Direction<f64>; 2],
    /// Force per squared speed, of each direction.
    quadratic: [f64; 2],
    /// Whether the level falls with speed.
    falls: bool,
}

impl SteadyCurve {
    /// The curve of a set; what it does not hold is 0. Without a static level or a Stribeck velocity it is flat.
    pub fn of(set: &ParameterSet) -> Self {
        let value = |quantity, side| set.on(quantity, side).unwrap_or(0.0);
        let both = [Side::Positive, Side::Negative];
        let falls = both.iter().all(|&side| {
            value(Quantity::Static, side) != 0.0 && value(Quantity::StribeckVelocity, side) > 0.0
        });
        SteadyCurve {
            shape: set.shape(),
            sides: both.map(|side| {
                let coulomb = value(Quantity::Coulomb, side);
                let (level, velocity) = if falls {
                    let velocity = value(Quantity::StribeckVelocity, side);
                    (value(Quantity::Static, side), velocity)
                } else {
                    (coulomb, 1.0)
                };
                Direction {
                    coulomb,
                    static_friction: level,
                    stribeck_velocity: velocity,
                    viscous: value(Quantity::Sigma2, side),
                }
            }),
            quadratic: both.map(|side| value(Quantity::QuadraticViscous, side)),
            falls,
        }
    }

    fn side(&self, v: f64) -> usize {
        usize::from(v < 0.0)
    }

    /// Level without the viscous part, N (N m), at a velocity in m/s (rad/s).
    pub fn level(&self, v: f64) -> f64 {
        self.sides[self.side(v)].level(self.shape, v.abs())
    }

    /// Friction force, N (N m), at a velocity other than 0, m/s (rad/s).
    pub fn force(&self, v: f64) -> f64 {
        let side = self.side(v);
        let speed = self.sides[side].viscous + self.quadratic[side] * v.abs();
        self.level(v) * v.signum() + speed * v
    }

    /// Derivative of the force at a velocity other than 0 with respect to a parameter; 0 for one that it does not depend on.
    pub fn slope(&self, name: Name, v: f64) -> f64 {
        if !name.holds_for(Side::of(v)) {
            return 0.0;
        }
        let level = self.sides[self.side(v)].level_gradient(self.shape, v.abs());
        let by_level = match name.quantity {
            Quantity::Sigma2 => return v,
            Quantity::QuadraticViscous => return v * v.abs(),
            Quantity::Coulomb if !self.falls => 1.0,
            Quantity::Coulomb => level.coulomb,
            Quantity::Static if self.falls => level.static_friction,
            Quantity::StribeckVelocity if self.falls => level.stribeck_velocity,
            Quantity::StribeckExponent if self.falls => level.stribeck_exponent,
            _ => 0.0,
        };
        v.signum() * by_level
    }
}
