//! The identifications that need a motion of their own, as workflows.

mod break_away;
mod curve;
mod map;
pub(super) mod static_map;
pub(super) mod step;
mod two_step;

pub(super) use break_away::{BreakAways, break_away};
pub(super) use two_step::{TwoStep, TwoSteps, two_step};
