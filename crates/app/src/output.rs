//! Files on disk: a folder appears whole or not at all, and never on top of something else.

use crate::error::Error;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

/// File that marks a folder as one that stiction wrote and may replace.
const MARK: &str = "result.json";

/// Files to be written together.
#[derive(Clone, Debug, Default)]
pub struct Bundle {
    files: Vec<(&'static str, Vec<u8>)>,
}

impl Bundle {
    /// Adds a file by its plain name.
    pub fn add(&mut self, name: &'static str, content: impl Into<Vec<u8>>) {
        self.files.push((name, content.into()));
    }

    /// Names and contents, in the order they were added.
    pub fn files(&self) -> &[(&'static str, Vec<u8>)] {
        &self.files
    }

    /// Writes every file into `dir`, each under a temporary name first and renamed when complete;
    /// `result.json` comes last, so a folder that has it is whole.
    ///
    /// # Errors
    /// When the folder cannot be made or a file cannot be written.
    pub fn write(&self, dir: &Path) -> Result<Vec<PathBuf>, Error> {
        fs::create_dir_all(dir).map_err(|e| Error::output(dir, describe(&e)))?;
        let mut order: Vec<_> = self.files.iter().collect();
        order.sort_by_key(|(name, _)| *name == MARK);
        let mut written = Vec::new();
        for (name, content) in order {
            let path = dir.join(name);
            write_atomic(&path, content)?;
            written.push(path);
        }
        Ok(written)
    }
}

/// Writes a file under a temporary name in the same folder, then renames it.
///
/// # Errors
/// When the folder is not writable or the disk is full.
pub fn write_atomic(path: &Path, content: &[u8]) -> Result<(), Error> {
    let dir = match path.parent() {
        Some(dir) if !dir.as_os_str().is_empty() => dir,
        _ => Path::new("."),
    };
    let fail = |e: std::io::Error| Error::output(path, describe(&e));
    let mut file = tempfile::Builder::new()
        .prefix(".stiction-")
        .tempfile_in(dir)
        .map_err(fail)?;
    file.write_all(content).map_err(fail)?;
    file.as_file().sync_all().map_err(fail)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        file.as_file()
            .set_permissions(fs::Permissions::from_mode(0o644))
            .map_err(fail)?;
    }
    file.persist(path).map_err(|e| fail(e.error))?;
    Ok(())
}

/// Refuses a folder that holds something that stiction did not write, unless `force`.
///
/// A folder that is empty, absent, or holds an earlier `result.json` of ours is fine.
///
/// # Errors
/// With the reason and the way out.
pub fn check_folder(dir: &Path, force: bool) -> Result<(), Error> {
    if !dir.exists() {
        return Ok(());
    }
    if !dir.is_dir() {
        return Err(Error::output(dir, "is a file; --out takes a folder"));
    }
    let mut entries = fs::read_dir(dir).map_err(|e| Error::output(dir, describe(&e)))?;
    let empty = entries.next().is_none();
    if empty || force || is_ours(&dir.join(MARK)) {
        return Ok(());
    }
    Err(Error::output(
        dir,
        "is not empty and holds no result of stiction; choose another --out or add --force to write \
         into it all the same",
    ))
}

fn is_ours(mark: &Path) -> bool {
    let Ok(file) = fs::File::open(mark) else {
        return false;
    };
    let mut head = Vec::new();
    use std::io::Read;
    file.take(4096).read_to_end(&mut head).is_ok()
        && String::from_utf8_lossy(&head).contains("\"stiction.result/")
}

fn describe(e: &std::io::Error) -> String {
    match e.kind() {
        std::io::ErrorKind::PermissionDenied => "permission denied".into(),
        std::io::ErrorKind::NotFound => "no such folder".into(),
        _ => e.to_string(),
    }
}
