//! What of a recording of rosbag2 cannot be read is named, and what to do about it.

use super::common::{Truth, written};
use std::path::Path;
use stiction_formats::{Error, Kind, ReadOptions, Table, read_table, read_table_with};

fn read(path: &Path) -> Result<Table, Error> {
    read_table(path, &ReadOptions::default())
}

#[test]
fn what_cannot_be_read_is_named_with_its_remedy() {
    let folder = written("write_odd_db3.py");
    let mut said = Vec::new();
    for name in [
        "wal.db3",
        "hot.db3",
        "other.db3",
        "empty.db3",
        "utf16.db3",
        "cut.db3",
        "twice.db3",
        "unknown.db3",
        "short.db3",
        "lost.d",
        "other.d",
    ] {
        let error = read(&folder.path().join(name)).unwrap_err();
        let text = error.to_string();
        said.push(text.replace(&format!("{}/", folder.path().display()), ""));
    }
    insta::assert_snapshot!(said.join("\n"));
}

#[test]
fn a_file_of_several_is_read_alone_and_says_so() {
    let folder = written("write_db3.py");
    let split = folder.path().join("split.bag");
    let alone = read(&split.join("split_1.db3")).unwrap();
    assert!(
        alone
            .detected
            .iter()
            .any(|line| line.contains("one of 3 files"))
    );
    let whole = read(&split).unwrap();
    let listed = read(&split.join("metadata.yaml")).unwrap();
    assert_eq!(Truth::of(&whole), Truth::of(&listed));
    assert!(alone.rows() < whole.rows());
    assert_eq!(
        stiction_formats::bag_of(&split),
        Some(split.join("metadata.yaml"))
    );
    assert_eq!(stiction_formats::bag_of(folder.path()), None);
}

#[test]
fn of_a_recording_in_several_files_all_bytes_are_handed_on() {
    let folder = written("write_db3.py");
    let split = folder.path().join("split.bag");
    let mut handed = Vec::new();
    let take = |bytes: &[u8]| handed.extend_from_slice(bytes);
    read_table_with(&split, &ReadOptions::default(), take).unwrap();
    let names = ["metadata.yaml", "split_0.db3", "split_1.db3", "split_2.db3"];
    let files = names.map(|name| std::fs::read(split.join(name)).unwrap());
    assert!(handed == files.concat());
}

#[test]
fn a_write_ahead_log_that_is_written_back_is_no_hindrance() {
    let folder = written("write_odd_db3.py");
    let table = read(&folder.path().join("closed.db3")).unwrap();
    assert_eq!(table.rows(), 20);
    let said = |what: &str| table.detected.iter().any(|line| line.contains(what));
    assert!(said("write-ahead log"), "{:?}", table.detected);
}

#[test]
fn a_message_that_is_larger_than_allowed_is_refused() {
    let folder = written("write_odd_db3.py");
    let options = ReadOptions {
        limits: stiction_formats::Limits { memory: 100_000 },
        ..ReadOptions::default()
    };
    let error = read_table(&folder.path().join("large.db3"), &options).unwrap_err();
    assert_eq!(error.kind, Kind::Limit, "{error}");
}
