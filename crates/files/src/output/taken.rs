//! What an output folder may hold already, and what would be lost in it.

use super::staged::{clean, probe};
use super::{describe, runs};
use crate::error::{Error, Remedy};
use std::fs;
use std::path::{Path, PathBuf};

/// Files that mark a folder as one that stiction wrote and may replace, each written last.
pub(super) const MARKS: [&str; 7] = [
    "result.json",
    "compare.json",
    "study.json",
    "reproduce.json",
    "plan.toml",
    "batch.json",
    "drift.json",
];

/// Names of the files that are written.
const WRITTEN: [&str; 14] = [
    "result.json",
    "compare.json",
    "model.toml",
    "report.html",
    "fit.csv",
    "trajectories.csv",
    "contours.csv",
    "study.json",
    "reproduce.json",
    "plan.toml",
    "setpoints.csv",
    "batch.json",
    "results.parquet",
    "drift.json",
];

/// Refuses an output folder whose files would take the place of an input, or of a file that is going to be
/// written beside them.
///
/// # Errors
/// With the input that would be lost.
pub fn check_inputs(
    dir: impl AsRef<Path>,
    inputs: impl IntoIterator<Item = impl AsRef<Path>>,
) -> Result<(), Error> {
    let Ok(out) = dir.as_ref().canonicalize() else {
        return Ok(());
    };
    for input in inputs {
        let input = input.as_ref();
        let Some(real) = place_of(input) else {
            continue;
        };
        let name = real.file_name().and_then(|name| name.to_str());
        if real.parent() == Some(out.as_path()) && name.is_some_and(|n| WRITTEN.contains(&n)) {
            let found = "is an input, or a checkpoint, and would be overwritten";
            return Err(Error::taken(input, found, Remedy::AnotherFolder));
        }
    }
    Ok(())
}

/// Where a file is, or will be once it is written.
fn place_of(file: &Path) -> Option<PathBuf> {
    if let Ok(real) = file.canonicalize() {
        return Some(real);
    }
    let parent = match file.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    Some(parent.canonicalize().ok()?.join(file.file_name()?))
}

/// Refuses a folder that holds something that stiction did not write, unless `force`.
///
/// A folder that is empty, absent, or holds an earlier `result.json` of ours is fine, if it can be
/// written: better said before a long search than after it.
///
/// # Errors
/// With the reason and the way out.
pub fn check_folder(dir: impl AsRef<Path>, force: bool) -> Result<(), Error> {
    check_folder_of(dir, crate::result::SCHEMA, force)
}

/// [`check_folder`] for files of another schema, such as `stiction.study/1`: what another command wrote into the folder
/// is not replaced.
///
/// # Errors
/// As [`check_folder`].
pub fn check_folder_of(dir: impl AsRef<Path>, schema: &str, force: bool) -> Result<(), Error> {
    let dir = dir.as_ref();
    let kind = schema
        .trim_start_matches("stiction.")
        .split('/')
        .next()
        .unwrap_or_default();
    let existing = writable_above(dir)?;
    if existing != dir {
        return Ok(());
    }
    clean(dir)?;
    let mut entries = fs::read_dir(dir).map_err(|e| Error::output(dir, describe(&e)))?;
    // Runs that were kept until the outcome is there are nothing that would be lost.
    let empty = entries.all(|entry| entry.is_ok_and(|entry| entry.file_name() == runs::NAME));
    let mut marks = MARKS
        .iter()
        .filter(|mark| mark.split('.').next() == Some(kind));
    if empty || force || marks.any(|mark| is_ours(&dir.join(mark), kind)) {
        return Ok(());
    }
    Err(Error::taken(
        dir,
        "is not empty and holds no result of stiction",
        Remedy::AnotherFolderOrForce,
    ))
}

/// The nearest folder that exists, `dir` or one above it, in which something can be written.
pub(super) fn writable_above(dir: &Path) -> Result<&Path, Error> {
    // The nearest folder that exists; `symlink_metadata` so that a dangling link counts as something.
    let existing = dir
        .ancestors()
        .map(|a| {
            if a.as_os_str().is_empty() {
                Path::new(".")
            } else {
                a
            }
        })
        .find(|a| a.symlink_metadata().is_ok())
        .unwrap_or(Path::new("."));
    if !existing.is_dir() {
        return Err(Error::taken(existing, "is not a folder", Remedy::Folder));
    }
    probe(&existing.join("probe")).map_err(|e| Error::output(existing, describe(&e)))?;
    Ok(existing)
}

pub(super) fn is_ours(mark: &Path, kind: &str) -> bool {
    // Opening a pipe of this name would wait for ever.
    if !mark.is_file() {
        return false;
    }
    let Ok(file) = fs::File::open(mark) else {
        return false;
    };
    let mut head = Vec::new();
    use std::io::Read;
    file.take(4096).read_to_end(&mut head).is_ok()
        && String::from_utf8_lossy(&head).contains(&format!("\"stiction.{kind}/"))
}
