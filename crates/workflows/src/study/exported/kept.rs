//! What is kept of the runs of a path under a controller with exported C: a later call of the same study with the same C takes it.

use super::ExportedC;
use crate::study::kept::first_beside;
use crate::study::machine;
use crate::study::outcome::StudyOutcome;
use crate::study::trace::Trace;
use serde::{Deserialize, Serialize};
use stiction_files::study::result::{ExportedRow, ExportedValue};
use stiction_files::study::{Job, Study};
use stiction_files::{Runs, sha256_of};
use stiction_search::bits;

/// Metrics that stand beside each other.
pub(super) const METRICS: [&str; 3] = ["rms_error", "peak_error", "reversal_peak"];

/// The three runs of a path under a controller, as far as an outcome shows them.
#[derive(Serialize, Deserialize)]
pub(super) struct Kept {
    /// [`ExportedC::id`] of the C.
    pub of: String,
    pub job: Job,
    /// [`METRICS`] without compensation, with the compensator in Rust, and with the C.
    #[serde(with = "bits")]
    pub metrics: Vec<f64>,
    /// Largest difference of the forces, N (N m), and when it was, s; largest difference of the positions, m (rad).
    #[serde(with = "bits")]
    pub apart: Vec<f64>,
    /// Whether the forces differ by more than is allowed.
    pub differs: bool,
    /// Whether the watchdog of the C switched off.
    pub switched_off: bool,
    pub traces: Vec<Trace>,
    /// Rows of `trajectories.csv`.
    pub course: String,
}

/// The paths under each controller, in the order in which they are run.
pub(super) fn jobs(study: &Study) -> impl Iterator<Item = Job> {
    let controllers = study.controllers.len();
    (0..study.paths.len()).flat_map(move |path| {
        (0..controllers).map(move |controller| Job {
            path,
            controller,
            compensator: 0,
            coupled: false,
            family: 0,
            belief: 0,
        })
    })
}

/// How many runs are kept.
pub(in crate::study) fn runs(study: &Study) -> usize {
    jobs(study).count()
}

impl ExportedC {
    /// SHA-256 of the files of the C, as they were read and compiled.
    pub(super) fn id(&self) -> String {
        let files: Vec<&str> = self.files.iter().map(|file| file.sha256.as_str()).collect();
        sha256_of(files.join("\n").as_bytes())
    }
}

impl Kept {
    /// The runs that an earlier call has left, if they are of this job with this C.
    pub fn taken(runs: &Runs, study: &Study, (place, job): (usize, Job), of: &str) -> Option<Self> {
        let text = runs.taken(first_beside(study) + place)?;
        let kept: Kept = serde_json::from_str(text).ok()?;
        let mut traces = kept.traces.iter();
        let whole = kept.metrics.len() == 3 * METRICS.len()
            && kept.apart.len() == 3
            && kept.traces.len() == if study.keeps_courses { 3 } else { 0 }
            && traces.all(|trace| trace.whole.is_whole() && trace.reversal.is_whole());
        (whole && kept.job == job && kept.of == of).then_some(kept)
    }

    /// Keeps the runs.
    pub fn add(&self, runs: &Runs, study: &Study, place: usize) {
        let text = serde_json::to_string(self).expect("plain data");
        runs.add(first_beside(study) + place, &text);
    }

    /// The row of the path under the controller; its courses go into the outcome.
    pub fn told(self, outcome: &mut StudyOutcome, study: &Study) -> ExportedRow {
        let [path, controller, _] = study.names(self.job);
        outcome.exported_traces.extend(self.traces);
        if study.keeps_courses {
            outcome.courses[0].push_str(&self.course);
        }
        let less = |without: f64, with: f64| {
            let percent = 100.0 * (1.0 - with / without);
            percent.is_finite().then_some(percent)
        };
        let value = |(k, name): (usize, &&str)| {
            let [without, rust, c] = [0, 1, 2].map(|run| self.metrics[METRICS.len() * run + k]);
            ExportedValue {
                name: (*name).into(),
                unit: machine::unit(&study.machine, name),
                without,
                rust,
                c,
                rust_reduction_percent: less(without, rust),
                c_reduction_percent: less(without, c),
            }
        };
        ExportedRow {
            path: path.into(),
            controller: controller.into(),
            metrics: METRICS.iter().enumerate().map(value).collect(),
            force_difference: self.apart[0],
            force_unit: stiction_files::symbols::force_unit(study.machine.motion).into(),
            at_s: self.apart[1],
            position_difference: self.apart[2],
            differs: self.differs,
            switched_off: self.switched_off,
        }
    }
}
