//! Identification of a robot, and what it found.

use crate::error::raised;
use crate::fit::Fit;
use crate::run::{How, Stopped, run};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use stiction_files::robot::result::SCHEMA;
use stiction_files::{check_folder_of, check_inputs};
use stiction_pages::bundle;
use stiction_pages::{report, text};
use stiction_workflows::Verdict;
use stiction_workflows::robot::{Files, Options, RobotOutcome};

/// What was identified of a robot.
#[pyclass(frozen, module = "stiction._native")]
pub struct Robot {
    outcome: RobotOutcome,
    /// Whether it was told to stop.
    stopped: bool,
}

#[pymethods]
impl Robot {
    /// `robot.json`.
    fn result_json(&self) -> String {
        serde_json::to_string(&self.outcome.result).expect("plain data")
    }

    /// As the command line prints it.
    fn text(&self) -> String {
        text::robot_in_full(&self.outcome)
    }

    /// `report.html`.
    fn report(&self, py: Python<'_>) -> String {
        py.detach(|| report::robot(&self.outcome, Path::new("result")).to_html())
    }

    /// `trustworthy`, `not-trustworthy` or `interrupted`.
    #[getter]
    fn verdict(&self) -> &'static str {
        let verdict = match self.stopped {
            true => Verdict::Interrupted,
            false => self.outcome.verdict(),
        };
        verdict.name()
    }

    /// The friction of a joint as that of an axis; `None` where it could not be fitted.
    fn fit(&self, name: &str) -> Option<Fit> {
        let mut joints = self.outcome.joints.iter();
        let joint = joints.find(|joint| joint.name == name)?;
        joint.outcome.as_ref().ok().cloned().map(Fit::of)
    }

    /// Writes the files of the command line.
    fn write(&self, py: Python<'_>, folder: PathBuf, force: bool) -> PyResult<Vec<PathBuf>> {
        let write = || -> Result<Vec<PathBuf>, stiction_workflows::Error> {
            check_folder_of(&folder, SCHEMA, force)?;
            check_inputs(&folder, self.outcome.inputs())?;
            let bundle = bundle::robot(&self.outcome, &folder);
            let beside = bundle::beside_complete(&bundle, &folder, SCHEMA, self.stopped);
            Ok(bundle.write(beside.as_deref().unwrap_or(&folder))?)
        };
        py.detach(write).map_err(|e| raised(py, &e))
    }
}

/// Identifies a robot from files, as the command line does; what was found, and whether it was told to stop.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // By their names in Python.
pub fn robot(
    py: Python<'_>,
    logs: Vec<PathBuf>,
    urdf: Option<PathBuf>,
    robot: Option<PathBuf>,
    validate: Vec<PathBuf>,
    split: Option<f64>,
    seed: u64,
    progress: Option<Py<PyAny>>,
    threads: Option<usize>,
) -> PyResult<(Robot, bool)> {
    let files = Files {
        logs,
        urdf,
        robot,
        validate,
    };
    let mut options = Options::default();
    options.split = split;
    options.seed = seed;
    let how = How {
        progress,
        threads,
        stopped: Stopped::Keeps,
    };
    let (found, stopped) = run(py, &how, |observer| {
        stiction_workflows::robot::robot(&files, &options, observer)
    })?;
    let outcome = found.map_err(|e| raised(py, &e))?;
    Ok((Robot { outcome, stopped }, stopped))
}
