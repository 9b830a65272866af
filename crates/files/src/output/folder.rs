//! Many files, some in folders of their own, as one folder.

use super::replace::replace;
use super::staged::{PREFIX, clean, sweep};
use super::{pending, taken::writable_above};
use crate::error::Error;
use std::fs::{self, File};
use std::io::Write;
use std::path::Path;

/// Words that every text has which is made from a model.
const MARK: &[u8] = b"written by stiction";

/// Writes files (relative path, content) as one folder. One that is absent is made under a temporary name beside `dir` and
/// renamed when it is complete. One that is there stays, whether it is a link, a mount or where the user is. Files that are
/// replaced are put aside before the first new one gets its name, so that files of two calls never stand side by side; other
/// files are kept.
///
/// # Errors
/// When a path leads out of the folder or it cannot be written. Unless `force`: when it holds something else than an earlier
/// call wrote, or a file to be replaced was changed since.
pub fn write_folder<'f>(
    dir: impl AsRef<Path>,
    files: impl IntoIterator<Item = (&'f str, &'f [u8])>,
    force: bool,
) -> Result<(), Error> {
    let dir = dir.as_ref();
    let fail = |e: std::io::Error| Error::io(dir, &e);
    let files: Vec<_> = files.into_iter().collect();
    if dir.symlink_metadata().is_ok() {
        if !dir.is_dir() {
            return Err(Error::taken(dir, "is not a folder", false));
        }
        clean(dir)?;
        if !force {
            refuse_foreign(dir, &files)?;
        }
        let aside = |(k, (name, _)): (usize, &(&str, &[u8]))| {
            let path = dir.join(name);
            let is_file = path.is_file() && !path.is_symlink();
            is_file.then(|| (path, dir.join(format!("{PREFIX}old{k:03}"))))
        };
        let kept = || files.iter().enumerate().filter_map(aside).collect();
        replace(dir, files.iter().copied(), kept)?;
        sweep(dir);
        return Ok(());
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
    let held = File::open(staged.path());
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
        let mut file = File::create(&path).map_err(fail)?;
        file.write_all(content).map_err(fail)?;
        file.sync_all().map_err(fail)?;
    }
    fs::rename(&whole, dir).map_err(fail)
}

/// Refuses a folder that holds something, but no file of an earlier call, or in which a file would be lost that somebody wrote or
/// changed.
fn refuse_foreign(dir: &Path, files: &[(&str, &[u8])]) -> Result<(), Error> {
    let refuse = |path: &Path, found| Err(Error::taken(path, found, true));
    let entries = fs::read_dir(dir).map_err(|e| Error::io(dir, &e));
    let is_empty = entries?.next().is_none();
    let changed = |name: &str| dir.join(name).metadata().and_then(|m| m.modified()).ok();
    // They are written in their order.
    let written = files.last().and_then(|(name, _)| changed(name));
    let mut there = files
        .iter()
        .filter(|(name, _)| dir.join(name).symlink_metadata().is_ok())
        .peekable();
    if there.peek().is_none() && !is_empty {
        return refuse(dir, "is not empty");
    }
    let is_own = |(name, content): &(&str, &[u8])| {
        let path = dir.join(name);
        let text = if stiction_formats::is_regular(&path) {
            fs::read(&path)
        } else {
            Ok(vec![])
        };
        let is_marked = |text: &[u8]| text.windows(MARK.len()).any(|words| words == MARK);
        let is_own =
            |text: Vec<u8>| text == *content || changed(name) <= written && is_marked(&text);
        !path.is_symlink() && text.is_ok_and(is_own)
    };
    match there.find(|file| !is_own(file)) {
        None => Ok(()),
        Some((name, _)) => refuse(&dir.join(name), "is not as stiction wrote it"),
    }
}
