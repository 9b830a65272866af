//! Logs of a simulated axis, to begin with.

use crate::Error;
use std::path::{Path, PathBuf};
use stiction_workflows::demo as workflow;

/// Writes the log of a simulated axis as a drive would record it: 9 s at 4 kHz in closed loop, time, reference and position in whole
/// encoder steps, force with noise. The seed is that of the noise.
///
/// # Errors
/// Where the file cannot be written.
pub fn write_log(file: impl AsRef<Path>, seed: u64) -> Result<(), Error> {
    workflow::write_log(file, seed).map_err(Error::of)
}

/// Writes logs of the same axis for the other methods into a folder: constant speeds, motion, force steps, force ramps; their paths.
///
/// # Errors
/// Where the folder cannot be written.
pub fn write_procedure_logs(folder: impl AsRef<Path>, seed: u64) -> Result<Vec<PathBuf>, Error> {
    let written = workflow::procedures(folder, seed);
    written.map(|(paths, ..)| paths).map_err(Error::of)
}
