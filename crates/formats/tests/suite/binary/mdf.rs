//! MDF: what is said of broken files, what is kept of wide ones, groups with time of their own.

use super::common::written;
use std::path::Path;
use stiction_formats::{Column, ReadOptions, Table, read_table, read_wanted};
use stiction_log::{Channel, Mapping, Role, Selector};

/// Where some bytes stand first.
fn place(whole: &[u8], part: &[u8]) -> usize {
    let mut windows = whole.windows(part.len());
    windows.position(|here| here == part).unwrap()
}

#[test]
fn what_is_broken_is_named() {
    let folder = written("write_small.py");
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    let (plain, mixed) = (bytes("small_400.mf4"), bytes("mixed.mf4"));
    let with = |whole: &[u8], mark: &[u8], from: usize, new: &[u8]| {
        let at = place(whole, mark) + from;
        let mut bytes = whole.to_vec();
        bytes[at..at + new.len()].copy_from_slice(new);
        bytes
    };
    let word = |number: u32| number.to_le_bytes();
    let files = [
        plain[..plain.len() - 40].to_vec(),
        plain[..80].to_vec(),
        with(&plain, b"MDF ", 28, &[74, 1]),
        with(&plain, b"MDF ", 60, &[1]),
        with(&plain, b"##HD", 24, &word(12)),
        with(&plain, b"##HD", 24, &word(1 << 30)),
        with(&plain, b"##DG", 2, b"XX"),
        // Records beyond the data, and bytes of a channel beyond its record.
        with(&plain, b"##CG", 80, &word(41)),
        with(&plain, b"##CN", 92, &word(1000)),
        with(&mixed, b"##CN", 92, &word(8)),
        // How the records of several groups are told apart.
        with(&mixed, b"##DG", 56, &[0]),
        with(&mixed, b"##DG", 56, &[3]),
        with(&mixed, b"##CG", 72, &[9]),
        with(&mixed, b"##CG", 72, &[2]),
        with(&mixed, b"##CG", 80, &word(21)),
        // Packed data: the way, the rows, their length, what they are.
        with(&mixed, b"##DZ", 26, &[2]),
        with(&mixed, b"##DZ", 26, &[9]),
        with(&mixed, b"##DZ", 28, &word(0)),
        with(&mixed, b"##DZ", 32, &word(300)),
        with(&mixed, b"##DZ", 40, &word(5000)),
        with(&mixed, b"##DZ", 48, &[0]),
        with(&mixed, b"##DL", 2, b"LX"),
    ];
    let mut said = Vec::new();
    for bytes in files {
        let path = folder.path().join("broken");
        std::fs::write(&path, bytes).unwrap();
        said.push(match read_table(&path, &ReadOptions::default()) {
            Err(error) => error
                .to_string()
                .replace(&format!("{}: ", path.display()), ""),
            Ok(table) => format!("read: {:?}", table.detected),
        });
    }
    insta::assert_snapshot!(said.join("\n"));
}

#[test]
fn what_is_left_out_is_named() {
    let folder = written("write_mdf.py");
    let path = folder.path().join("left_out.mf4");
    let table = read_table(&path, &ReadOptions::default()).unwrap();
    insta::assert_snapshot!(table.skipped.join("\n"));
    // Columns keep their numbers.
    assert_eq!(table.left_out, [2, 3, 4, 5, 6, 7, 8, 9]);
}

#[test]
fn only_columns_that_are_wanted_are_kept() {
    let folder = written("write_small.py");
    let path = folder.path().join("small_410.mf4");
    let whole = read_table(&path, &ReadOptions::default()).unwrap();
    let q = |heads: &Table| heads.columns.iter().map(|c| c.name == "q").collect();
    let part = read_wanted(&path, &ReadOptions::default(), |_| {}, &q).unwrap();
    assert_eq!(part.detected, whole.detected);
    for (place, (own, column)) in part.columns.iter().zip(&whole.columns).enumerate() {
        let wanted = column.name == "q";
        assert_eq!((&own.name, &own.unit), (&column.name, &column.unit));
        assert_eq!(own.values.is_empty(), !wanted);
        assert!(!wanted || own.values == column.values);
        let passed = part.passed.get(&place);
        assert_eq!(passed.is_none(), wanted);
        // What is told of the others is what their samples show.
        if let Some(passed) = passed {
            let has = |number: f64| column.values.contains(&number);
            assert_eq!((passed.zeros, passed.ones), (has(0.0), has(1.0)));
            assert!(passed.others && passed.changes);
        }
    }
}

/// The time stamps of the force, where it has some of its own.
fn stamps_of_force(table: &Table, [time, position, force]: [&str; 3]) -> Selector {
    let mapping = Mapping {
        time: Some(Channel::named(time)),
        position: Some(Channel::named(position)),
        force: Some(Channel::named(force)),
        ..Mapping::default()
    };
    let own = mapping.own_stamps(table);
    assert_eq!(own.len(), 1);
    assert_eq!(own[0].role, Role::Force);
    own[0].time.clone()
}

fn small(folder: &Path, name: &str) -> Table {
    read_table(&folder.join(name), &ReadOptions::default()).unwrap()
}

#[test]
fn groups_have_time_stamps_of_their_own() {
    let folder = written("write_small.py");
    for name in ["small_400.mf4", "small_410.mf4", "small_420.mf4"] {
        let table = small(folder.path(), name);
        let time = stamps_of_force(&table, ["Motion.time", "q", "force"]);
        assert_eq!(time, Selector::Name("Drive.time".to_owned()), "{name}");
    }
}

#[test]
fn of_groups_of_one_length_the_time_before_a_column_is_its_own() {
    let column = |name: &str, rows: u32| Column::headed(name, (0..rows).map(f64::from).collect());
    let names = ["Motion.time", "q", "Bus.time", "u", "Drive.time", "force"];
    let rows = [40, 40, 9, 9, 9, 9];
    let columns = names
        .iter()
        .zip(rows)
        .map(|(name, rows)| column(name, rows));
    let table = Table {
        columns: columns.collect(),
        ..Table::default()
    };
    let time = stamps_of_force(&table, ["Motion.time", "q", "force"]);
    assert_eq!(time, Selector::Name("Drive.time".to_owned()));
}
