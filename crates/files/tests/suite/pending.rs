//! A folder with the record of renames that were not completed: what may come of it, and who may carry it out.

use super::model::GOOD;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use stiction_files::{ModelFile, write_folder};

const PART: &str = ".stiction-part-aB3dE9";
const RECORD: &str = ".stiction-pending";

fn record(dir: &Path, renames: &str) {
    let text = format!("stiction renames 1\n{renames}end\n");
    std::fs::write(dir.join(RECORD), text).unwrap();
}

/// Every file of a folder that is one, with its content.
fn files(dir: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let entries = std::fs::read_dir(dir).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let files = paths.filter(|path| path.is_file());
    files
        .map(|path| (path.clone(), std::fs::read(path).unwrap()))
        .collect()
}

/// The new one is read, though it does not have its name yet.
#[test]
fn a_reader_has_what_is_to_be_and_changes_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let model = dir.path().join("model.toml");
    std::fs::write(&model, GOOD).unwrap();
    std::fs::write(dir.path().join(PART), GOOD.replace("stage", "table")).unwrap();
    let renames = "keep\tmodel.toml\tmodel-1.toml\npublish\tPART\tmodel.toml\n";
    for (renames, name) in [
        (&*renames.replace("PART", PART), "table"),
        // Nothing was renamed before the record was complete.
        ("publish\t", "stage"),
    ] {
        record(dir.path(), renames);
        let before = files(dir.path());
        assert_eq!(ModelFile::read(&model).unwrap().name.as_deref(), Some(name));
        assert_eq!(files(dir.path()), before);
    }
    record(dir.path(), &renames.replace("PART", PART));
    write_folder(dir.path(), [("other.txt", &b"x"[..])], true).unwrap();
    let names: Vec<_> = files(dir.path()).into_keys().collect();
    let left = ["model-1.toml", "model.toml", "other.txt"].map(|name| dir.path().join(name));
    assert_eq!(names, left);
    assert_eq!(
        ModelFile::read(&model).unwrap().name.as_deref(),
        Some("table")
    );
}

/// A folder that came from elsewhere with a record and a link to a folder outside of it.
#[test]
#[cfg(unix)]
fn no_record_leads_out_of_its_folder_through_a_link() {
    let outside = tempfile::tempdir().unwrap();
    std::fs::write(outside.path().join("kept"), "mine").unwrap();
    let before = files(outside.path());
    for renames in [
        "publish\tPART\tlink/kept\n",
        "publish\tPART\tlink/more/new\n",
        "keep\tlink/kept\ttaken\n",
        "keep\tmodel.toml\tlink/model.toml\n",
    ] {
        let dir = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink(outside.path(), dir.path().join("link")).unwrap();
        let model = dir.path().join("model.toml");
        std::fs::write(&model, GOOD).unwrap();
        std::fs::write(dir.path().join(PART), "theirs").unwrap();
        record(dir.path(), &renames.replace("PART", PART));
        let there = files(dir.path());
        assert_eq!(
            ModelFile::read(&model).unwrap().name.as_deref(),
            Some("stage")
        );
        let refused = write_folder(dir.path(), [("a.txt", &b"x"[..])], true).unwrap_err();
        assert!(refused.to_string().contains("link is a link"), "{refused}");
        assert_eq!(files(dir.path()), there, "{renames}");
        assert_eq!(files(outside.path()), before, "{renames}");
    }
}

/// What a record is to give its name is a link to a file outside: it is neither read nor put in the place of the model.
#[test]
#[cfg(unix)]
fn no_record_publishes_a_link() {
    let outside = tempfile::tempdir().unwrap();
    let theirs = outside.path().join("theirs.toml");
    std::fs::write(&theirs, GOOD.replace("stage", "table")).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let model = dir.path().join("model.toml");
    std::fs::write(&model, GOOD).unwrap();
    std::os::unix::fs::symlink(&theirs, dir.path().join(PART)).unwrap();
    record(dir.path(), &format!("publish\t{PART}\tmodel.toml\n"));
    let named = || ModelFile::read(&model).unwrap().name;
    assert_eq!(named().as_deref(), Some("stage"));
    let refused = write_folder(dir.path(), [("a.txt", &b"x"[..])], true).unwrap_err();
    assert!(refused.to_string().contains("is a link"), "{refused}");
    assert_eq!(named().as_deref(), Some("stage"));
}

#[test]
#[cfg(unix)]
fn no_file_is_written_through_a_link() {
    let outside = tempfile::tempdir().unwrap();
    let dir = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink(outside.path(), dir.path().join("link")).unwrap();
    let refused = write_folder(dir.path(), [("link/a.txt", &b"x"[..])], true).unwrap_err();
    assert!(refused.to_string().contains("is a link"), "{refused}");
    assert!(files(outside.path()).is_empty() && files(dir.path()).is_empty());
}
