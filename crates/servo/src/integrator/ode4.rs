//! The classical Runge-Kutta method at a fixed step, as "ode4" in simulation tools.

use super::advance::{Integrator, at_least_one};
use super::flow::{Flow, Triple};
use crate::plant::{Load, Motion, Plant};
use std::fmt;
use stiction_friction::{LuGre, ParamError};

/// Speeds between 0 and the fastest at which stability is checked.
const CHECKED_SPEEDS: i32 = 32;
/// Growth factor above 1 that is put down to rounding.
const GROWTH_ROUNDING: f64 = 1e-9;
/// Where the growth factor exceeds 1 on the negative real axis: the stability limit of Runge-Kutta 4 (Hairer, Wanner 1996,
/// Solving Ordinary Differential Equations II, section IV.2).
const STABILITY_LIMIT: f64 = 2.785;

/// Runge-Kutta of order 4 in equal steps: to reproduce published settings only. Call [`check`](Self::check) first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ode4 {
    steps: u32,
}

/// An explicit step that is too long: it amplifies what it should damp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unstable {
    /// The step asked for, s.
    pub step: f64,
    /// About the largest that is stable there, s.
    pub largest: f64,
    /// The speed at which it is not, m/s (rad/s).
    pub speed: f64,
}

impl fmt::Display for Unstable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "ode4 is unstable with a step of {:.3e} s at a speed of {:.3e}: at most {:.3e} s",
            self.step, self.speed, self.largest
        )
    }
}

impl Ode4 {
    /// `steps` >= 1 in each call.
    pub fn new(steps: u32) -> Result<Self, ParamError> {
        at_least_one(steps)?;
        Ok(Ode4 { steps })
    }

    /// Whether a step of `h` seconds is unstable for this plant, at rest or in steady motion at up to `fastest` m/s
    /// (rad/s). Runge-Kutta 4 gives no sign of it: the motion becomes wrong before it becomes infinite.
    ///
    /// The eigenvalues of the linearised equations times `h` are put into the method's growth factor
    /// `1 + y + y^2/2 + y^3/6 + y^4/24`, which must not exceed 1. Growth of the equations themselves, as on the
    /// falling side of the Stribeck curve, does not count.
    pub fn check(plant: &Plant, h: f64, fastest: f64) -> Result<(), Unstable> {
        let law = plant.law();
        for part in 0..=CHECKED_SPEEDS {
            let speed = fastest * f64::from(part) / f64::from(CHECKED_SPEEDS);
            let z = if part == 0 {
                0.0
            } else {
                law.curve().level(speed) / law.stiffness()
            };
            let flow = Flow {
                plant,
                load: Load::default(),
                rate: 0.0,
            };
            let slopes = flow.slopes([0.0, speed, z]);
            let [_, damping, bristle] = slopes.acceleration;
            let [by_velocity, decay] = slopes.deflection;
            let half = 0.5 * (damping + decay);
            let determinant = damping * decay - bristle * by_velocity;
            let inside = half * half - determinant;
            let root = libm::sqrt(inside.abs());
            let pair = if inside >= 0.0 {
                [(half + root, 0.0), (half - root, 0.0)]
            } else {
                [(half, root), (half, -root)]
            };
            for (re, im) in pair {
                if re <= 0.0 && growth(h * re, h * im) > 1.0 + GROWTH_ROUNDING {
                    let largest = STABILITY_LIMIT / libm::hypot(re, im);
                    return Err(Unstable {
                        step: h,
                        largest,
                        speed,
                    });
                }
            }
        }
        Ok(())
    }
}

/// Magnitude of the growth factor at the complex number `re + i im`, by Horner's rule.
fn growth(re: f64, im: f64) -> f64 {
    let (mut a, mut b) = (1.0, 0.0);
    for divisor in [4.0, 3.0, 2.0, 1.0] {
        let (p, q) = (a * re - b * im, a * im + b * re);
        (a, b) = (1.0 + p / divisor, q / divisor);
    }
    libm::hypot(a, b)
}

impl Integrator<LuGre<f64>> for Ode4 {
    fn advance(&mut self, plant: &Plant, from: Motion, span: f64, load: Load, rate: f64) -> Motion {
        let flow = Flow { plant, load, rate };
        let h = span / f64::from(self.steps);
        let along = |y: Triple, k: Triple, h: f64| [0, 1, 2].map(|i| y[i] + h * k[i]);
        let mut y = [from.position, from.velocity, from.deflection];
        for i in 0..self.steps {
            let t = h * f64::from(i);
            let k1 = flow.rates(y, t);
            let k2 = flow.rates(along(y, k1, 0.5 * h), t + 0.5 * h);
            let k3 = flow.rates(along(y, k2, 0.5 * h), t + 0.5 * h);
            let k4 = flow.rates(along(y, k3, h), t + h);
            y = [0, 1, 2].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        }
        Motion {
            position: y[0],
            velocity: y[1],
            deflection: y[2],
        }
    }
}
