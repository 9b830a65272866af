//! Identification, and what it found.

use crate::axis::Axis;
use crate::error::{Refusal, raised};
use crate::law::Law;
use crate::log::Log;
use crate::options::Asked;
use crate::run::{How, Stopped, run};
use numpy::{IntoPyArray, PyArray1, PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::PathBuf;
use stiction_files::ModelFile;
use stiction_files::result::{FrictionCurveEntry, ResultFile};
use stiction_files::{Bundle, check_folder, check_inputs};
use stiction_log::Column;
use stiction_pages::SavedFit;
use stiction_pages::bundle::{self, beside_complete};
use stiction_pages::{report, text};
use stiction_workflows::identify::{self as workflow, Files, Outcome, predict};
use stiction_workflows::source::Source;

/// An identified law with everything that is known of it.
#[pyclass(frozen, module = "stiction._native")]
pub struct Fit {
    content: Content,
    /// Whether it was told to stop, also where the result does not say so: a search that had ended before.
    stopped: bool,
}

enum Content {
    /// By an identification in this process.
    Made(Box<Outcome>),
    /// From the files of one.
    Saved(Box<SavedFit>),
}

/// An array with its name.
type Named<'py> = (&'static str, Bound<'py, PyArray1<f64>>);

impl Fit {
    fn bundle(&self) -> Bundle {
        match &self.content {
            Content::Made(fit) => bundle::identification(fit),
            Content::Saved(saved) => saved.bundle(),
        }
    }

    /// One that was identified in this process, to the end.
    pub fn of(fit: Outcome) -> Self {
        Self {
            content: Content::Made(Box::new(fit)),
            stopped: false,
        }
    }

    fn result(&self) -> &ResultFile {
        match &self.content {
            Content::Made(fit) => &fit.result,
            Content::Saved(saved) => saved.result(),
        }
    }

    /// The model.
    pub fn model(&self) -> ModelFile {
        match &self.content {
            Content::Made(fit) => ModelFile::from_result(&fit.result),
            Content::Saved(saved) => saved.model().clone(),
        }
    }
}

#[pymethods]
impl Fit {
    /// Reads the folder of a fit.
    #[staticmethod]
    fn load(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        let saved = py.detach(|| SavedFit::read(&folder));
        Self::saved(py, saved)
    }

    /// The same of its files, by their names.
    #[staticmethod]
    fn of_files(py: Python<'_>, folder: PathBuf, files: Vec<(String, Vec<u8>)>) -> PyResult<Self> {
        Self::saved(py, SavedFit::of(&folder, files))
    }

    /// Its files with their names.
    fn files<'py>(&self, py: Python<'py>) -> Vec<(String, Bound<'py, PyBytes>)> {
        let bundle = py.detach(|| self.bundle());
        let files = bundle.files().iter();
        files
            .map(|(name, bytes)| (name.to_string(), PyBytes::new(py, bytes)))
            .collect()
    }

    /// Whether it came from files, without the logs.
    #[getter]
    fn is_saved(&self) -> bool {
        matches!(self.content, Content::Saved(_))
    }

    /// `result.json`.
    fn result_json(&self) -> String {
        match &self.content {
            Content::Made(fit) => serde_json::to_string(&fit.result).expect("plain data"),
            Content::Saved(saved) => saved.text("result.json"),
        }
    }

    /// What to do next with it, as JSON.
    fn next(&self) -> Option<String> {
        crate::next::next(self.result())
    }

    /// `model.toml`.
    fn model_toml(&self) -> String {
        match &self.content {
            Content::Made(_) => self.model().to_toml(),
            Content::Saved(saved) => saved.text("model.toml"),
        }
    }

    /// `report.html`.
    fn report(&self, py: Python<'_>) -> String {
        match &self.content {
            Content::Made(fit) => py.detach(|| report::identification(fit).to_html()),
            Content::Saved(saved) => saved.text("report.html"),
        }
    }

    /// As the command line prints it; empty for a fit from files.
    fn text(&self) -> String {
        match &self.content {
            Content::Made(fit) => text::outcome(fit),
            Content::Saved(_) => String::new(),
        }
    }

    /// The columns of `fit.csv`: name, unit, samples.
    fn series<'py>(
        &self,
        py: Python<'py>,
    ) -> Vec<(String, Option<String>, Bound<'py, PyArray1<f64>>)> {
        let columns = py.detach(|| match &self.content {
            Content::Made(fit) => {
                let bundle = bundle::identification(fit);
                let csv = bundle.files().iter().find(|(name, _)| *name == "fit.csv");
                let csv = csv.map(|(_, bytes)| String::from_utf8_lossy(bytes));
                csv.and_then(|text| stiction_pages::bundle::fit_columns(&text))
            }
            Content::Saved(saved) => saved.series(),
        });
        let array = |c: Column| (c.name, c.unit, c.values.into_pyarray(py));
        columns.into_iter().flatten().map(array).collect()
    }

    /// What the law makes of another log: signals by name, and the quality as JSON.
    fn predict<'py>(&self, py: Python<'py>, log: &Log) -> PyResult<(Vec<Named<'py>>, String)> {
        let Content::Made(fit) = &self.content else {
            return Err(Refusal::argument(
                "fit",
                "a fit that was read from files or unpickled, which has no filters of a record",
                "a fit of this process: identify the log again (same bits) and predict with that, or give the other log \
                 as identify(..., validate=[...]), whose figures the files keep",
            )
            .raise(py));
        };
        let (found, _) = run(py, &How::quiet(), |_| predict(fit, &log.source))?;
        let found = found.map_err(|e| raised(py, &e))?;
        let quality = serde_json::to_string(&found.quality).expect("plain data");
        let residual = found.series.residual();
        let series = found.series;
        let named = [
            ("time", series.time),
            ("position", series.position),
            ("velocity", series.velocity),
            ("measured", series.measured),
            ("model", series.model),
            ("residual", residual),
        ];
        let named = named.map(|(name, values)| (name, values.into_pyarray(py)));
        Ok((named.into(), quality))
    }

    /// The law, at rest.
    fn law(&self, py: Python<'_>) -> PyResult<Law> {
        Law::of(&self.model()).map_err(|refusal| refusal.raise(py))
    }

    /// Writes the files of the command line; where they went.
    fn save(&self, py: Python<'_>, folder: PathBuf, force: bool) -> PyResult<Vec<PathBuf>> {
        let write = || -> Result<Vec<PathBuf>, stiction_workflows::Error> {
            check_folder(&folder, force)?;
            let bundle = match &self.content {
                Content::Made(fit) => {
                    check_inputs(&folder, fit.sources.iter().map(|s| s.path.as_path()))?;
                    bundle::identification_in(fit, &folder)
                }
                Content::Saved(saved) => saved.bundle(),
            };
            let schema = stiction_files::result::SCHEMA;
            let beside = beside_complete(&bundle, &folder, schema, self.stopped);
            Ok(bundle.write(beside.as_deref().unwrap_or(&folder))?)
        };
        py.detach(write).map_err(|e| raised(py, &e))
    }
}

