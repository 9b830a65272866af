//! What every integrator does.

use crate::plant::{Load, Motion, Plant};
use stiction_friction::{Held, ParamError};

/// Advances a plant whose law is `L`.
pub trait Integrator<L: Held<f64>> {
    /// The motion after `span` > 0 seconds under `load`, whose force rises by `rate` N/s (N m/s).
    fn advance(
        &mut self,
        plant: &Plant<L>,
        from: Motion<L::State>,
        span: f64,
        load: Load,
        rate: f64,
    ) -> Motion<L::State>;

    /// May be called before a step with the force of the load in the step after it, N (N m), where it is known by then.
    fn expect(&mut self, _next: f64) {}

    /// To be called when the plant is no longer that of the call before: whatever was kept of it is dropped.
    fn forget(&mut self) {}
}

/// Refuses to divide a span into no steps.
pub(super) fn at_least_one(steps: u32) -> Result<(), ParamError> {
    if steps == 0 {
        return Err(ParamError::new("steps", 0.0, ">= 1"));
    }
    Ok(())
}
