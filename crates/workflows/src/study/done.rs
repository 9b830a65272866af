//! What is kept of a run.

use super::contour_trace::ContourTrace;
use super::trace::Trace;
use stiction_files::study::Job;

/// What is kept of a run.
pub(super) struct Done {
    pub job: Job,
    pub metrics: Vec<f64>,
    pub switched_off: bool,
    pub trace: Option<Trace>,
    pub contour: Option<ContourTrace>,
    /// Rows of `trajectories.csv` or `contours.csv`.
    pub course: String,
}
