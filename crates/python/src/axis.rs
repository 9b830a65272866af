//! What is known of an axis, from a file or a dict.

use crate::error::{Refusal, raised};
use pyo3::prelude::*;
use std::path::PathBuf;

/// What is known of an axis and its columns.
#[pyclass(frozen, module = "stiction._native")]
pub struct Axis {
    /// As the library has it.
    pub axis: stiction_files::Axis,
    text: Option<String>,
}

#[pymethods]
impl Axis {
    /// Nothing is known: all is detected.
    #[new]
    fn new() -> Self {
        Self {
            axis: stiction_files::Axis::default(),
            text: None,
        }
    }

    /// Reads an axis file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let axis = py.detach(|| stiction_files::Axis::read(&path));
        let axis = axis.map_err(|e| raised(py, &e.into()))?;
        Ok(Self { axis, text: None })
    }

    /// The same keys as JSON.
    #[staticmethod]
    fn of_json(py: Python<'_>, json: &str) -> PyResult<Self> {
        let refused =
            |found: String| Refusal::argument("axis", found, "the keys of an axis file").raise(py);
        let value: toml::Value = serde_json::from_str(json)
            .map_err(|e| refused(format!("a value that is none: {e}")))?;
        let text = toml::to_string(&value).map_err(|e| refused(e.to_string()))?;
        let axis = stiction_files::Axis::parse(&text).map_err(|e| raised(py, &e.into()))?;
        Ok(Self {
            axis,
            text: Some(text),
        })
    }

    /// The text of an axis file with the keys of a dict; `None` after a file.
    #[getter]
    fn text(&self) -> Option<&str> {
        self.text.as_deref()
    }
}
