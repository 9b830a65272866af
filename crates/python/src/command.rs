//! The command line, as the script of the package runs it.

use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the command line with these arguments, as the program does, and returns its exit code. It takes Ctrl-C from the
/// interpreter, prints past `sys.stdout`, and may end the process.
#[pyfunction]
pub fn command(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| stiction_cli::run(words))
}
