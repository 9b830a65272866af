//! An axis simulated with and without compensation.

use crate::progress::Watched;
use crate::{Error, Notice, Progress};
use serde_json::Value;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use stiction_files::study as form;
use stiction_files::study::result::{ResultRow, SCHEMA};
use stiction_pages::{bundle, report, text};
use stiction_workflows::Verdict;
use stiction_workflows::study::{StudyOutcome, simulate};

/// An axis, paths, controllers and compensators to compare, as a study file states them (docs/study.md).
///
/// ```no_run
/// let study = stiction::Study::read("study.toml")?;
/// let done = study.simulate();
/// for row in done.rows() {
///     if let Some(peak) = row.metric("peak_error") {
///         println!("{} with {}: {} {}", row.path(), row.compensator(), peak.mean, peak.unit);
///     }
/// }
/// # Ok::<(), stiction::Error>(())
/// ```
pub struct Study(form::Study);

impl Study {
    /// Reads a study file.
    ///
    /// # Errors
    /// Where it, or a file that it names, cannot be read or is refused, or more would be simulated than is allowed at once.
    pub fn read(file: impl AsRef<Path>) -> Result<Self, Error> {
        form::Study::read(file).map(Self).map_err(Error::of)
    }

    /// The same with at most so many samples to simulate, in all runs together.
    ///
    /// # Errors
    /// As [`Study::read`].
    pub fn read_within(file: impl AsRef<Path>, samples: u64) -> Result<Self, Error> {
        let study = form::Study::read_within(file, samples);
        study.map(Self).map_err(Error::of)
    }

    /// Runs all of it on all threads; the result does not depend on their number.
    pub fn simulate(&self) -> Simulation {
        self.simulate_observed(|_| ControlFlow::Continue(()))
    }

    /// The same with somebody who sees the progress, and may stop the work; what is done then is kept.
    pub fn simulate_observed(
        &self,
        observer: impl FnMut(&Progress) -> ControlFlow<()> + Send,
    ) -> Simulation {
        let outcome = simulate(&self.0, &mut Watched::by(observer));
        let inputs = self.0.inputs().map(PathBuf::from).collect();
        Simulation { outcome, inputs }
    }
}

/// What came out of a study.
pub struct Simulation {
    outcome: StudyOutcome,
    inputs: Vec<PathBuf>,
}

impl Simulation {
    /// One row for each path, controller, compensator and what it assumes of the axis.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = SimulatedRow<'_>> {
        self.outcome.file.results.iter().map(SimulatedRow)
    }

    /// Whether it was done to its end, and exported C gave the force of its model.
    pub fn verdict(&self) -> Verdict {
        self.outcome.verdict()
    }

    /// What to beware of.
    pub fn warnings(&self) -> impl Iterator<Item = Notice> {
        self.outcome.file.warnings.iter().map(Notice::of)
    }

    /// Everything that came out, as `study.json` has it (docs/study.md).
    pub fn result(&self) -> Value {
        serde_json::to_value(&self.outcome.file).expect("plain data")
    }

    /// The report, one HTML file without scripts.
    pub fn report(&self) -> String {
        report::study(&self.outcome).to_html()
    }

    /// As the command line prints it.
    pub fn text(&self) -> String {
        text::study(&self.outcome)
    }

    /// Writes `study.json`, `report.html` and the courses of the runs into a folder, whole or not at all; their paths.
    ///
    /// # Errors
    /// Where the folder cannot be written, or holds something that stiction did not write.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, Error> {
        let folder = folder.as_ref();
        let written = stiction_files::check_folder_of(folder, SCHEMA, false)
            .and_then(|()| stiction_files::check_inputs(folder, &self.inputs))
            .and_then(|()| bundle::study(&self.outcome).write(folder));
        written.map_err(Error::of)
    }
}

/// One row of the results of a study.
#[derive(Clone, Copy, Debug)]
pub struct SimulatedRow<'a>(&'a ResultRow);

/// A metric over the runs of a row.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Metric {
    /// Mean over the runs.
    pub mean: f64,
    /// Least of all runs.
    pub least: f64,
    /// Largest of all runs.
    pub largest: f64,
    /// SI unit of these.
    pub unit: String,
    /// By how much the mean is below that without compensation, percent; `None` of the row without, and where that mean is 0.
    pub reduction_percent: Option<f64>,
}

impl<'a> SimulatedRow<'a> {
    /// Name of the path.
    pub fn path(&self) -> &'a str {
        &self.0.path
    }

    /// Name of the controller.
    pub fn controller(&self) -> &'a str {
        &self.0.controller
    }

    /// Name of the compensator; `none` without.
    pub fn compensator(&self) -> &'a str {
        &self.0.compensator
    }

    /// What it assumed of the parameters of the axis: `exact`, `±10 %`, `100 draws`.
    pub fn parameters(&self) -> &'a str {
        &self.0.parameters
    }

    /// Runs that count here.
    pub fn runs(&self) -> usize {
        self.0.runs
    }

    /// Runs in which the watchdog switched the compensation off.
    pub fn switched_off(&self) -> usize {
        self.0.switched_off
    }

    /// A metric by its name in docs/study.md, such as `peak_error`; `None` where it is not one of this path.
    pub fn metric(&self, name: &str) -> Option<Metric> {
        self.0.metric(name).map(|own| Metric {
            mean: own.mean,
            least: own.least,
            largest: own.largest,
            unit: own.unit.clone(),
            reduction_percent: own.reduction_percent,
        })
    }
}
