//! Test motions of one axis: sine, chirp, jerk-limited moves and staircases, steps, and recorded set points.
//!
//! The excitation for identification is in [`path`](crate::path) and [`speeds`](crate::speeds).

mod moves;
mod profile;
mod set_points;
mod wave;

pub use moves::{Move, Moves, Step};
pub use profile::{Limits, Profile};
pub use set_points::SetPoints;
pub use wave::{Chirp, Sine};
