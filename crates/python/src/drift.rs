//! Friction over time.

use crate::error::{Refusal, raised};
use crate::run::{How, Watch, run};
use crate::study::{bundled, saved, unbundled};
use numpy::PyArray1;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use stiction_files::Bundle;
use stiction_files::batch::{self, LogRow, rows_while};
use stiction_files::drift_file::SCHEMA;
use stiction_formats::Cells;
use stiction_pages::bundle;
use stiction_pages::text;
use stiction_workflows::Error;
use stiction_workflows::drift::{
    DriftOutcome, Limit, Shown, Times, drift_of_rows_while, drift_while,
};

/// A parameter of a machine over time: names first, then times, estimates, deviations and temperatures of its logs, what is left
/// of the estimates without what temperature does, with the ends of their intervals, the level of the first logs, and the logs.
type Parts = (
    (String, String, String, String),
    [Vec<f64>; 7],
    f64,
    Vec<String>,
);

/// What changed.
#[pyclass(frozen, module = "stiction._native")]
pub struct Drift {
    bundle: Bundle,
    json: String,
    text: String,
    courses: Vec<Parts>,
    inputs: Vec<PathBuf>,
}

/// Files of it.
const NAMES: [&str; 2] = ["report.html", "drift.json"];

impl Drift {
    /// `table` is the one that it was read from.
    fn of(outcome: &DriftOutcome, table: Option<PathBuf>) -> Self {
        // Only a table in a file has a command that leads on.
        let folder = Path::new("drift");
        Self {
            bundle: bundle::drift(outcome),
            json: serde_json::to_string(&outcome.file).expect("plain data"),
            text: text::drift(&outcome.file, table.is_none().then_some(folder)),
            courses: outcome.shown.iter().map(course).collect(),
            inputs: table.into_iter().collect(),
        }
    }
}

fn course(shown: &Shown) -> Parts {
    let names = (
        shown.machine.clone(),
        shown.parameter.clone(),
        shown.law.clone(),
        shown.unit.clone(),
    );
    let points = &shown.followed.points;
    let (low, high) = shown.judged.intervals().unzip();
    let columns = [
        points.iter().map(|p| p.time).collect(),
        points.iter().map(|p| p.value).collect(),
        points.iter().map(|p| p.std).collect(),
        points
            .iter()
            .map(|p| p.temperature.unwrap_or(f64::NAN))
            .collect(),
        shown.judged.corrected.clone(),
        low,
        high,
    ];
    let logs = shown.followed.logs.iter().map(|(log, _)| log.clone());
    (names, columns, shown.judged.reference, logs.collect())
}

/// Names of the columns of a course.
const COLUMNS: [&str; 7] = [
    "time",
    "value",
    "std",
    "temperature",
    "corrected",
    "low",
    "high",
];

/// What [`Drift`] is pickled as.
type Kept = (
    Vec<(String, Vec<u8>)>,
    String,
    String,
    Vec<Parts>,
    Vec<PathBuf>,
);

/// Machine, parameter, law, unit; columns with their names; level of the first logs; logs.
type Course<'py> = (
    (String, String, String, String),
    Vec<(&'static str, Bound<'py, PyArray1<f64>>)>,
    f64,
    Vec<String>,
);

#[pymethods]
impl Drift {
    /// What `parts` gave.
    #[staticmethod]
    fn of_parts(parts: Kept) -> Self {
        let (files, json, text, courses, inputs) = parts;
        Self {
            bundle: bundled(&NAMES, files),
            json,
            text,
            courses,
            inputs,
        }
    }

    /// All that it is made of.
    fn parts(&self) -> Kept {
        (
            unbundled(&self.bundle),
            self.json.clone(),
            self.text.clone(),
            self.courses.clone(),
            self.inputs.clone(),
        )
    }

    /// `drift.json`.
    fn result_json(&self) -> &str {
        &self.json
    }

    /// As the command line prints it.
    fn text(&self) -> &str {
        &self.text
    }

    /// The report.
    fn report(&self) -> String {
        let mut files = self.bundle.files().iter();
        let report = files.find(|(name, _)| *name == NAMES[0]);
        report.map_or_else(String::new, |(_, bytes)| {
            String::from_utf8_lossy(bytes).into_owned()
        })
    }

