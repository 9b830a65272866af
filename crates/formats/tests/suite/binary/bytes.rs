//! The bytes that are handed on are those that were read, whatever happens to the file meanwhile.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;

use super::common::{recordings, written};
use stiction_formats::{Kind, ReadOptions, read_table, read_table_with, text};

fn append(path: &Path, bytes: &[u8]) {
    let mut file = OpenOptions::new().append(true).open(path).unwrap();
    file.write_all(bytes).unwrap();
}

#[test]
fn all_bytes_of_a_file_are_handed_on_in_order() {
    let folder = written("write_small.py");
    let line = |n: u32| format!("{n};{}.5\r\n", n % 97);
    let text: String = (0..900_000).map(line).collect();
    std::fs::write(folder.path().join("long.txt"), &text).unwrap();
    let wide: Vec<u8> = "\u{feff}t;q\n1;2\n2;3\n3;4\n"
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    std::fs::write(folder.path().join("wide.txt"), wide).unwrap();
    for path in recordings(folder.path()) {
        let mut handed = Vec::new();
        let table = read_table_with(&path, &ReadOptions::default(), |bytes| {
            handed.extend_from_slice(bytes);
        });
        let plain = read_table(&path, &ReadOptions::default());
        assert_eq!(table.is_ok(), plain.is_ok(), "{}", path.display());
        if table.is_ok() {
            assert!(
                handed == std::fs::read(&path).unwrap(),
                "{}",
                path.display()
            );
        }
    }
}

#[test]
fn of_a_text_that_grows_the_rows_that_were_read_are_handed_on() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.txt");
    let line = |n: u32| format!("{n};{}.5\n", n % 97);
    let text: String = (0..900_000).map(line).collect();
    std::fs::write(&path, text).unwrap();
    let mut handed = Vec::new();
    let table = read_table_with(&path, &ReadOptions::default(), |bytes| {
        if handed.is_empty() {
            append(&path, "900000;1.5\n900001;2.5\n".as_bytes());
        }
        handed.extend_from_slice(bytes);
    });
    let again = text::read(&handed[..], &text::TextOptions::default()).unwrap();
    assert_eq!(table.unwrap().columns, again.columns);
    assert_eq!(again.rows(), 900_002);
}

#[test]
fn another_file_that_changes_is_refused() {
    let folder = written("write_small.py");
    let path = folder.path().join("stored.npz");
    let mut first = true;
    let error = read_table_with(&path, &ReadOptions::default(), |_| {
        if std::mem::take(&mut first) {
            append(&path, b"more");
        }
    });
    let error = error.unwrap_err();
    assert_eq!(error.kind, Kind::Io);
    assert!(
        error.to_string().contains("changed while it was read"),
        "{error}"
    );
}
