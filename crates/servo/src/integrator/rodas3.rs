//! RODAS3: an L-stable Rosenbrock method with step-size control.

use super::advance::Integrator;
use super::flow::{Flow, Slopes, Triple};
use crate::plant::{Load, Motion, Plant};
use stiction_friction::{LuGre, ParamError};

/// RODAS3, order 3 with an embedded order 2 (Sandu, Verwer, Blom, Spee, Carmichael, Potra 1997,
/// doi 10.1016/S1352-2310(97)83212-8), with the exact Jacobian: the reference for bristles of any stiffness.
///
/// Errors are measured against the state and against the smallest motion that matters for the law, Fs/sigma0 in position
/// and deflection and vs in velocity. The step found is kept from call to call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rodas3 {
    tolerance: f64,
    step: f64,
    work: Work,
}

/// Work done so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Steps taken.
    pub steps: u64,
    /// Steps tried and repeated with a smaller one.
    pub rejected: u64,
}

/// The coefficient gamma of the method.
const GAMMA: f64 = 0.5;
/// Step length, as a fraction of the span, up to which a step is taken whatever its error: the state is not finite, or only
/// rounding is left.
const MIN_STEP: f64 = 1e-12;
/// Safety factor on the optimal next step, and bounds of its ratio to the last; the usual values (Hairer, Wanner 1996,
/// Solving Ordinary Differential Equations II, section IV.7).
const STEP_SAFETY: f64 = 0.9;
const STEP_RATIO: (f64, f64) = (0.2, 5.0);

impl Rodas3 {
    /// The relative tolerance of a step, 1e-12 to 1e-2; 1e-7 gives five digits of a stick-slip motion.
    pub fn new(tolerance: f64) -> Result<Self, ParamError> {
        if !(1e-12..=1e-2).contains(&tolerance) {
            return Err(ParamError::new("tolerance", tolerance, "1e-12 to 1e-2"));
        }
        Ok(Rodas3 {
            tolerance,
            step: f64::INFINITY,
            work: Work::default(),
        })
    }

    /// Steps so far.
    pub fn work(&self) -> Work {
        self.work
    }

    /// Largest error component of a step from `from` to `to`, relative to the allowed error.
    fn error(&self, plant: &Plant, from: Triple, to: Triple, error: Triple) -> f64 {
        let law = plant.law();
        let small = law.bound();
        let slow = law.curve().direction(from[1]).stribeck_velocity;
        let mut worst: f64 = 0.0;
        for (i, least) in [small, slow, small].into_iter().enumerate() {
            let scale = self.tolerance * (least + from[i].abs().max(to[i].abs()));
            worst = worst.max(error[i].abs() / scale);
            if !error[i].is_finite() {
                return f64::INFINITY;
            }
        }
        worst
    }
}

impl Integrator<LuGre<f64>> for Rodas3 {
    fn advance(&mut self, plant: &Plant, from: Motion, span: f64, load: Load, rate: f64) -> Motion {
        let flow = Flow { plant, load, rate };
        let mut y = [from.position, from.velocity, from.deflection];
        let mut t = 0.0;
        let mut h = self.step.min(span);
        while t < span {
            let left = span - t;
            let last = h >= left;
            let taken = if last { left } else { h };
            let (next, error) = step(&flow, y, t, taken);
            let size = self.error(plant, y, next, error);
            let factor = (STEP_SAFETY / libm::cbrt(size)).clamp(STEP_RATIO.0, STEP_RATIO.1);
            if size <= 1.0 || taken <= MIN_STEP * span {
                self.work.steps += 1;
                y = next;
                t = if last { span } else { t + taken };
                // A step shortened by the end of the span says little about the next.
                h = if last {
                    (taken * factor).max(h)
                } else {
                    taken * factor
                };
            } else {
                self.work.rejected += 1;
                h = taken * factor;
            }
        }
        self.step = h;
        Motion {
            position: y[0],
            velocity: y[1],
            deflection: y[2],
        }
    }
}

/// One step of `h` seconds and the estimate of its error. The coefficients are those of the form in which the stages are
/// solved for `K` with `(I/(h gamma) - J) K`, so that no product with the Jacobian is needed.
fn step(flow: &Flow<'_>, y: Triple, t: f64, h: f64) -> (Triple, Triple) {
    let add = |y: Triple, k: Triple, w: f64| [0, 1, 2].map(|i| y[i] + w * k[i]);
    let solver = Solver::new(flow.slopes(y), 1.0 / (h * GAMMA));
    let in_time = [0.0, flow.rate / flow.plant.mass(), 0.0];
    let at_start = flow.rates(y, t);

    let k1 = solver.solve(add(at_start, in_time, 0.5 * h));
    let r2 = add(at_start, in_time, 1.5 * h);
    let k2 = solver.solve(add(r2, k1, 4.0 / h));
    let y3 = add(y, k1, 2.0);
    let r3 = flow.rates(y3, t + h);
    let k3 = solver.solve(add(add(r3, k1, 1.0 / h), k2, -1.0 / h));
    let y4 = add(y3, k3, 1.0);
    let r4 = flow.rates(y4, t + h);
    let r4 = add(add(r4, k1, 1.0 / h), k2, -1.0 / h);
    let k4 = solver.solve(add(r4, k3, -8.0 / (3.0 * h)));
    (add(y4, k4, 1.0), k4)
}

/// Solves `(c I - J) k = r` by eliminating position and deflection.
struct Solver {
    c: f64,
    spring: f64,
    bristle: f64,
    by_velocity: f64,
    deflection: f64,
    velocity: f64,
}

impl Solver {
    fn new(slopes: Slopes, c: f64) -> Self {
        let [spring, damping, bristle] = slopes.acceleration;
        let [by_velocity, decay] = slopes.deflection;
        let deflection = c - decay;
        let velocity = c - damping - spring / c - bristle * by_velocity / deflection;
        Solver {
            c,
            spring,
            bristle,
            by_velocity,
            deflection,
            velocity,
        }
    }

    fn solve(&self, r: Triple) -> Triple {
        let known = r[1] + self.spring * r[0] / self.c + self.bristle * r[2] / self.deflection;
        let v = known / self.velocity;
        [
            (r[0] + v) / self.c,
            v,
            (r[2] + self.by_velocity * v) / self.deflection,
        ]
    }
}