    /// The courses of what is alarmed, in the order of the alarms.
    fn courses<'py>(&self, py: Python<'py>) -> Vec<Course<'py>> {
        let each = self.courses.iter().map(|(names, columns, first, logs)| {
            let columns = COLUMNS.iter().zip(columns);
            let columns = columns.map(|(name, column)| (*name, PyArray1::from_slice(py, column)));
            (names.clone(), columns.collect(), *first, logs.clone())
        });
        each.collect()
    }

    /// Writes the files of the command line.
    fn save(&self, py: Python<'_>, folder: PathBuf, force: bool) -> PyResult<Vec<PathBuf>> {
        saved(py, (&self.bundle, SCHEMA), &self.inputs, &folder, force)
    }
}

/// Limits as they are typed; what is wrong with one is told of the argument.
fn limits(typed: &[String]) -> Result<Vec<Limit>, Error> {
    typed.iter().map(|text| Limit::read(text)).collect()
}

fn followed(
    py: Python<'_>,
    table: Option<PathBuf>,
    work: impl FnOnce(&mut Watch<'_>) -> Result<Option<DriftOutcome>, Error> + Send,
) -> PyResult<Drift> {
    let (found, _) = run(py, &How::quiet(), |watch| {
        let outcome = work(watch)?;
        Ok(outcome.map(|outcome| Drift::of(&outcome, table)))
    })?;
    let found = found.map_err(|e: Error| raised(py, &e))?;
    // Whoever stopped it raised an error of their own.
    found.ok_or_else(|| PyKeyboardInterrupt::new_err(()))
}

/// What changed in a table, or in a folder of tables.
#[pyfunction]
pub fn drift(
    py: Python<'_>,
    table: PathBuf,
    limit: Vec<String>,
    times: Option<String>,
) -> PyResult<Drift> {
    followed(py, Some(table.clone()), |watch| {
        drift_while(
            &table,
            &limits(&limit)?,
            Times::read(times.as_deref())?,
            || watch.goes_on(),
        )
    })
}

/// A column of a table in memory.
#[derive(FromPyObject)]
pub enum Column {
    /// Yes and no.
    Flags(Vec<Option<bool>>),
    /// Numbers.
    Numbers(Vec<Option<f64>>),
    /// Text.
    Text(Vec<Option<String>>),
}

impl From<Column> for Cells {
    fn from(column: Column) -> Self {
        match column {
            Column::Flags(flags) => Cells::Flags(flags),
            Column::Numbers(numbers) => {
                let numbers = numbers.into_iter();
                Cells::Numbers(numbers.map(|x| x.unwrap_or(f64::NAN)).collect())
            }
            Column::Text(texts) => Cells::of_text(texts),
        }
    }
}

/// What changed in a table in memory, whose columns are all of one length.
#[pyfunction]
pub fn drift_of_columns(
    py: Python<'_>,
    name: String,
    columns: Vec<(String, Bound<'_, PyAny>)>,
    limit: Vec<String>,
    times: Option<String>,
) -> PyResult<Drift> {
    let taken = |(name, cells): (String, Bound<'_, PyAny>)| {
        py.check_signals()?;
        PyResult::Ok((name, cells.extract::<Column>()?))
    };
    let columns: PyResult<HashMap<String, Column>> = columns.into_iter().map(taken).collect();
    let mut columns = columns?;
    followed(py, None, |watch| {
        let of = |name: &&str| columns.remove(*name).map(Cells::from);
        let columns: Vec<Option<Cells>> = batch::COLUMNS.iter().map(of).collect();
        let mut rows = Vec::new();
        let take = |row| {
            rows.push(row);
            Ok(())
        };
        if !rows_while(Path::new(&name), &columns, || watch.goes_on(), take)? {
            return Ok(None);
        }
        drift_of_rows_while(
            &name,
            rows,
            &limits(&limit)?,
            Times::read(times.as_deref())?,
            || watch.goes_on(),
        )
    })
}

/// What changed in rows as `identify_row` gives them.
#[pyfunction]
pub fn drift_of_rows(
    py: Python<'_>,
    name: String,
    rows: Vec<String>,
    limit: Vec<String>,
    times: Option<String>,
) -> PyResult<Drift> {
    let read = |(k, row): (usize, &String)| {
        py.check_signals()?;
        serde_json::from_str(row).map_err(|e| {
            let place = format!("{name}[{k}]");
            let allowed = "a row that identify_uri gives";
            let said = e.to_string();
            // A row is no text that has lines and columns.
            let said = said.split(" at line ").next().unwrap_or_default();
            Refusal::argument(&place, said, allowed).raise(py)
        })
    };
    let rows: PyResult<Vec<LogRow>> = rows.iter().enumerate().map(read).collect();
    let rows = rows?;
    followed(py, None, |watch| {
        drift_of_rows_while(
            &name,
            rows,
            &limits(&limit)?,
            Times::read(times.as_deref())?,
            || watch.goes_on(),
        )
    })
}
