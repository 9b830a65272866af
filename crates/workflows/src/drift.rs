//! Friction over time: what changed on which machine, from the table of a batch.

mod asked;
mod courses;
mod run;

pub use asked::{Limit, Side};
pub use courses::{Followed, Times};
pub use run::{DriftOutcome, Shown, drift, drift_of_rows_while, drift_while, least_logs};
