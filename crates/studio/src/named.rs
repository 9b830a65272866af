//! Files of the folder that name others, which are in the folder as well.

use crate::refused::Refused;
use crate::workspace::{UNFINISHED, Workspace};
use std::path::Path;
use stiction_files::Axis;
use stiction_files::study::Study;

/// An axis file of the workspace, of which no log lies outside, and no file that a column of one of these logs comes from.
pub fn read_axis(workspace: &Workspace, name: &str, logs: &[&Path]) -> Result<Axis, Refused> {
    let axis = Axis::read(workspace.file(name)?)?;
    let listed = axis.logs.iter().map(|log| log.file.as_path());
    let logs: Vec<&Path> = listed.chain(logs.iter().copied()).collect();
    for log in &logs {
        workspace.holds(log)?;
    }
    for other in axis.joined.iter().filter_map(|joined| joined.file.as_ref()) {
        if let Some(file) = other.of_one_log() {
            workspace.holds(file)?;
        }
        for log in &logs {
            workspace.holds(&other.of(log))?;
        }
    }
    Ok(axis)
}

/// Reads a text as the file that it is to become, in the folder of which it may name others; a refusal names that file.
pub fn read_as<T, E: Into<Refused>>(
    file: &Path,
    text: &str,
    read: impl FnOnce(&Path) -> Result<T, E>,
) -> Result<T, Refused> {
    let folder = file.parent().filter(|dir| dir.is_dir());
    let beside = tempfile::Builder::new()
        .prefix(UNFINISHED)
        .tempfile_in(folder.unwrap_or(Path::new(".")))?;
    std::fs::write(beside.path(), text)?;
    let own = beside.path().display().to_string();
    read(beside.path()).map_err(|e| e.into().calling(&own, &file.display().to_string()))
}

/// A study of the workspace, which reads what it names, its model first of all.
pub fn read_study(workspace: &Workspace, name: &str) -> Result<Study, Refused> {
    let file = workspace.file(name)?;
    workspace.holds_named(&workspace.text(name)?, &file)?;
    Ok(Study::read(file)?)
}