impl Fit {
    fn saved(py: Python<'_>, saved: Result<SavedFit, stiction_workflows::Error>) -> PyResult<Self> {
        let saved = saved.map_err(|e| raised(py, &e))?;
        Ok(Self {
            content: Content::Saved(Box::new(saved)),
            stopped: false,
        })
    }

    fn made(
        py: Python<'_>,
        (fit, stopped): (Result<Outcome, stiction_workflows::Error>, bool),
    ) -> PyResult<(Self, bool)> {
        let fit = fit.map_err(|e| raised(py, &e))?;
        let content = Content::Made(Box::new(fit));
        Ok((Self { content, stopped }, stopped))
    }
}

/// Friction at velocities by the `friction_curve` of a result, as JSON: force and half widths, NaN where it is not known.
#[pyfunction]
pub fn friction_at<'py>(
    py: Python<'py>,
    curve: &str,
    velocity: PyReadonlyArrayDyn<'py, f64>,
) -> PyResult<[Bound<'py, PyArrayDyn<f64>>; 4]> {
    let curve: FrictionCurveEntry = serde_json::from_str(curve).map_err(|e| {
        Refusal::argument("friction_curve", e.to_string(), "that of a result").raise(py)
    })?;
    let at = velocity.as_array().mapv(|v| {
        let at = curve.at_velocity(v);
        at.map_or([f64::NAN; 4], |at| {
            [at.force, at.at_once, at.repeat, at.transfer]
        })
    });
    Ok([0, 1, 2, 3].map(|k| at.mapv(|own| own[k]).into_pyarray(py)))
}

/// Identifies from logs in memory; the fit, and whether it was told to stop.
#[pyfunction]
pub fn identify(
    py: Python<'_>,
    logs: Vec<Py<Log>>,
    validate: Vec<Py<Log>>,
    axis: &Axis,
    options: Asked,
    progress: Option<Py<PyAny>>,
    threads: Option<usize>,
) -> PyResult<(Fit, bool)> {
    let options = options.options().map_err(|refusal| refusal.raise(py))?;
    let each = |logs: Vec<Py<Log>>| -> Vec<Source> {
        logs.iter().map(|log| log.get().source.clone()).collect()
    };
    let (logs, validate) = (each(logs), each(validate));
    let how = How {
        progress,
        threads,
        stopped: Stopped::Keeps,
    };
    let found = run(py, &how, |observer| {
        workflow::identify_logs(&options, &axis.axis, logs, validate, observer)
    });
    Fit::made(py, found?)
}

/// Identifies from files, as the command line does.
#[pyfunction]
pub fn identify_files(
    py: Python<'_>,
    logs: Vec<PathBuf>,
    validate: Vec<PathBuf>,
    axis: Option<PathBuf>,
    options: Asked,
    progress: Option<Py<PyAny>>,
    threads: Option<usize>,
) -> PyResult<(Fit, bool)> {
    let options = options.options().map_err(|refusal| refusal.raise(py))?;
    let files = Files {
        logs,
        axis,
        validate,
    };
    let how = How {
        progress,
        threads,
        stopped: Stopped::Keeps,
    };
    let found = run(py, &how, |observer| {
        workflow::identify(&files, &options, observer)
    });
    Fit::made(py, found?)
}
