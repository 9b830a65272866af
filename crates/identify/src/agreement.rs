//! Whether logs of one axis tell the same of its parameters.
//!
//! What differs from one log to the next (warmth, lubrication, load) is the same for all samples of a log: more samples do not
//! average it out. By how much the level of friction differs is measured, and takes the place of what is known of any machine in
//! the interval of a repeat ([`scatter`](crate::scatter)). Parameters that logs surely have differently are named; filters and
//! encoder make some of it, which the replicas of the fitted axis show.

mod levels;
mod points;

pub use levels::Disagreement;
use levels::Levels;
pub(crate) use points::{Placed, disagreement};

/// What the logs of a fit tell: the levels of each.
#[derive(Clone, Debug)]
pub(crate) struct Told {
    levels: Levels,
}
