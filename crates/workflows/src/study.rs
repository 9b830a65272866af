//! Simulation of a study: every run of its grid, and what is told of them.

mod changing;
mod compensation;
mod contour;
mod contour_trace;
mod course;
mod diverged;
mod done;
pub mod doubt;
mod elsewhere;
mod exported;
mod kept;
mod learnt;
mod machine;
mod memory;
mod metrics;
mod not_promised;
mod outcome;
mod path;
mod plane;
mod rows;
mod run;
mod sweeps;
mod trace;
mod trial;

pub use changing::LoadCourse;
pub use contour_trace::ContourTrace;
pub use elsewhere::{Metrics, simulate_on};
pub use exported::{ExportedC, compare_exported};
pub use kept::keep;
pub use memory::memory;
pub use outcome::StudyOutcome;
pub use plane::{Line, Plane};
pub use run::{simulate, simulate_keeping};
pub use trace::{Course, Trace};
pub use trial::{NotTried, Tried, TriedRun, Which, trial};

pub(crate) use compensation::without_stribeck;
