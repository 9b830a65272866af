//! Files on disk: a folder appears whole or not at all, and never on top of something else.

use crate::error::{Error, Remedy};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Files that mark a folder as one that stiction wrote and may replace, each written last.
const MARKS: [&str; 5] = [
    "result.json",
    "compare.json",
    "study.json",
    "reproduce.json",
    "plan.toml",
];

/// Files to be written together.
#[derive(Clone, Debug, Default)]
pub struct Bundle {
    files: Vec<(&'static str, Vec<u8>)>,
    absent: Vec<&'static str>,
}

impl Bundle {
    /// Adds a file by its plain name.
    pub fn add(&mut self, name: &'static str, content: impl Into<Vec<u8>>) {
        self.files.push((name, content.into()));
    }

    /// Says that there is none of a file that others of this kind have: an older one does not belong to what is written.
    pub fn lacks(&mut self, name: &'static str) {
        self.absent.push(name);
    }

    /// Files in `dir` that [`Bundle::write`] keeps under another name, with that: those that were changed since the outcome that is
    /// there was written, and those that belong to that alone.
    pub fn kept(&self, dir: impl AsRef<Path>) -> Vec<(PathBuf, PathBuf)> {
        let dir = dir.as_ref();
        let mark = self.files.iter().find(|(name, _)| MARKS.contains(name));
        let Some((mark, _)) = mark.filter(|(name, _)| {
            let kind = name.trim_end_matches(".json").trim_end_matches(".toml");
            is_ours(&dir.join(name), kind)
        }) else {
            return Vec::new();
        };
        let changed = |path: &Path| path.metadata().and_then(|m| m.modified()).ok();
        // The mark is written last.
        let written = changed(&dir.join(mark));
        let edited = self.files.iter().filter(|(name, content)| {
            let path = dir.join(name);
            let later = name != mark && path.is_file() && changed(&path) > written;
            later && fs::read(&path).is_ok_and(|there| there != *content)
        });
        let edited = edited.map(|(name, _)| *name);
        let stale = self.absent.iter().copied();
        let stale = stale.filter(|name| dir.join(name).is_file());
        let kept = edited
            .chain(stale)
            .map(|name| (dir.join(name), free(dir, name)));
        kept.collect()
    }

