//! The rows of a batch, one log at a time: what processes of a fleet find, and the tables that it is kept in.

use crate::error::{Refusal, raised};
use crate::options::Asked;
use crate::run::{How, Stopped, run};
use pyo3::prelude::*;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use stiction_codes::Code;
use stiction_files::batch::{Listed, LogRow, Results, read_results as read};
use stiction_workflows::batch::{Batch, Called};
use stiction_workflows::identify::Options;

/// Seconds of a time as a list of logs has it, since 1970 UTC of a date; `None` of anything else.
#[pyfunction]
pub fn seconds_of(text: &str) -> Option<f64> {
    stiction_files::batch::seconds_of(text)
}

/// A log, and what is known of it: a dict with every key.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Given {
    /// The file to read.
    file: PathBuf,
    /// What the row calls it; `None` calls it by its path.
    path: Option<String>,
    machine: Option<String>,
    time: Option<f64>,
    temperature: Option<f64>,
    /// The axis file to read.
    axis_file: Option<PathBuf>,
    /// What the row calls that.
    axis: Option<String>,
}

impl Given {
    fn batch(self, options: Asked) -> Result<Batch, Refusal> {
        let listed = Listed {
            path: self.file,
            machine: self.machine,
            time: self.time,
            temperature: self.temperature,
            axis: self.axis_file,
        };
        let called = Called {
            log: self.path,
            axis: self.axis,
        };
        Ok(Batch::single(listed, called, &options.options()?))
    }
}

/// As Python has it: the row as JSON.
fn json(row: &LogRow) -> String {
    serde_json::to_string(row).expect("plain data")
}

/// Identifies a log; where its row would have the key that is known, a row with that key and what is known of the log beside it.
#[pyfunction]
pub fn identify_row(
    py: Python<'_>,
    log: Given,
    options: Asked,
    known: Option<String>,
    memory: Option<u64>,
) -> PyResult<String> {
    let batch = log.batch(options).map_err(|e| e.raise(py))?;
    let how = How {
        progress: None,
        threads: Some(1),
        stopped: Stopped::Loses,
    };
    let memory = memory.unwrap_or_else(stiction_formats::allowed_memory);
    let (row, _) = run(py, &how, |observer| {
        batch.row(known.as_deref(), memory, observer)
    })?;
    let row = row.map_err(|e| raised(py, &e))?;
    let row = row.or_else(|| known.map(|key| batch.known(key)));
    Ok(json(&row.expect("a row, or one that is known")))
}

/// The row of a log that could not be read, or of which nothing came back.
#[pyfunction]
pub fn unread_row(
    py: Python<'_>,
    log: Given,
    options: Asked,
    code: &str,
    message: String,
) -> PyResult<String> {
    let unknown = || Refusal::argument("code", format!("{code:?}"), "a code of docs/codes");
    let code = Code::from_name(code).ok_or_else(|| unknown().raise(py))?;
    let batch = log.batch(options).map_err(|e| e.raise(py))?;
    Ok(json(&batch.unread(code, message)))
}

/// Path, machine, time, temperature, axis file.
type Found = (
    PathBuf,
    Option<String>,
    Option<f64>,
    Option<f64>,
    Option<PathBuf>,
);

/// The logs of folders, patterns, lists and files, as `stiction batch` finds them for that axis file; but for what is in `out`.
#[pyfunction]
pub fn find_logs(
    py: Python<'_>,
    inputs: Vec<PathBuf>,
    axis: Option<PathBuf>,
    out: PathBuf,
) -> PyResult<Vec<Found>> {
    let batch = py.detach(|| {
        let options = Options::default();
        Batch::new(&inputs, axis.as_deref(), &options, false, &out)
    });
    let batch = batch.map_err(|e| raised(py, &e))?;
    let logs = batch.logs().map(|log| {
        (
            log.path.clone(),
            log.machine.clone(),
            log.time,
            log.temperature,
            log.axis.clone(),
        )
    });
    Ok(logs.collect())
}

/// What is known of a log beside its bytes: machine, time, temperature, axis file.
type Label = (Option<String>, Option<f64>, Option<f64>, Option<String>);

/// Path, key, code of the error, whether it is trustworthy, and what is known of it beside.
type Kept = (String, String, Option<String>, Option<bool>, Label);

/// What a table holds, log by log.
#[pyfunction]
pub fn read_rows(py: Python<'_>, table: PathBuf) -> PyResult<Vec<Kept>> {
    let mut rows = Vec::new();
    let done = py.detach(|| {
        read(&table, |row| {
            let error = row.error.map(|code| code.to_string());
            let label = (row.machine, row.time, row.temperature, row.axis);
            rows.push((row.path, row.key, error, row.trustworthy, label));
            Ok(())
        })
    });
    done.map_err(|e| raised(py, &e.into()))?;
    Ok(rows)
}

/// Writes a table of rows, whole or not at all.
#[pyfunction]
pub fn write_rows(py: Python<'_>, table: PathBuf, rows: Vec<String>) -> PyResult<()> {
    let written = py.detach(|| {
        let mut out = Results::begin(&table)?;
        for row in &rows {
            // Rows are those of `identify_row`; another program's are refused.
            let row: LogRow = serde_json::from_str(row).map_err(|e| foreign(&table, &e))?;
            out.add(&row)?;
        }
        out.end()
    });
    written.map_err(|e| raised(py, &e.into()))
}

fn foreign(table: &Path, error: &serde_json::Error) -> stiction_files::Error {
    let reason = format!("a row that is none of stiction's: {error}");
    stiction_files::Error::output(table, reason)
}

/// Writes a table anew without the logs of those paths, and others with what is known of them now, whole or not at all; returns
/// how many are left.
#[pyfunction]
pub fn keep_rows(
    py: Python<'_>,
    table: PathBuf,
    out: PathBuf,
    without: HashSet<String>,
    labels: HashMap<String, Label>,
) -> PyResult<usize> {
    let mut left = 0;
    let written = py.detach(|| {
        let mut kept = Results::begin(&out)?;
        read(&table, |mut row| {
            if let Some(label) = labels.get(&row.path) {
                (row.machine, row.time, row.temperature, row.axis) = label.clone();
            }
            if without.contains(&row.path) {
                return Ok(());
            }
            left += 1;
            kept.add(&row)
        })?;
        kept.end()
    });
    written.map_err(|e| raised(py, &e.into()))?;
    Ok(left)
}
