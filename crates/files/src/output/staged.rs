//! Files under temporary names, and those that a program which was ended by force left behind.

use super::pending::settle;
use crate::error::Error;
use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::time::Duration;
use tempfile::NamedTempFile;

/// Temporary names begin so, followed by six letters or digits.
pub(super) const PREFIX: &str = ".stiction-part-";

/// Why nothing can be written in a folder of the system.
const NO_FILES: &str = "no file can be made in this folder";

/// A file is locked as soon as this after it is made.
const SOON: Duration = Duration::from_secs(60);

/// The content under a temporary name beside `path`; it vanishes unless it is published.
pub(super) fn stage(path: &Path, content: &[u8]) -> Result<NamedTempFile, Error> {
    let fail = |e: std::io::Error| Error::io(path, &e);
    let mut file = temporary_beside(path).map_err(fail)?;
    // Says that somebody is at work here; it ends with the process. Some file systems have no locks.
    let _ = file.as_file().try_lock();
    file.write_all(content).map_err(fail)?;
    file.as_file().sync_all().map_err(fail)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        file.as_file()
            .set_permissions(fs::Permissions::from_mode(0o644))
            .map_err(fail)?;
    }
    Ok(file)
}

/// Gives a file its name.
pub(super) fn publish(file: NamedTempFile, path: &Path) -> Result<(), Error> {
    file.persist(path).map_err(|e| Error::io(path, &e.error))?;
    Ok(())
}

/// Whether a file can be written in the folder of `path`.
pub(super) fn probe(path: &Path) -> std::io::Result<()> {
    temporary_beside(path)?.write_all(b"probe")
}

/// An empty file under a temporary name in the folder of `path`.
fn temporary_beside(path: &Path) -> std::io::Result<NamedTempFile> {
    let dir = match path.parent() {
        Some(dir) if !dir.as_os_str().is_empty() => dir,
        _ => Path::new("."),
    };
    let made = tempfile::Builder::new().prefix(PREFIX).tempfile_in(dir);
    made.map_err(|e| match e.kind() {
        // A folder such as /proc, which is there and takes no file.
        std::io::ErrorKind::NotFound if dir.is_dir() => std::io::Error::other(NO_FILES),
        _ => e,
    })
}

/// Whether a name is one that [`temporary_beside`] gives.
pub(super) fn is_temporary(name: &str) -> bool {
    name.strip_prefix(PREFIX)
        .is_some_and(|end| end.len() == 6 && end.bytes().all(|b| b.is_ascii_alphanumeric()))
}

/// Ends what was begun in `dir`, and removes what programs that no longer run have left there.
pub(super) fn clean(dir: &Path) -> Result<(), Error> {
    settle(dir)?;
    sweep(dir);
    Ok(())
}

/// Removes what programs that no longer run have left in `dir` under temporary names, which no record there names. What
/// cannot be removed is left.
pub(super) fn sweep(dir: &Path) {
    // A file without content may be just made, and not locked yet. No clock is read: the folder's own time tells, since
    // whoever sweeps has made a file in it.
    let changed = |m: fs::Metadata| m.modified().ok();
    let now = fs::metadata(dir).ok().and_then(changed);
    let is_old = |m: &fs::Metadata| match (m.modified(), now) {
        (Ok(made), Some(now)) => now.duration_since(made).is_ok_and(|age| age > SOON),
        _ => false,
    };
    let dir = match dir.as_os_str().is_empty() {
        true => Path::new("."),
        false => dir,
    };
    for entry in fs::read_dir(dir).into_iter().flatten().flatten() {
        let Ok(kind) = entry.file_type() else {
            continue;
        };
        let ours = entry.file_name().to_str().is_some_and(is_temporary);
        if !ours || kind.is_symlink() {
            continue;
        }
        let path = entry.path();
        // A file is locked as long as its program runs.
        let Ok(file) = File::open(&path) else {
            continue;
        };
        let begun = kind.is_dir() || file.metadata().is_ok_and(|m| m.len() > 0 || is_old(&m));
        if begun && file.try_lock().is_ok() {
            let _ = match kind.is_dir() {
                true => fs::remove_dir_all(&path),
                false => fs::remove_file(&path),
            };
        }
    }
}

/// A file that is written part by part under a temporary name: it takes the place of what is there once it is complete, and
/// vanishes where it never is.
pub(crate) struct Staged {
    file: NamedTempFile,
    path: std::path::PathBuf,
}

impl Staged {
    /// Begins a file that is going to be `path`.
    pub(crate) fn begin(path: &Path) -> Result<Self, Error> {
        Ok(Self {
            file: stage(path, b"")?,
            path: path.to_path_buf(),
        })
    }

    /// The file to write to.
    pub(crate) fn file(&self) -> Result<File, Error> {
        let fail = |e: std::io::Error| Error::io(&self.path, &e);
        self.file.as_file().try_clone().map_err(fail)
    }

    /// What went wrong with it.
    pub(crate) fn fault(&self, reason: impl Into<String>) -> Error {
        Error::output(&self.path, reason)
    }

    /// Gives it its name.
    pub(crate) fn publish(self) -> Result<(), Error> {
        let synced = self.file.as_file().sync_all();
        synced.map_err(|e| Error::io(&self.path, &e))?;
        publish(self.file, &self.path)
    }
}
