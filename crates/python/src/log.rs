//! Logs: read from files or taken from arrays, and looked at.

use crate::axis::Axis;
use crate::error::raised;
use crate::run::{How, Stopped, run};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use stiction::commands::{check as workflow, text};
use stiction::{Column, Severity};

/// A recording in SI units.
#[pyclass(frozen, module = "stiction._native")]
pub struct Log {
    /// As the library has it.
    pub log: stiction::Log,
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
        let (log, _) = run(py, &How::quiet(), |_| {
            stiction::Log::open_with(&path, &axis.axis)
        })?;
        let log = log.map_err(|e| raised(py, &e))?;
        Ok(Self { log })
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
        let (log, _) = run(py, &How::quiet(), |_| {
            stiction::Log::from_columns(name, columns, &axis.axis)
        })?;
        let log = log.map_err(|e| raised(py, &e))?;
        Ok(Self { log })
    }

    #[getter]
    fn path(&self) -> &Path {
        self.log.path()
    }

    #[getter]
    fn sha256(&self) -> &str {
        self.log.sha256()
    }

    #[getter]
    fn samples(&self) -> usize {
        self.log.samples()
    }

    #[getter]
    fn rate_hz(&self) -> f64 {
        self.log.rate_hz()
    }

    #[getter]
    fn kind(&self) -> String {
        self.log.motion().to_string()
    }

    #[getter]
    fn force_unit(&self) -> &str {
        self.log.force_unit()
    }

    #[getter]
    fn detected(&self) -> Vec<String> {
        self.log.detected().to_vec()
    }

    #[getter]
    fn findings(&self) -> Vec<Told> {
        let told = self.log.findings().iter().map(|f| {
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
        let log = &self.log;
        let values = match name {
            "time" => Some(log.time()),
            "position" => log.position(),
            "velocity" => log.velocity(),
            "force" => log.force(),
            "reference" => log.reference(),
            _ => None,
        };
        values.map(|values| values.to_vec().into_pyarray(py))
    }
}

/// JSON, text for people, and whether each log determines a law that may be trusted.
type Checked = (String, String, bool);

fn checked(py: Python<'_>, found: Result<workflow::Check, stiction::Error>) -> PyResult<Checked> {
    let found = found.map_err(|e| raised(py, &e))?;
    let json = serde_json::to_string(&found).expect("plain data");
    let trusted = found.verdict() == stiction::Verdict::Trustworthy;
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
    let logs: Vec<stiction::Log> = logs.iter().map(|log| log.get().log.clone()).collect();
    let (found, _) = run(py, &how, |observer| {
        stiction::check(&logs, &axis.axis, observer)
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
    let (written, _) = run(py, &How::quiet(), |_| stiction::demo::write_log(path, seed))?;
    written.map_err(|e| raised(py, &e))
}

/// Writes the logs of the same axis for the procedures into a folder, and returns their paths.
#[pyfunction]
pub fn write_procedure_logs(py: Python<'_>, folder: PathBuf, seed: u64) -> PyResult<Vec<PathBuf>> {
    let (written, _) = run(py, &How::quiet(), |_| {
        stiction::demo::procedures(folder, seed)
    })?;
    written.map(|(logs, _)| logs).map_err(|e| raised(py, &e))
}

/// Limits the memory that reading a log may take, bytes.
#[pyfunction]
pub fn allow_memory(bytes: u64) {
    stiction::allow_memory(bytes);
}
