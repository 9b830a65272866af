//! The identifications that need a special motion: constant speeds, force ramps, force steps.
//!
//! | module | from | gives | source |
//! |---|---|---|---|
//! | `stretch`, `moments`, `settle` | a log | its constant-velocity stretches, one point each | |
//! | `static_map`, `profile`, `robust` | points | Fc, Fs, vs, sigma2 | Zhang et al. 2025, doi 10.1371/journal.pone.0322844, eqs. 7-8 |
//! | `dynamic`, `dynamic_shift` | a record, static parameters | sigma0, sigma1, mass | the same, eqs. 35-38 |
//! | `step`, `level` | a force step below break-away | sigma0, sigma1 by inversion | the same, eqs. 26-34 |
//! | `step_fit`, `step_model`, `step_given`, `step_rounding` | the same | sigma0, sigma1 by simulation | |
//! | `break_away` | a force ramp | the force at break-away, with the ramp's rate | Canudas de Wit et al. 1995, doi 10.1109/9.376053, section III.C |
//!
//! A static map does not include acceleration, and break-away is not a point of it: the force at which an
//! axis starts to move depends on how fast the force rises.

mod assemble;
mod break_away;
mod dynamic;
mod dynamic_shift;
mod level;
mod moments;
mod parameter;
mod profile;
pub(crate) mod robust;
mod searched;
mod settle;
mod static_map;
mod statics;
mod step;
mod step_fit;
mod step_given;
mod step_model;
mod step_rounding;
mod stretch;

pub use break_away::{BreakAway, Predicted, break_away, predict_break_away};
pub use dynamic::{dynamic, dynamic_near};
pub use dynamic_shift::dynamic_conditioned;
pub use static_map::{Exponent, StaticMap, StaticSettings, static_map, static_map_near};
pub(crate) use static_map::{LEAST_VELOCITY_SHARE, Weighed, weighed};
pub use statics::Statics;
pub use step::{Inversion, StepResponse};
pub use step_fit::{StepFit, StepSeries, StepSettings, fit_steps};
pub use stretch::{Rejected, Run, StaticPoint, Stretches, Unsteady, stretches};
