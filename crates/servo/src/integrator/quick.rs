//! MID for LuGre with a good initial guess: one evaluation of the law in most steps.

use super::advance::{Integrator, at_least_one};
use crate::plant::{Load, Motion, Plant, Step};
use stiction_friction::{LuGre, ParamError, Sweep, Sweeps};

/// The step of [`Plant::step`], solved from an initial guess: the velocity changes as in the step before, and by the change
/// of the force on the axis since, as if friction stayed the same. Steps should all have the same length and must belong to
/// one plant: before a step of another call [`forget`](Integrator::forget).
///
/// Where a Newton step from there is so small that its square is negligible, velocity and deflection take
/// that step by their derivatives, and no further evaluation is needed. Where it is not after four evaluations, as in a
/// reversal, the safeguarded solution is taken. The motion is that of [`Mid`](super::mid::Mid) to some 1e-10 of the velocity.
///
/// The law is evaluated a step ahead where that step's velocity can be predicted: the processor overlaps this with the
/// current step, and the axis and its controller do not wait for exponentials. Where the load of the next step is known
/// already ([`Integrator::expect`]), as within a control period or behind a delay, the velocity is predicted with the law
/// of the step before. Else, while the velocity is as smooth as without encoder steps, it is extrapolated from the three
/// steps before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quick {
    steps: u32,
    /// The law in steps of the length of the last one; none before there is one.
    law: Option<Sweeps<f64>>,
    course: Course,
}

/// History of the steps before.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Course {
    /// From the velocity at the beginning of the step before to its mean, m/s (rad/s): half of its change.
    rise: f64,
    /// Force of the load over the step before, N (N m).
    force: f64,
    /// Mean velocity of the step before, and the last two changes of it, the later one first, m/s (rad/s).
    last: f64,
    gained: [f64; 2],
    /// The velocity that was extrapolated along a parabola for the next step, m/s (rad/s), and how many such predictions
    /// before it were right.
    foreseen: f64,
    smooth: u32,
    /// The law at the velocities of this step and the one before, alternately; this step's is at `at`.
    laws: [Sweep<f64>; 2],
    at: usize,
    /// Whether there is one for the next step, at a predicted velocity.
    is_ready: bool,
    /// Change of velocity per force by the law of the step before, m/s per N (rad/s per N m); 0 without one.
    yields: f64,
    /// Load of the step after the next, N (N m), where it is known.
    next: Option<f64>,
}

/// Largest Newton step after which no further one is needed, relative to the larger of velocity and Stribeck velocity: its
/// square, 1e-10, is what remains.
const NEGLIGIBLE_STEP: f64 = 1e-5;
/// Correct predictions in a row before one is relied on.
const RIGHT_PREDICTIONS: u32 = 4;
/// Evaluations of the law before the safeguarded solution is taken.
const MAX_EVALUATIONS: u32 = 4;

impl Quick {
    /// `steps` >= 1 in each call.
    pub fn new(steps: u32) -> Result<Self, ParamError> {
        at_least_one(steps)?;
        Ok(Quick {
            steps,
            law: None,
            course: Course::default(),
        })
    }

    #[inline(always)]
    fn step(&mut self, plant: &Plant, from: Motion, h: f64, load: Load) -> Motion {
        let law = match &mut self.law {
            Some(law) if law.h() == h => law,
            other => {
                self.course.forget();
                other.insert(plant.law().sweeps(h, plant.mass()))
            }
        };
        self.course.step(law, plant, from, load)
    }

    #[inline(never)]
    fn one_of_many(&mut self, plant: &Plant, from: Motion, h: f64, load: Load) -> Motion {
        self.step(plant, from, h, load)
    }
}

impl Course {
    fn forget(&mut self) {
        (self.is_ready, self.smooth, self.yields) = (false, 0, 0.0);
    }

    #[inline(always)]
    fn step(&mut self, law: &Sweeps<f64>, plant: &Plant, from: Motion, load: Load) -> Motion {
        let h = law.h();
        let slow = plant
            .law()
            .curve()
            .direction(from.velocity)
            .stribeck_velocity;
        let balance = Balance::new(plant, from, h, load);
        let at = self.at;
        if !self.is_ready {
            let jump = (load.force - self.force) / balance.inertia;
            let guess = from.velocity + (self.rise + jump);
            evaluate(&mut self.laws[at & 1], law, guess);
        }
        self.force = load.force;
        for _ in 0..MAX_EVALUATIONS {
            let sweep = &self.laws[at & 1];
            let w = sweep.velocity();
            // First whatever does not need the law.
            let (left, slope) = balance.without_friction(w);
            let (friction, friction_slope) = sweep.mean_force(from.deflection, from.velocity);
            let slope = slope + friction_slope;
            let yields = 1.0 / slope;
            let moves = (left - friction) * yields;
            if moves.abs() <= small(slow, w) {
                let w = w + moves;
                let bound = plant.law().bound();
                let change = sweep.change(from.deflection);
                let deflection = from.deflection + (change.0 + change.1 * moves);
                self.look_ahead(law, &balance, w, slow);
                self.yields = yields;
                return Motion {
                    position: from.position + h * w,
                    velocity: 2.0 * w - from.velocity,
                    deflection: deflection.clamp(-bound, bound),
                };
            }
            evaluate(&mut self.laws[at & 1], law, w + moves);
        }
        let step = by_parts(
            plant,
            from.position,
            from.velocity,
            from.deflection,
            h,
            load,
        );
        self.look_ahead(law, &balance, step.mean_velocity, slow);
        self.yields = 0.0;
        step.motion
    }

