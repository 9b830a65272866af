//! What an output folder may hold already, and what would be lost in it.

use super::runs;
use super::staged::{self, clean, probe};
use crate::error::Error;
use std::fs;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

/// Files that mark a folder as one that stiction wrote and may replace, each written last.
pub(super) const MARKS: [&str; 8] = [
    "result.json",
    "compare.json",
    "study.json",
    "reproduce.json",
    "plan.toml",
    "batch.json",
    "drift.json",
    "robot.json",
];

/// Names of the files that are written.
const WRITTEN: [&str; 16] = [
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
    "robot.json",
    "robot.toml",
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
            return Err(Error::taken(input, found, false));
        }
    }
    Ok(())
}

/// Refuses a file that is written while an identification runs, such as a checkpoint, where its result is then to be: the folder
/// itself, or one of the files in it.
///
/// # Errors
/// With that file.
pub fn check_apart(dir: impl AsRef<Path>, file: impl AsRef<Path>) -> Result<(), Error> {
    let file = file.as_ref();
    let (Some(out), Some(place)) = (place_of(dir.as_ref()), place_of(file)) else {
        return Ok(());
    };
    let name = place.file_name().and_then(|name| name.to_str());
    let is_written = name.is_some_and(|name| WRITTEN.contains(&name) || name == "study.toml");
    if place != out && !(is_written && place.parent() == Some(out.as_path())) {
        return Ok(());
    }
    let found = "is where the result is written; give the checkpoint another name";
    Err(Error::output(file, found))
}

/// Where a file is, or will be once it and the folders above it are made.
fn place_of(file: &Path) -> Option<PathBuf> {
    if let Ok(real) = file.canonicalize() {
        return Some(real);
    }
    let parent = match file.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    Some(place_of(parent)?.join(file.file_name()?))
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
    let is_folder = |path: &PathBuf| path.is_dir();
    let names = WRITTEN.iter().map(|name| dir.join(name));
    if let Some(folder) = names.chain([dir.join("study.toml")]).find(is_folder) {
        let found = "is a folder, and a file of this name may be written";
        return Err(Error::taken(&folder, found, false));
    }
    let mut entries = fs::read_dir(dir).map_err(|e| Error::io(dir, &e))?;
    // Runs that were kept until the outcome is there are nothing that would be lost.
    let empty = entries.all(|entry| entry.is_ok_and(|entry| entry.file_name() == runs::NAME));
    if empty || force {
        return Ok(());
    }
    let mut marks = MARKS
        .iter()
        .filter(|mark| mark.split('.').next() == Some(kind));
    let found = match marks.find_map(|mark| schema_of(&dir.join(mark), kind)) {
        Some(there) if version(&there) <= version(schema) => return Ok(()),
        Some(there) => format!("holds {there} of a newer stiction; this one writes {schema}"),
        None => "is not empty and holds no result of stiction".into(),
    };
    Err(Error::taken(dir, found, true))
}

/// The nearest folder that exists, `dir` or one above it, in which something can be written.
pub(super) fn writable_above(dir: &Path) -> Result<&Path, Error> {
    // A name that no disk takes is refused where it is looked at, and so is one behind a folder that may not be read.
    let inside = dir.join(staged::PREFIX);
    if let Err(e) = inside.symlink_metadata()
        && !matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory)
    {
        return Err(Error::io(dir, &e));
    }
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
        return Err(Error::taken(existing, "is not a folder", false));
    }
    probe(&existing.join("probe")).map_err(|e| Error::io(existing, &e))?;
    Ok(existing)
}

pub(super) fn is_ours(mark: &Path, kind: &str) -> bool {
    schema_of(mark, kind).is_some()
}

/// The schema of a file that stiction wrote, such as `stiction.result/1`; `None` for any other.
fn schema_of(mark: &Path, kind: &str) -> Option<String> {
    // Opening a pipe of this name, or a link to a file of the kernel, would wait for ever.
    let file = stiction_formats::is_regular(mark)
        .then(|| fs::File::open(mark).ok())
        .flatten();
    let mut head = Vec::new();
    file?.take(4096).read_to_end(&mut head).ok()?;
    let head = String::from_utf8_lossy(&head);
    let at = head.find(&format!("\"stiction.{kind}/"))?;
    Some(head[at + 1..].split('"').next()?.to_string())
}

/// The version in a schema; of none that can be read, one that no other is newer than.
fn version(schema: &str) -> u64 {
    let version = schema.split_once('/').map(|(_, version)| version);
    version.and_then(|v| v.parse().ok()).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::check_folder;
    use std::fs;
    use std::path::Path;

    fn said(dir: &Path) -> String {
        check_folder(dir, false).unwrap_err().to_string()
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_refused() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("file"), "").unwrap();
        let long = dir.path().join("a".repeat(300));
        for long in [
            long.clone(),
            long.join("b"),
            dir.path().join("a/".repeat(3000)),
        ] {
            assert!(said(&long).contains("mostly 255 bytes"), "{}", said(&long));
        }
        let below = dir.path().join("file/out");
        assert!(
            said(&below).contains("file: is not a folder"),
            "{}",
            said(&below)
        );
        assert!(check_folder(dir.path().join("a/b/c"), false).is_ok());
        // Nothing was made to find out.
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_folder_with_the_name_of_a_file_that_is_written_is_refused() {
        let dir = tempfile::tempdir().unwrap();
        fs::create_dir(dir.path().join("model.toml")).unwrap();
        for force in [false, true] {
            let said = check_folder(dir.path(), force).unwrap_err().to_string();
            assert!(said.contains("model.toml: is a folder"), "{said}");
        }
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_folder_of_the_system_is_there_and_takes_no_file() {
        for dir in ["/proc", "/proc/out", "/proc/self/out"] {
            let said = said(Path::new(dir));
            assert!(
                said.contains("no file can be made in this folder"),
                "{said}"
            );
        }
    }

    #[test]
    fn a_result_of_a_newer_version_is_kept() {
        let dir = tempfile::tempdir().unwrap();
        let mark = dir.path().join("result.json");
        let of = |schema: &str| {
            fs::write(&mark, format!("{{\n  \"schema\": \"{schema}\"\n}}\n")).unwrap();
            check_folder(dir.path(), false).map_err(|e| e.to_string())
        };
        assert_eq!(of("stiction.result/1"), Ok(()));
        assert_eq!(of("stiction.result/0"), Ok(()));
        for (newer, found) in [("2", "2"), ("10", "10"), ("next", "next")] {
            let said = of(&format!("stiction.result/{newer}")).unwrap_err();
            let found = format!(
                "holds stiction.result/{found} of a newer stiction; this one writes stiction.result/1"
            );
            assert!(said.contains(&found), "{said}");
            assert!(check_folder(dir.path(), true).is_ok());
        }
        assert!(
            of("another/1")
                .unwrap_err()
                .contains("holds no result of stiction")
        );
    }
}
