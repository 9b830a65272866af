//! One file alone.

use super::bundle::free;
use super::staged::{self, probe, stage};
use crate::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

/// Writes a file under a temporary name in the same folder, then renames it.
///
/// # Errors
/// When the folder is not writable or the disk is full.
pub fn write_atomic(path: impl AsRef<Path>, content: &[u8]) -> Result<(), Error> {
    let path = path.as_ref();
    let file = stage(path, content)?;
    if let Some(dir) = path.parent() {
        staged::clean(dir)?;
    }
    staged::publish(file, path)
}

/// A file that was kept: its name, and the one that it has now.
pub type Kept = (PathBuf, PathBuf);

/// [`write_atomic`], but a file of that name with other content is kept under another name, such as `demo-1.csv`.
///
/// # Errors
/// As [`write_atomic`].
pub fn write_keeping(path: impl AsRef<Path>, content: &[u8]) -> Result<Option<Kept>, Error> {
    let path = path.as_ref();
    if path.is_dir() {
        let what = "is a folder; a file of this name is to be written";
        return Err(Error::output(path, what));
    }
    let file = stage(path, content)?;
    let there = path.symlink_metadata().is_ok();
    let same = || path.is_file() && fs::read(path).is_ok_and(|there| there == content);
    let kept = match (there && !same(), path.parent(), path.file_name()) {
        (true, Some(dir), Some(name)) => Some(free(dir, &name.to_string_lossy())),
        _ => None,
    };
    if let Some(other) = &kept {
        fs::rename(path, other).map_err(|e| Error::io(path, &e))?;
    }
    staged::publish(file, path)?;
    Ok(kept.map(|other| (path.to_path_buf(), other)))
}

/// Refuses a path in whose folder nothing can be written.
///
/// # Errors
/// With the reason.
pub fn check_writable(path: impl AsRef<Path>) -> Result<(), Error> {
    let path = path.as_ref();
    let fail = |e: std::io::Error| Error::io(path, &e);
    probe(path).map_err(fail)
}
