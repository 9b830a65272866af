//! MID for LuGre with a good first guess: one evaluation of the law in most steps.

use super::{Integrator, at_least_one};
use crate::plant::{Load, Motion, Plant};
use stiction_friction::{LuGre, ParamError};

/// The step of [`Plant::step`], solved from a guess: the velocity changes as in the step before and by what the force on the
/// axis has changed since, as if friction stayed as it was. Steps are best of one length.
///
/// Where one step of Newton's method from there is so small that its square is nothing, velocity and deflection take
/// that step by their derivatives, and no further evaluation is needed. Where it is not after four, as in a reversal, the
/// safeguarded solution is taken. The motion is that of [`Mid`](super::Mid) to some 1e-10 of the velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quick {
    steps: u32,
    /// From the velocity at the beginning of the step before to its mean, m/s (rad/s): half of what it gained.
    rise: f64,
    /// That of the load over the step before, N (N m).
    force: f64,
}

/// A Newton step of this part of the velocity, or of the Stribeck velocity, leaves its square.
const SMALL: f64 = 1e-5;
const MOST_EVALUATIONS: u32 = 4;

impl Quick {
    /// `steps` >= 1 in each call.
    pub fn new(steps: u32) -> Result<Self, ParamError> {
        at_least_one(steps)?;
        Ok(Quick {
            steps,
            rise: 0.0,
            force: 0.0,
        })
    }

    #[inline]
    fn step(&mut self, plant: &Plant, from: Motion, h: f64, load: Load) -> Motion {
        let law = plant.law();
        let stiffness = load.stiffness + plant.stiffness();
        let inertia = 2.0 * plant.mass() / h;
        let slow = law.curve().direction(from.velocity).stribeck_velocity;
        let mut w = from.velocity + self.rise + (load.force - self.force) / inertia;
        self.force = load.force;
        for _ in 0..MOST_EVALUATIONS {
            let [end, (friction, friction_slope)] = law.step_held_force(from.deflection, h, w);
            let drive = load.force - stiffness * (from.position + 0.5 * h * w);
            let excess = inertia * (w - from.velocity) + friction + plant.viscous() * w - drive;
            let slope = inertia + plant.viscous() + 0.5 * h * stiffness + friction_slope;
            let moves = -excess / slope;
            if moves.abs() <= SMALL * slow.max(w.abs()) {
                let w = w + moves;
                let bound = law.bound();
                self.rise = w - from.velocity;
                return Motion {
                    position: from.position + h * w,
                    velocity: 2.0 * w - from.velocity,
                    deflection: (end.0 + end.1 * moves).clamp(-bound, bound),
                };
            }
            w += moves;
        }
        let motion = plant.step(from, h, load).motion;
        self.rise = 0.5 * (motion.velocity - from.velocity);
        motion
    }
}

impl Integrator<LuGre<f64>> for Quick {
    #[inline]
    fn advance(&mut self, plant: &Plant, from: Motion, span: f64, load: Load, rate: f64) -> Motion {
        let h = span / f64::from(self.steps);
        (0..self.steps).fold(from, |motion, i| {
            let force = load.force + rate * (h * (f64::from(i) + 0.5));
            self.step(plant, motion, h, Load { force, ..load })
        })
    }
}
