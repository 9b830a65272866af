//! Machines of the library.

use crate::error::raised;
use pyo3::prelude::*;
use std::path::PathBuf;
use stiction_workflows::Error;
use stiction_workflows::library::Library;

/// The machines, as JSON: their rows of the index.
#[pyfunction]
pub fn library() -> String {
    serde_json::to_string(&Library::new().machines).expect("plain data")
}

/// The files of a machine: path, text.
#[pyfunction]
pub fn machine_files(py: Python<'_>, name: &str) -> PyResult<Vec<(&'static str, String)>> {
    let library = Library::new();
    let machine = library.machine(name).map_err(|e| raised(py, &e))?;
    Ok(machine.files())
}

/// Writes them into a folder; their paths.
#[pyfunction]
pub fn write_machine(
    py: Python<'_>,
    name: &str,
    folder: PathBuf,
    force: bool,
) -> PyResult<Vec<PathBuf>> {
    let write = || -> Result<Vec<PathBuf>, Error> {
        let written = Library::new().machine(name)?.write(&folder, force)?;
        Ok(written.into_iter().map(|path| folder.join(path)).collect())
    };
    py.detach(write).map_err(|e| raised(py, &e))
}
