//! Several files at once take the place of what a folder has of the same names.

use super::pending::{Pending, Rename, is_inside, linked};
use super::staged::{stage, sweep};
use super::taken::writable_above;
use crate::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Writes files (relative path, content) into `dir`, which is made where it is not there: all are complete before the first
/// is renamed, and what `kept` says then is kept under another name. A failure leaves what was there.
pub(super) fn replace<'f>(
    dir: &Path,
    files: impl IntoIterator<Item = (&'f str, &'f [u8])>,
    kept: impl FnOnce() -> Vec<(PathBuf, PathBuf)>,
) -> Result<(), Error> {
    writable_above(dir)?;
    let fail = |e: std::io::Error| Error::io(dir, &e);
    fs::create_dir_all(dir).map_err(fail)?;
    let mut pending = Pending::begin(dir)?;
    // Nobody else is at work here now.
    sweep(dir);
    let staged = match stage_all(dir, files) {
        Ok(staged) => staged,
        Err(e) => {
            // The first error is the one to tell.
            let _ = pending.end();
            return Err(e);
        }
    };
    let mut renames: Vec<_> = kept().iter().filter_map(|pair| keep(dir, pair)).collect();
    renames.extend(staged.iter().filter_map(|(to, file)| {
        let from = file.path().file_name()?.to_str()?.to_string();
        Some(Rename::Publish(from, to.clone()))
    }));
    if let Err(e) = pending.commit(&renames) {
        let _ = pending.end();
        return Err(fail(e));
    }
    // From here on the record says what is to be done: where it cannot be done now, the complete files wait for the next.
    let kept: Result<Vec<_>, _> = staged.into_iter().map(|(_, file)| file.keep()).collect();
    kept.map_err(|e| fail(e.error))?;
    for rename in &renames {
        rename.run(dir).map_err(fail)?;
    }
    pending.end().map_err(fail)
}

/// Every file complete under a temporary name in `dir`, with the name that it is to have.
fn stage_all<'f>(
    dir: &Path,
    files: impl IntoIterator<Item = (&'f str, &'f [u8])>,
) -> Result<Vec<(String, NamedTempFile)>, Error> {
    let mut staged = Vec::new();
    for (name, content) in files {
        let path = dir.join(name);
        if !is_inside(name) {
            return Err(Error::output(&path, "leads out of the folder"));
        }
        if let Some(link) = linked(dir, name) {
            return Err(Error::output(&link, "is a link; a folder is to be made"));
        }
        if path.is_dir() {
            let what = "is a folder; a file of this name is to be written";
            return Err(Error::output(&path, what));
        }
        let mut folders = Path::new(name).ancestors().skip(1).map(|a| dir.join(a));
        if let Some(other) = folders.find(|folder| folder.exists() && !folder.is_dir()) {
            return Err(Error::output(&other, "is a file; a folder is to be made"));
        }
        staged.push((name.to_string(), stage(&dir.join(PLACE), content)?));
    }
    Ok(staged)
}

/// Temporary files stand in the folder itself, whatever folder within it they are for.
const PLACE: &str = "part";

/// Two paths in `dir` as names relative to it.
fn keep(dir: &Path, (from, to): &(PathBuf, PathBuf)) -> Option<Rename> {
    let name = |path: &Path| Some(path.strip_prefix(dir).ok()?.to_str()?.to_string());
    Some(Rename::Keep(name(from)?, name(to)?))
}
