//! Many files, some in folders of their own, as one folder.

use super::replace::replace;
use super::staged::{PREFIX, clean};
use super::{describe, pending, taken::writable_above};
use crate::error::{Error, Remedy};
use std::fs;
use std::io::Write;
use std::path::Path;

/// Writes files (relative path, content) as one folder: made under a temporary name beside `dir` and renamed when it is
/// complete. `dir` is absent or empty; one that is there stays, whether it is a link, a mount or where the user is, and
/// the files are renamed into it once all are complete.
///
/// # Errors
/// When the folder holds something, a path leads out of it, or it cannot be written.
pub fn write_folder<'f>(
    dir: impl AsRef<Path>,
    files: impl IntoIterator<Item = (&'f str, &'f [u8])>,
) -> Result<(), Error> {
    let dir = dir.as_ref();
    let fail = |e: std::io::Error| Error::output(dir, describe(&e));
    if dir.symlink_metadata().is_ok() {
        if !dir.is_dir() {
            return Err(Error::taken(dir, "is not a folder", Remedy::Folder));
        }
        clean(dir)?;
        if fs::read_dir(dir).map_err(fail)?.next().is_some() {
            let remedy = Remedy::AnotherFolderOrForce;
            return Err(Error::taken(dir, "is not empty", remedy));
        }
        return replace(dir, files, Vec::new);
    }
    let parent = match dir.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    writable_above(parent)?;
    fs::create_dir_all(parent).map_err(fail)?;
    clean(parent)?;
    let staged = tempfile::Builder::new()
        .prefix(PREFIX)
        .tempdir_in(parent)
        .map_err(fail)?;
    // Held until the end; some systems do not open or lock folders.
    let held = fs::File::open(staged.path());
    let _ = held.as_ref().map(|folder| folder.try_lock());
    let whole = staged.path().join("whole");
    fs::create_dir(&whole).map_err(fail)?;
    for (name, content) in files {
        if !pending::is_inside(name) {
            return Err(Error::output(&dir.join(name), "leads out of the folder"));
        }
        let path = whole.join(name);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(fail)?;
        }
        let mut file = fs::File::create(&path).map_err(fail)?;
        file.write_all(content).map_err(fail)?;
        file.sync_all().map_err(fail)?;
    }
    fs::rename(&whole, dir).map_err(fail)
}

/// Writes files (relative path, content) into a folder that may hold something: files of the same name are replaced, others
/// are kept. All are complete under temporary names before the first is renamed.
///
/// # Errors
/// When a path leads out of the folder, a folder is in the place of a file, or it cannot be written.
pub fn write_into_folder<'f>(
    dir: &Path,
    files: impl IntoIterator<Item = (&'f str, &'f [u8])>,
) -> Result<(), Error> {
    replace(dir, files, Vec::new)
}
