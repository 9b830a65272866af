//! What comes out of a study.

use super::contour_trace::ContourTrace;
use super::trace::Trace;
use stiction_files::study::result::{ResultRow, StudyFile};

/// Everything that came out of a study, in memory.
pub struct StudyOutcome {
    /// What goes into `study.json`.
    pub file: StudyFile,
    /// Courses on paths with exact parameters.
    pub traces: Vec<Trace>,
    /// Courses on contours with exact parameters.
    pub contours: Vec<ContourTrace>,
    /// `trajectories.csv` and `contours.csv`; empty without a path, without a contour.
    pub courses: [String; 2],
    /// Courses without compensation, with the compensator in Rust and with the exported C, of each path under each controller, where
    /// there is exported C.
    pub exported_traces: Vec<Trace>,
}

impl StudyOutcome {
    /// The course of the run of a row with exact parameters.
    pub fn trace(&self, row: &ResultRow) -> Option<&Trace> {
        self.traces.iter().find(|t| {
            t.path == row.path && t.controller == row.controller && t.compensator == row.compensator
        })
    }

    /// The same of a row on a contour.
    pub fn contour(&self, row: &ResultRow) -> Option<&ContourTrace> {
        self.contours.iter().find(|t| {
            t.path == row.path
                && t.controller == row.controller
                && t.compensator == row.compensator
                && t.coupled == row.coupled
        })
    }
}
