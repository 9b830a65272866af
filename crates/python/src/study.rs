//! Studies: an axis with and without compensation.

use crate::error::raised;
use crate::run::{How, Stopped, run};
use pyo3::prelude::*;
use std::path::PathBuf;
use stiction_files::study::result::SCHEMA;
use stiction_files::{Bundle, check_folder_of, check_inputs};
use stiction_pages::bundle;
use stiction_pages::text;

/// Files by name, JSON, text, paths that were read, and a verdict where there is one.
pub type Parts = (Vec<(String, Vec<u8>)>, String, String, Vec<PathBuf>, String);

/// Files of a kind of outcome that have these names, in their order.
pub fn bundled(names: &[&'static str], files: Vec<(String, Vec<u8>)>) -> Bundle {
    let mut bundle = Bundle::default();
    for name in names {
        match files.iter().find(|(own, _)| own == name) {
            Some((_, content)) => bundle.add(*name, content.clone()),
            None => bundle.lacks(*name),
        }
    }
    bundle
}

/// Files with their names.
pub fn unbundled(bundle: &Bundle) -> Vec<(String, Vec<u8>)> {
    let files = bundle.files().iter();
    files
        .map(|(name, content)| (name.to_string(), content.clone()))
        .collect()
}

/// What came out of a study.
#[pyclass(frozen, module = "stiction._native")]
pub struct Study {
    bundle: Bundle,
    json: String,
    text: String,
    inputs: Vec<PathBuf>,
    /// `trustworthy`, `not-trustworthy` or `interrupted`.
    #[pyo3(get)]
    verdict: &'static str,
}

/// Files of a study.
const NAMES: [&str; 4] = [
    "report.html",
    "trajectories.csv",
    "contours.csv",
    "study.json",
];
const VERDICTS: [&str; 3] = ["trustworthy", "not-trustworthy", "interrupted"];

#[pymethods]
impl Study {
    /// What `parts` gave.
    #[staticmethod]
    fn of_parts(parts: Parts) -> Option<Self> {
        let (files, json, text, inputs, verdict) = parts;
        let mut verdicts = VERDICTS.into_iter();
        Some(Self {
            bundle: bundled(&NAMES, files),
            json,
            text,
            inputs,
            verdict: verdicts.find(|own| *own == verdict)?,
        })
    }

    /// All that it is made of.
    fn parts(&self) -> Parts {
        let files = unbundled(&self.bundle);
        let (json, text) = (self.json.clone(), self.text.clone());
        let verdict = self.verdict.to_string();
        (files, json, text, self.inputs.clone(), verdict)
    }

    /// `study.json`.
    fn result_json(&self) -> &str {
        &self.json
    }

    /// As the command line prints it.
    fn text(&self) -> &str {
        &self.text
    }

    /// A file of it as text; `None` where there is none.
    fn file(&self, name: &str) -> Option<String> {
        let mut files = self.bundle.files().iter();
        let file = files.find(|(own, _)| *own == name);
        file.map(|(_, bytes)| String::from_utf8_lossy(bytes).into_owned())
    }

    /// Writes the files of the command line.
    fn save(&self, py: Python<'_>, folder: PathBuf, force: bool) -> PyResult<Vec<PathBuf>> {
        saved(py, (&self.bundle, SCHEMA), &self.inputs, &folder, force)
    }
}

/// Writes files into a folder, or beside it where they are of an outcome that was stopped and a complete one is there.
pub fn saved(
    py: Python<'_>,
    (bundle, schema): (&Bundle, &str),
    inputs: &[PathBuf],
    folder: &std::path::Path,
    force: bool,
) -> PyResult<Vec<PathBuf>> {
    let write = || -> Result<Vec<PathBuf>, stiction_workflows::Error> {
        check_folder_of(folder, schema, force)?;
        check_inputs(folder, inputs)?;
        let beside = bundle::beside_complete(bundle, folder, schema, false);
        Ok(bundle.write(beside.as_deref().unwrap_or(folder))?)
    };
    py.detach(write).map_err(|e| raised(py, &e))
}

/// Simulates a study file.
#[pyfunction]
pub fn simulate(
    py: Python<'_>,
    study: PathBuf,
    max_samples: Option<u64>,
    progress: Option<Py<PyAny>>,
    threads: Option<usize>,
) -> PyResult<(Study, bool)> {
    let how = How {
        progress,
        threads,
        stopped: Stopped::Keeps,
    };
    let (found, stopped) = run(py, &how, |observer| {
        let study = match max_samples {
            Some(most) => stiction_files::study::Study::read_within(&study, most)?,
            None => stiction_files::study::Study::read(&study)?,
        };
        let outcome = stiction_workflows::study::simulate(&study, observer);
        Ok(Study {
            bundle: bundle::study(&outcome),
            json: serde_json::to_string(&outcome.file).expect("plain data"),
            text: text::study(&outcome),
            inputs: study.inputs().map(PathBuf::from).collect(),
            verdict: outcome.verdict().name(),
        })
    })?;
    let study = found.map_err(|e: stiction_workflows::Error| raised(py, &e))?;
    Ok((study, stopped))
}
