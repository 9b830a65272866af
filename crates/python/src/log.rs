//! Logs: read from files or taken from arrays, and looked at.

use crate::axis::Axis;
use crate::error::raised;
use crate::run::{How, Stopped, run};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use stiction_log::{Column, Severity};
use stiction_pages::text;
use stiction_workflows::check as workflow;
use stiction_workflows::source::{self, Source};

/// A recording in SI units.
#[pyclass(frozen, module = "stiction._native")]
pub struct Log {
    /// As the library has it.
    pub source: Source,
}

/// Header, unit where it is not in the header, samples.
type Given<'py> = (String, Option<String>, PyReadonlyArray1<'py, f64>);
/// Code, `note` or `warning`, message.
type Told = (String, &'static str, String);

#[pymethods]
impl Log {
    /// Reads a file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, axis: &Axis) -> PyResult<Self> {
        let (source, _) = run(py, &How::quiet(), |_| source::load(&path, &axis.axis))?;
        let source = source.map_err(|e| raised(py, &e))?;
        Ok(Self { source })
    }

    /// Takes columns that are in memory.
    #[staticmethod]
    fn of_columns(
        py: Python<'_>,
        name: &str,
        columns: Vec<Given<'_>>,
        axis: &Axis,
    ) -> PyResult<Self> {
        let columns: Vec<Column> = columns
            .into_iter()
            .map(|(header, unit, values)| {
                let values = values.as_array().to_vec();
                match unit {
                    None => Column::headed(&header, values),
                    unit => Column {
                        name: header,
                        unit,
                        values,
                        ..Column::default()
                    },
                }
            })
            .collect();
        let (source, _) = run(py, &How::quiet(), |_| {
            source::in_memory(name, columns, &axis.axis)
        })?;
        let source = source.map_err(|e| raised(py, &e))?;
        Ok(Self { source })
    }

    #[getter]
    fn path(&self) -> &Path {
        &self.source.path
    }

    #[getter]
    fn sha256(&self) -> &str {
        &self.source.sha256
    }

    #[getter]
    fn samples(&self) -> usize {
        self.source.log.time.len()
    }

    #[getter]
    fn rate_hz(&self) -> f64 {
        self.source.log.rate_hz
    }

    #[getter]
    fn kind(&self) -> String {
        self.source.log.motion.to_string()
    }

    #[getter]
    fn force_unit(&self) -> &str {
        &self.source.log.force_unit
    }

    #[getter]
    fn detected(&self) -> Vec<String> {
        self.source.detected.clone()
    }

    #[getter]
    fn findings(&self) -> Vec<Told> {
        let told = self.source.log.findings.iter().map(|f| {
            let severity = match f.severity {
                Severity::Note => "note",
                Severity::Warning => "warning",
            };
            (f.code().to_string(), severity, f.to_string())
        });
        told.collect()
    }

    /// A channel by its name; `None` where the log has none.
    fn channel<'py>(&self, py: Python<'py>, name: &str) -> Option<Bound<'py, PyArray1<f64>>> {
        let log = &self.source.log;
        let values = match name {
            "time" => Some(&log.time),
            "position" => log.position.as_ref(),
            "velocity" => log.velocity.as_ref(),
            "force" => log.force.as_ref(),
            "reference" => log.reference.as_ref(),
            _ => None,
        };
        values.map(|values| values.clone().into_pyarray(py))
    }
}

/// JSON, text for people, and whether each log determines a law that may be trusted.
type Checked = (String, String, bool);

fn checked(
    py: Python<'_>,
    found: Result<workflow::Check, stiction_workflows::Error>,
) -> PyResult<Checked> {
    let found = found.map_err(|e| raised(py, &e))?;
    let json = serde_json::to_string(&found).expect("plain data");
    let trusted = found.verdict() == stiction_workflows::Verdict::Trustworthy;
    Ok((json, text::check(&found), trusted))
}

/// What logs can and cannot determine.
#[pyfunction]
pub fn check(
    py: Python<'_>,
    logs: Vec<Py<Log>>,
    axis: &Axis,
    progress: Option<Py<PyAny>>,
    threads: Option<usize>,
) -> PyResult<Checked> {
    let how = How {
        progress,
        threads,
        stopped: Stopped::Loses,
    };
    let sources: Vec<Source> = logs.iter().map(|log| log.get().source.clone()).collect();
    let (found, _) = run(py, &how, |observer| {
        workflow::check_logs(&sources, &axis.axis, observer)
    })?;
    checked(py, found)
}

/// The same of files, as the command line does.
#[pyfunction]
pub fn check_files(
    py: Python<'_>,
    logs: Vec<PathBuf>,
    axis: Option<PathBuf>,
    progress: Option<Py<PyAny>>,
    threads: Option<usize>,
) -> PyResult<Checked> {
    let how = How {
        progress,
        threads,
        stopped: Stopped::Loses,
    };
    let (found, _) = run(py, &how, |observer| {
        workflow::check(&logs, axis.as_deref(), observer)
    })?;
    checked(py, found)
}

/// Writes the log of a simulated axis.
#[pyfunction]
pub fn write_demo_log(py: Python<'_>, path: PathBuf, seed: u64) -> PyResult<()> {
    let (written, _) = run(py, &How::quiet(), |_| {
        stiction_workflows::demo::write_log(path, seed)
    })?;
    written.map_err(|e| raised(py, &e))
}

/// Writes the logs of the same axis for the procedures into a folder, and returns their paths.
#[pyfunction]
pub fn write_procedure_logs(py: Python<'_>, folder: PathBuf, seed: u64) -> PyResult<Vec<PathBuf>> {
    let (written, _) = run(py, &How::quiet(), |_| {
        stiction_workflows::demo::procedures(folder, seed)
    })?;
    written.map(|(logs, _)| logs).map_err(|e| raised(py, &e))
}

/// Limits the memory that reading a log may take, bytes.
#[pyfunction]
pub fn allow_memory(bytes: u64) {
    stiction_formats::allow_memory(bytes);
}
