//! What of a recording of rosbag2 cannot be read is named, and what to do about it.

use super::common::written;
use std::path::Path;
use stiction_log::{Error, Kind, ReadOptions, Table, read_table};

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
    ] {
        let error = read(&folder.path().join(name)).unwrap_err();
        let text = error.to_string();
        said.push(text.replace(&format!("{}/", folder.path().display()), ""));
    }
    insta::assert_snapshot!(said.join("\n"));
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
        limits: stiction_log::Limits { memory: 100_000 },
        ..ReadOptions::default()
    };
    let error = read_table(&folder.path().join("large.db3"), &options).unwrap_err();
    assert_eq!(error.kind, Kind::Limit, "{error}");
}
