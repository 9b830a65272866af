//! MID for LuGre with a good first guess: one evaluation of the law in most steps.

use super::{Integrator, at_least_one};
use crate::plant::{Load, Motion, Plant};
use stiction_friction::{LuGre, ParamError, Sweep};

/// The step of [`Plant::step`], solved from a guess: the velocity changes as in the step before and by what the force on the
/// axis has changed since, as if friction stayed as it was. Steps are best of one length, and are to be of one plant:
/// before one with another law, [`forget`](Integrator::forget).
///
/// Where one step of Newton's method from there is so small that its square is nothing, velocity and deflection take
/// that step by their derivatives, and no further evaluation is needed. Where it is not after four, as in a reversal, the
/// safeguarded solution is taken. The motion is that of [`Mid`](super::Mid) to some 1e-10 of the velocity.
///
/// While the velocity runs as smoothly as without an encoder's steps, the law is evaluated a step ahead, at the velocity
/// that the three steps before lead to: a processor does that beside the step in hand, and the axis and its controller do
/// not wait for exponentials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quick {
    steps: u32,
    /// From the velocity at the beginning of the step before to its mean, m/s (rad/s): half of what it gained.
    rise: f64,
    /// That of the load over the step before, N (N m).
    force: f64,
    /// Mean velocity of the step before, and what the last two gained, the later one first, m/s (rad/s).
    last: f64,
    gained: [f64; 2],
    /// The velocity that was foreseen for the step to come, m/s (rad/s), and how many before it were right.
    foreseen: f64,
    smooth: u32,
    /// The law at a velocity, whether that is the one foreseen, and for which time step, s.
    ready: Sweep<f64>,
    is_ready: bool,
    h: f64,
}

/// A Newton step of this part of the velocity, or of the Stribeck velocity, leaves its square.
const SMALL: f64 = 1e-5;
/// So many steps have to be foreseen rightly before one is built upon.
const SMOOTH: u32 = 4;
const MOST_EVALUATIONS: u32 = 4;

impl Quick {
    /// `steps` >= 1 in each call.
    pub fn new(steps: u32) -> Result<Self, ParamError> {
        at_least_one(steps)?;
        Ok(Quick {
            steps,
            rise: 0.0,
            force: 0.0,
            last: 0.0,
            gained: [0.0; 2],
            foreseen: 0.0,
            smooth: 0,
            ready: Sweep::default(),
            is_ready: false,
            h: 0.0,
        })
    }

    #[inline(always)]
    fn step(&mut self, plant: &Plant, from: Motion, h: f64, load: Load) -> Motion {
        let law = plant.law();
        let slow = law.curve().direction(from.velocity).stribeck_velocity;
        let stiffness = load.stiffness + plant.stiffness();
        let inertia = 2.0 * plant.mass() / h;
        if !(self.is_ready && self.h == h) {
            let jump = (load.force - self.force) / inertia;
            evaluate(&mut self.ready, law, h, from.velocity + (self.rise + jump));
        }
        self.force = load.force;
        for _ in 0..MOST_EVALUATIONS {
            let sweep = &self.ready;
            let w = sweep.velocity();
            // What is known without the law first.
            let drive = load.force - stiffness * (from.position + 0.5 * h * w);
            let left = drive - inertia * (w - from.velocity) - plant.viscous() * w;
            let slope = inertia + plant.viscous() + 0.5 * h * stiffness;
            let (friction, friction_slope) = sweep.mean_force(from.deflection);
            let moves = (left - friction) / (slope + friction_slope);
            if moves.abs() <= small(slow, w) {
                let w = w + moves;
                let bound = law.bound();
                let change = sweep.change(from.deflection);
                let deflection = from.deflection + (change.0 + change.1 * moves);
                self.look_ahead(law, h, w, w - from.velocity, slow);
                return Motion {
                    position: from.position + h * w,
                    velocity: 2.0 * w - from.velocity,
                    deflection: deflection.clamp(-bound, bound),
                };
            }
            evaluate(&mut self.ready, law, h, w + moves);
        }
        let step = plant.step(from, h, load);
        let w = step.mean_velocity;
        self.look_ahead(law, h, w, w - from.velocity, slow);
        step.motion
    }

    /// After a step of the mean velocity `w`: the law for the next one, from the three steps before this one, since
    /// nothing is to wait for `w`.
    #[inline(always)]
    fn look_ahead(&mut self, law: &LuGre<f64>, h: f64, w: f64, rise: f64, slow: f64) {
        // Two steps along the parabola.
        let foreseen = self.last + 5.0 * self.gained[0] - 3.0 * self.gained[1];
        self.is_ready = self.smooth >= SMOOTH;
        if self.is_ready {
            self.ready = law.sweep(h, foreseen);
            self.h = h;
        }
        let right = (w - self.foreseen).abs() <= small(slow, w);
        self.smooth = if right {
            (self.smooth + 1).min(SMOOTH)
        } else {
            0
        };
        self.foreseen = foreseen;
        self.gained = [w - self.last, self.gained[0]];
        self.last = w;
        self.rise = rise;
    }

    #[inline(never)]
    fn one_of_many(&mut self, plant: &Plant, from: Motion, h: f64, load: Load) -> Motion {
        self.step(plant, from, h, load)
    }
}

/// A Newton step so small that its square is nothing, at the velocity `w` and the Stribeck velocity `slow`.
#[inline]
fn small(slow: f64, w: f64) -> f64 {
    let speed = w.abs();
    SMALL * if speed > slow { speed } else { slow }
}

/// Apart, so that its code stands once.
#[inline(never)]
fn evaluate(sweep: &mut Sweep<f64>, law: &LuGre<f64>, h: f64, v: f64) {
    *sweep = law.sweep(h, v);
}

impl Integrator<LuGre<f64>> for Quick {
    #[inline]
    fn advance(&mut self, plant: &Plant, from: Motion, span: f64, load: Load, rate: f64) -> Motion {
        // Without the loop, before which what stays the same would be computed and kept on the stack.
        if self.steps == 1 {
            let force = load.force + 0.5 * rate * span;
            return self.step(plant, from, span, Load { force, ..load });
        }
        let h = span / f64::from(self.steps);
        (0..self.steps).fold(from, |motion, i| {
            let force = load.force + rate * (h * (f64::from(i) + 0.5));
            self.one_of_many(plant, motion, h, Load { force, ..load })
        })
    }

    fn forget(&mut self) {
        (self.is_ready, self.smooth) = (false, 0);
    }
}
