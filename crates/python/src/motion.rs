//! Plans: the motion to record.

use crate::error::{Refusal, raised};
use crate::options::unknown;
use crate::run::{How, Stopped, run};
use crate::study::{Parts, bundled, saved, unbundled};
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use std::path::PathBuf;
use stiction_files::plan::SCHEMA;
use stiction_files::{Bundle, Looks, looks};
use stiction_pages::{bundle, text};
use stiction_parameters::LawKind;
use stiction_workflows::plan::{Carrier, Known, PLANNED, PlanOptions, Want, plan as plan_motion};

/// A planned motion.
#[pyclass(frozen, module = "stiction._native")]
pub struct Plan {
    bundle: Bundle,
    json: String,
    text: String,
    inputs: Vec<PathBuf>,
}

/// Files of a plan beside the forms of its set points.
const NAMES: [&str; 2] = ["report.html", "plan.toml"];

/// Every file that a plan may have.
fn names() -> Vec<&'static str> {
    let forms = Carrier::ALL.map(Carrier::file);
    forms.into_iter().chain(NAMES).collect()
}

#[pymethods]
impl Plan {
    /// What `parts` gave.
    #[staticmethod]
    fn of_parts(parts: Parts) -> Self {
        let (files, json, text, inputs, _) = parts;
        Self {
            bundle: bundled(&names(), files),
            json,
            text,
            inputs,
        }
    }

    /// All that it is made of.
    fn parts(&self) -> Parts {
        let files = unbundled(&self.bundle);
        let (json, text) = (self.json.clone(), self.text.clone());
        (files, json, text, self.inputs.clone(), String::new())
    }

    /// `plan.toml`, as JSON.
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

    /// The columns of `setpoints.csv`: name, unit, samples.
    fn setpoints<'py>(
        &self,
        py: Python<'py>,
    ) -> Vec<(String, Option<String>, Bound<'py, PyArray1<f64>>)> {
        let columns = self.file("setpoints.csv");
        let columns = columns.and_then(|text| stiction_pages::bundle::fit_columns(&text));
        let columns = columns.into_iter().flatten();
        columns
            .map(|c| (c.name, c.unit, c.values.into_pyarray(py)))
            .collect()
    }

    /// Writes the files of the command line.
    fn save(&self, py: Python<'_>, folder: PathBuf, force: bool) -> PyResult<Vec<PathBuf>> {
        saved(py, (&self.bundle, SCHEMA), &self.inputs, &folder, force)
    }
}

/// A dict with every option.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Asked {
    known: Option<PathBuf>,
    probe: bool,
    time: Option<f64>,
    seed: u64,
    wants: Vec<String>,
    formats: Vec<String>,
    start: Option<String>,
    asymmetric: bool,
    law: Option<String>,
}

/// Plans the motion to record for the axis of a file; none where it was stopped before there was one.
#[pyfunction]
pub fn plan(
    py: Python<'_>,
    axis: PathBuf,
    options: Asked,
    progress: Option<Py<PyAny>>,
    threads: Option<usize>,
) -> PyResult<(Option<Plan>, bool)> {
    let how = How {
        progress,
        threads,
        stopped: Stopped::Keeps,
    };
    let files = [Some(axis.clone()), options.known.clone()];
    let wants: Result<Vec<Want>, Refusal> = options.wants.iter().map(|text| want(text)).collect();
    let carriers: Result<Vec<Carrier>, Refusal> =
        options.formats.iter().map(|name| carrier(name)).collect();
    let law: Result<Option<LawKind>, Refusal> = options.law.as_deref().map(law).transpose();
    let options = PlanOptions {
        time: options.time,
        probe: options.probe,
        known: options.known.map(|file| match looks(&file) {
            Some(Looks::Model) => Known::Model(file),
            _ => Known::Log(file),
        }),
        seed: options.seed,
        wants: wants.map_err(|refusal| refusal.raise(py))?,
        carriers: carriers.map_err(|refusal| refusal.raise(py))?,
        start: options.start,
        asymmetric: options.asymmetric,
        law: law.map_err(|refusal| refusal.raise(py))?,
    };
    let (found, stopped) = run(py, &how, |observer| {
        let planned = plan_motion(&axis, &options, observer)?;
        Ok(planned.map(|planned| Plan {
            bundle: bundle::plan(&planned),
            json: serde_json::to_string(&planned.file).expect("plain data"),
            text: text::planned(&planned, &axis, std::path::Path::new("plan")),
            inputs: files.into_iter().flatten().collect(),
        }))
    })?;
    let plan = found.map_err(|e: stiction_workflows::Error| raised(py, &e))?;
    Ok((plan, stopped))
}

/// A wish as it is typed.
fn want(text: &str) -> Result<Want, Refusal> {
    Want::parse(text).map_err(|error| {
        let said = error.to_string();
        let allowed = said.split_once("; ").map_or("", |(_, allowed)| allowed);
        Refusal::argument("wants", format!("{text:?}"), allowed)
    })
}

/// A law by its name.
fn law(name: &str) -> Result<LawKind, Refusal> {
    let mut laws = PLANNED.into_iter();
    laws.find(|law| law.name() == name)
        .ok_or_else(|| unknown("planned_law", name))
}

/// A form by its name; set points as CSV are always there.
fn carrier(name: &str) -> Result<Carrier, Refusal> {
    let mut all = Carrier::ALL.into_iter();
    all.find(|form| form.name() == name)
        .ok_or_else(|| unknown("formats", name))
}
