//! A plant with LuGre friction as differential equations, with their Jacobian.

use crate::plant::{Load, Plant};
use stiction_friction::Damping;

/// Step of the central difference, relative to the velocity: about the cube root of the rounding, where truncation and
/// rounding errors are equal.
const DIFFERENCE: f64 = 1e-5;
/// Least velocity that the step is relative to, in Stribeck velocities.
const LEAST_VELOCITY: f64 = 1e-6;

/// Position, velocity, deflection; or their rates.
pub(super) type Triple = [f64; 3];

/// The right-hand side at an instant.
#[derive(Clone, Copy)]
pub(super) struct Flow<'a> {
    pub plant: &'a Plant,
    pub load: Load,
    /// Of the load's force, N/s (N m/s).
    pub rate: f64,
}

/// Those derivatives of acceleration and deflection rate that are not 0.
pub(super) struct Slopes {
    /// Of the acceleration by position, velocity, deflection.
    pub acceleration: Triple,
    /// Of the deflection rate by velocity and deflection.
    pub deflection: [f64; 2],
}

impl Flow<'_> {
    /// Rates at the state `y`, `t` seconds after the load began.
    pub fn rates(&self, y: Triple, t: f64) -> Triple {
        let [x, v, z] = y;
        let plant = self.plant;
        let stiffness = self.load.stiffness + plant.stiffness();
        let force = self.load.force + self.rate * t;
        let friction = plant.law().force(z, v);
        [
            v,
            (force - stiffness * x - plant.viscous() * v - friction) / plant.mass(),
            plant.law().deflection_rate(z, v),
        ]
    }

    pub fn slopes(&self, y: Triple) -> Slopes {
        let [_, v, z] = y;
        let (plant, law) = (self.plant, self.plant.law());
        let (g, g_slope) = law.curve().level_and_slope(v);
        let sign = if v < 0.0 { -1.0 } else { 1.0 };
        let a = law.stiffness() * v.abs() / g;
        let a_slope = law.stiffness() * sign / g - a * g_slope / g;
        let by_velocity = 1.0 - a_slope * z;
        let s1 = law.micro_damping(v);
        let bristle = law.stiffness() - s1 * a;
        let viscous = law.curve().direction(v).viscous + plant.viscous();
        let damping = s1 * by_velocity + self.damping_slope(v) * (v - a * z) + viscous;
        let stiffness = self.load.stiffness + plant.stiffness();
        Slopes {
            acceleration: [stiffness, damping, bristle].map(|k| -k / plant.mass()),
            deflection: [by_velocity, -a],
        }
    }

    /// Derivative of sigma1 with respect to velocity: 0, or a central difference, accurate to ten digits.
    fn damping_slope(&self, v: f64) -> f64 {
        let law = self.plant.law();
        if let Damping::Constant(_) = law.damping() {
            return 0.0;
        }
        let least = LEAST_VELOCITY * law.curve().direction(v).stribeck_velocity;
        let d = DIFFERENCE * v.abs().max(least);
        (law.micro_damping(v + d) - law.micro_damping(v - d)) / (2.0 * d)
    }
}
