//! Names of what is measured of a run; what they mean is in `docs/study.md`.

use stiction_files::study::{Job, Study};

/// Of a path, in the order in which a run gives them.
const PATH: [&str; 7] = [
    "rms_error",
    "peak_error",
    "reversal_peak",
    "command_change",
    "stick_time",
    "saturation",
    "velocity_ripple",
];

/// Of a contour, in the same order.
const CONTOUR: [&str; 9] = [
    "contour_rms",
    "contour_peak",
    "circular_deviation",
    "reversal_peak_x",
    "reversal_peak_y",
    "command_change_x",
    "command_change_y",
    "saturation_x",
    "saturation_y",
];

/// Names of the metrics of a run.
pub(super) fn metrics(study: &Study, job: Job) -> &'static [&'static str] {
    match job.path < study.paths.len() {
        true => &PATH,
        false => &CONTOUR,
    }
}
