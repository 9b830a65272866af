//! What is kept of a run.

use super::contour_trace::ContourTrace;
use super::trace::Trace;
use serde::{Deserialize, Serialize};
use stiction_files::study::Job;
use stiction_search::bits;

/// What is kept of a run.
#[derive(Serialize, Deserialize)]
pub(super) struct Done {
    pub job: Job,
    #[serde(with = "bits")]
    pub metrics: Vec<f64>,
    pub switched_off: bool,
    pub trace: Option<Trace>,
    pub contour: Option<ContourTrace>,
    /// Rows of `trajectories.csv` or `contours.csv`.
    pub course: String,
}