    /// After a step with the mean velocity `w`: the law for the next one, at a predicted velocity that does not depend on `w`.
    #[inline(always)]
    fn look_ahead(&mut self, law: &Sweeps<f64>, balance: &Balance, w: f64, slow: f64) {
        // Extrapolated two steps along the parabola.
        let along = self.last + 5.0 * self.gained[0] - 3.0 * self.gained[1];
        let before = &mut self.laws[(self.at & 1) ^ 1];
        let foreseen = match self.next.take() {
            Some(next) if self.yields > 0.0 => Some(balance.two_steps(before, self.yields, next)),
            _ if self.smooth >= RIGHT_PREDICTIONS => Some(along),
            _ => None,
        };
        self.is_ready = foreseen.is_some();
        if let Some(velocity) = foreseen {
            *before = law.at(velocity);
        }
        // The law of this step is that of the step before from now on.
        self.at ^= 1;
        let right = (w - self.foreseen).abs() <= small(slow, w);
        // Without a branch, which nothing predicts.
        self.smooth = (self.smooth + 1).min(RIGHT_PREDICTIONS) * u32::from(right);
        self.foreseen = along;
        self.gained = [w - self.last, self.gained[0]];
        self.last = w;
        self.rise = w - balance.from.velocity;
    }
}

/// The forces of one step except friction.
struct Balance {
    from: Motion,
    h: f64,
    /// Force at the position where the step begins, N (N m), and how fast it falls with that position, N/m (N m/rad).
    force: f64,
    stiffness: f64,
    /// 2 M/h, and what else resists the mean velocity: damper and spring, N s/m (N m s/rad).
    inertia: f64,
    resists: f64,
}

impl Balance {
    #[inline(always)]
    fn new(plant: &Plant, from: Motion, h: f64, load: Load) -> Self {
        let stiffness = load.stiffness + plant.stiffness();
        Balance {
            from,
            h,
            force: load.force - stiffness * from.position,
            stiffness,
            inertia: 2.0 * plant.mass() / h,
            resists: plant.viscous() + 0.5 * h * stiffness,
        }
    }

    /// The force left for friction at the mean velocity `w`, N (N m), and how fast it falls with w.
    #[inline(always)]
    fn without_friction(&self, w: f64) -> (f64, f64) {
        let left = self.force - self.inertia * (w - self.from.velocity) - self.resists * w;
        (left, self.inertia + self.resists)
    }

    /// The mean velocity of the step after this one, under the force `next`, by one Newton step in each with the law of
    /// another step and its change of velocity per force, `yields`.
    #[inline(always)]
    fn two_steps(&self, law: &Sweep<f64>, yields: f64, next: f64) -> f64 {
        let w = law.velocity();
        let Motion {
            position,
            velocity,
            deflection: z,
        } = self.from;
        let resists = self.resists * w;
        let (friction, by_rise) = law.likely_force(z);
        // Little of this changes with the deflection within a step: it is the same for both.
        let inertia = self.inertia - by_rise;
        let late = w - velocity;
        let first = ((self.force - resists - friction) - late * inertia) * yields;
        let change = law.change(z);
        let force = next - self.stiffness * (position + self.h * (w + first));
        let z = (z + change.0) + change.1 * first;
        let late = -late - (first + first);
        w + ((force - resists - law.likely_force(z).0) - late * inertia) * yields
    }
}

/// The largest Newton step whose square is negligible, at the velocity `w` and the Stribeck velocity `slow`.
#[inline]
fn small(slow: f64, w: f64) -> f64 {
    let speed = w.abs();
    NEGLIGIBLE_STEP * if speed > slow { speed } else { slow }
}

/// The safeguarded solution. The motion comes in parts: were it copied to memory here, the step would load it as a whole
/// everywhere, which the processor delays when the step before has just stored its parts.
#[cold]
#[inline(never)]
fn by_parts(
    plant: &Plant,
    position: f64,
    velocity: f64,
    deflection: f64,
    h: f64,
    load: Load,
) -> Step {
    let from = Motion {
        position,
        velocity,
        deflection,
    };
    plant.step(from, h, load)
}

/// A function of its own, so that its code exists once.
#[inline(never)]
fn evaluate(sweep: &mut Sweep<f64>, law: &Sweeps<f64>, v: f64) {
    *sweep = law.at(v);
}

impl Integrator<LuGre<f64>> for Quick {
    #[inline]
    fn advance(&mut self, plant: &Plant, from: Motion, span: f64, load: Load, rate: f64) -> Motion {
        // Outside the loop, for which invariants would be computed and kept on the stack.
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

    #[inline]
    fn expect(&mut self, next: f64) {
        self.course.next = Some(next);
    }

    fn forget(&mut self) {
        self.law = None;
        self.course.forget();
    }
}