    /// Names and contents, in the order they were added.
    pub fn files(&self) -> &[(&'static str, Vec<u8>)] {
        &self.files
    }

    /// Writes every file into `dir`: all under temporary names first, renamed once the last one is
    /// complete, the one that marks the folder at the very end. A full disk or an interrupt leaves what was there; what
    /// [`Bundle::kept`] names is kept under another name.
    ///
    /// # Errors
    /// When the folder cannot be made or a file cannot be written.
    pub fn write(&self, dir: impl AsRef<Path>) -> Result<Vec<PathBuf>, Error> {
        let dir = dir.as_ref();
        fs::create_dir_all(dir).map_err(|e| Error::output(dir, describe(&e)))?;
        let mut order: Vec<_> = self.files.iter().collect();
        order.sort_by_key(|(name, _)| MARKS.contains(name));
        let mut staged = Vec::new();
        for (name, content) in order {
            let path = dir.join(name);
            if path.is_dir() {
                return Err(Error::output(
                    &path,
                    "is a folder; a file of this name is to be written",
                ));
            }
            let file = stage(&path, content)?;
            staged.push((path, file));
        }
        for (path, other) in self.kept(dir) {
            fs::rename(&path, &other).map_err(|e| Error::output(&path, describe(&e)))?;
        }
        let mut written = Vec::new();
        for (path, file) in staged {
            publish(file, &path)?;
            written.push(path);
        }
        Ok(written)
    }
}

/// The first of `study-1.toml`, `study-2.toml` and so on that nothing is called.
fn free(dir: &Path, name: &str) -> PathBuf {
    let (stem, end) = name.rsplit_once('.').unwrap_or((name, ""));
    let names = (1_u64..).map(|k| dir.join(format!("{stem}-{k}.{end}")));
    let mut names = names.filter(|path| path.symlink_metadata().is_err());
    names.next().unwrap_or_else(|| dir.join(name))
}

/// Writes files (relative path, content) as one folder: made under a temporary name beside `dir` and renamed when it is
/// complete. `dir` is absent or empty; one that is there stays, whether it is a link, a mount or where the user is, and
/// what was complete is moved into it.
///
/// # Errors
/// When the folder holds something, a path leads out of it, or it cannot be written.
pub fn write_folder<'f>(
    dir: impl AsRef<Path>,
    files: impl IntoIterator<Item = (&'f str, &'f [u8])>,
) -> Result<(), Error> {
    let dir = dir.as_ref();
    let fail = |e: std::io::Error| Error::output(dir, describe(&e));
    let there = dir.symlink_metadata().is_ok();
    if there {
        let free = dir.is_dir() && fs::read_dir(dir).map_err(fail)?.next().is_none();
        if !free {
            let (found, remedy) = if dir.is_dir() {
                ("is not empty", Remedy::AnotherFolderOrForce)
            } else {
                ("is not a folder", Remedy::Folder)
            };
            return Err(Error::taken(dir, found, remedy));
        }
    }
    let parent = match dir.parent() {
        _ if there => dir,
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    writable_above(parent)?;
    fs::create_dir_all(parent).map_err(fail)?;
    let staged = tempfile::Builder::new()
        .prefix(".stiction-")
        .tempdir_in(parent)
        .map_err(fail)?;
    let whole = staged.path().join("whole");
    fs::create_dir(&whole).map_err(fail)?;
    for (name, content) in files {
        stays_inside(dir, name)?;
        let path = whole.join(name);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(fail)?;
        }
        let mut file = fs::File::create(&path).map_err(fail)?;
        file.write_all(content).map_err(fail)?;
        file.sync_all().map_err(fail)?;
    }
    if there {
        move_into(&whole, dir).map_err(fail)
    } else {
        fs::rename(&whole, dir).map_err(fail)
    }
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
    writable_above(dir)?;
    let mut staged = Vec::new();
    for (name, content) in files {
        stays_inside(dir, name)?;
        let path = dir.join(name);
        if path.is_dir() {
            let what = "is a folder; a file of this name is to be written";
            return Err(Error::output(&path, what));
        }
        let folder = path.parent().unwrap_or(dir);
        fs::create_dir_all(folder).map_err(|e| Error::output(folder, describe(&e)))?;
        let file = stage(&path, content)?;
        staged.push((path, file));
    }
    staged
        .into_iter()
        .try_for_each(|(path, file)| publish(file, &path))
}

/// Refuses a relative path that leads out of its folder.
fn stays_inside(dir: &Path, name: &str) -> Result<(), Error> {
    let plain = |c| matches!(c, std::path::Component::Normal(_));
    match Path::new(name).components().all(plain) {
        true => Ok(()),
        false => Err(Error::output(&dir.join(name), "leads out of the folder")),
    }
}

/// Moves what is in `from` into `dir`; what had been moved goes back if one cannot be.
fn move_into(from: &Path, dir: &Path) -> std::io::Result<()> {
    let mut moved = Vec::new();
    for entry in fs::read_dir(from)?.collect::<Result<Vec<_>, _>>()? {
        let to = dir.join(entry.file_name());
        if let Err(e) = fs::rename(entry.path(), &to) {
            for (old, new) in moved {
                // The first error is the one to tell.
                let _ = fs::rename(new, old);
            }
            return Err(e);
        }
        moved.push((entry.path(), to));
    }
    Ok(())
}

/// Writes a file under a temporary name in the same folder, then renames it.
///
/// # Errors
/// When the folder is not writable or the disk is full.
pub fn write_atomic(path: impl AsRef<Path>, content: &[u8]) -> Result<(), Error> {
    let path = path.as_ref();
    publish(stage(path, content)?, path)
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
    let staged = stage(path, content)?;
    let there = path.symlink_metadata().is_ok();
    let same = || path.is_file() && fs::read(path).is_ok_and(|there| there == content);
    let kept = match (there && !same(), path.parent(), path.file_name()) {
        (true, Some(dir), Some(name)) => Some(free(dir, &name.to_string_lossy())),
        _ => None,
    };
    if let Some(other) = &kept {
        fs::rename(path, other).map_err(|e| Error::output(path, describe(&e)))?;
    }
    publish(staged, path)?;
    Ok(kept.map(|other| (path.to_path_buf(), other)))
}

/// The content under a temporary name beside `path`; it vanishes unless it is published.
fn stage(path: &Path, content: &[u8]) -> Result<NamedTempFile, Error> {
    let fail = |e: std::io::Error| Error::output(path, describe(&e));
    let mut file = temporary_beside(path).map_err(fail)?;
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

/// Refuses a path in whose folder nothing can be written.
///
/// # Errors
/// With the reason.
pub fn check_writable(path: impl AsRef<Path>) -> Result<(), Error> {
    let path = path.as_ref();
    let fail = |e: std::io::Error| Error::output(path, describe(&e));
    temporary_beside(path).map(drop).map_err(fail)
}

fn publish(file: NamedTempFile, path: &Path) -> Result<(), Error> {
    file.persist(path)
        .map_err(|e| Error::output(path, describe(&e.error)))?;
    Ok(())
}

fn temporary_beside(path: &Path) -> std::io::Result<NamedTempFile> {
    let dir = match path.parent() {
        Some(dir) if !dir.as_os_str().is_empty() => dir,
        _ => Path::new("."),
    };
    tempfile::Builder::new()
        .prefix(".stiction-")
        .tempfile_in(dir)
}

/// Names of the files that are written.
const WRITTEN: [&str; 11] = [
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
    let mut entries = fs::read_dir(dir).map_err(|e| Error::output(dir, describe(&e)))?;
    let empty = entries.next().is_none();
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
fn writable_above(dir: &Path) -> Result<&Path, Error> {
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
    temporary_beside(&existing.join("probe")).map_err(|e| Error::output(existing, describe(&e)))?;
    Ok(existing)
}

fn is_ours(mark: &Path, kind: &str) -> bool {
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

fn describe(e: &std::io::Error) -> String {
    match e.kind() {
        std::io::ErrorKind::PermissionDenied => "permission denied".into(),
        std::io::ErrorKind::NotFound => "no such folder".into(),
        _ => e.to_string(),
    }
}
