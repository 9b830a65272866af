//! MID: the implicit midpoint step of the plant.

use super::advance::{Integrator, at_least_one};
use crate::plant::{Load, Motion, Plant};
use stiction_friction::{Held, ParamError};

/// The implicit midpoint of [`Plant::step`] in equal steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mid {
    steps: u32,
}

impl Mid {
    /// `steps` >= 1 in each call.
    pub fn new(steps: u32) -> Result<Self, ParamError> {
        at_least_one(steps)?;
        Ok(Mid { steps })
    }
}

impl<L: Held<f64>> Integrator<L> for Mid {
    #[inline]
    fn advance(
        &mut self,
        plant: &Plant<L>,
        from: Motion<L::State>,
        span: f64,
        load: Load,
        rate: f64,
    ) -> Motion<L::State> {
        let h = span / f64::from(self.steps);
        (0..self.steps).fold(from, |motion, i| {
            let force = load.force + rate * (h * (f64::from(i) + 0.5));
            plant.step(motion, h, Load { force, ..load }).motion
        })
    }
}
