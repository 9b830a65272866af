//! The plain midpoint step, to compare engines with that use it.

use stiction_friction::{Held, LuGre, Pace, Stribeck};

/// LuGre whose mean force over a step is that of the mean of both ends: a `Plant` with it takes the midpoint step without
/// the correction of `stiction_friction::Sweep`, as the fits that simulate an axis do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanOfEnds(pub LuGre<f64>);

impl Held<f64> for MeanOfEnds {
    type State = f64;

    fn curve(&self) -> &Stribeck<f64> {
        self.0.curve()
    }

    fn hold(&self, from: f64, h: f64, v: f64) -> f64 {
        self.0.hold(from, h, v)
    }

    fn mean_force(&self, from: f64, to: f64, h: f64, v: f64) -> f64 {
        self.0.mean_force(from, to, h, v)
    }

    fn mean_force_slope(&self, from: f64, &Pace { h, .. }: &Pace<f64>, v: f64) -> (f64, f64) {
        let (end, end_slope) = self.0.step_held_slope(from, h, v);
        let by_end = 0.5 * self.0.stiffness() + self.0.micro_damping(v) / h;
        (
            self.0.mean_force(from, end, h, v),
            end_slope * by_end + self.0.curve().direction(v).viscous,
        )
    }

    fn force_now(&self, state: f64, v: f64) -> f64 {
        self.0.force(state, v)
    }

    fn spring_slope(&self, from: f64, h: f64, v: f64) -> (f64, f64) {
        self.0.spring_slope(from, h, v)
    }

    fn spring(&self, state: f64) -> f64 {
        self.0.spring(state)
    }

    fn reach(&self, h: f64) -> f64 {
        self.0.reach(h)
    }
}
