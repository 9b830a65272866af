//! `study.toml`: paths, controllers and compensators on one simulated axis, with parameters right and wrong.
//!
//! Raw as typed, then resolved to SI and the types of the simulation.

mod belief;
mod grid;
mod model;
mod plan;
mod resolve;
pub mod result;
mod size;
mod start;
pub mod template;
mod trial;

pub use belief::{Belief, Drawn, Family, PROMISE_DRAWS};
pub use grid::Job;
pub use model::{Model, Parameter};
pub use plan::{
    ContourPlan, Event, Machine, ModelKind, ModelScheme, Named, PathPlan, Scheme, Second, Study,
    Sweep, SweepPoint,
};
pub use size::{MOST_SAMPLES, Size};
pub use start::{Started, results, start};
pub use trial::{Knob, Range};
