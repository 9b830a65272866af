//! What scipy, numpy, h5py, pyarrow and pandas write comes back bit for bit.

use super::common::{Truth, recordings, written};
use stiction_formats::{Kind, ReadOptions, Table, read_table};

fn compare(name: &str, found: &Truth, truth: &Truth) {
    let names = |truth: &Truth| -> Vec<String> {
        truth.columns.iter().map(|(name, _)| name.clone()).collect()
    };
    assert_eq!(names(found), names(truth), "{name}: columns");
    for ((column, found), (_, truth)) in found.columns.iter().zip(&truth.columns) {
        assert_eq!(found.len(), truth.len(), "{name}: {column}");
        let wrong = found.iter().zip(truth).position(|(a, b)| a != b);
        if let Some(row) = wrong {
            panic!(
                "{name}: {column}, sample {row}: {:#x} is not {:#x}",
                found[row], truth[row]
            );
        }
    }
    assert_eq!(found.scalars, truth.scalars, "{name}: scalars");
    assert_eq!(found.skipped, truth.skipped, "{name}: left out");
}

fn detects(table: &Table, what: &str) -> bool {
    table.detected.iter().any(|line| line.contains(what))
}

/// Reads every file of a script that has a truth beside it, under its own name and another, and compares.
fn come_back(script: &str) -> Vec<(String, Table)> {
    let folder = written(script);
    let mut tables = Vec::new();
    for path in recordings(folder.path()) {
        let name = path.file_name().unwrap().to_str().unwrap();
        let Some(truth) = Truth::beside(&path) else {
            continue;
        };
        let table = read_table(&path, &ReadOptions::default())
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        compare(name, &Truth::of(&table), &truth);

        // The name of a file says nothing: the same bytes under another one read the same.
        let disguised = path.with_extension("csv");
        std::fs::rename(&path, &disguised).unwrap();
        let again = read_table(&disguised, &ReadOptions::default()).unwrap();
        assert_eq!(Truth::of(&again), Truth::of(&table), "{name} as CSV");
        tables.push((name.to_owned(), table));
    }
    tables
}

#[test]
fn every_writer_comes_back_bit_for_bit() {
    let tables = come_back("write_binary.py");
    assert_eq!(tables.len(), 29);
    for (name, table) in &tables {
        let has = |column: &str| table.columns.iter().any(|c| c.name == column);
        assert_eq!(
            detects(table, "beyond 2^53"),
            has("i_int64") || name.starts_with("encodings"),
            "{name}: {:?}",
            table.detected
        );
        match name.as_str() {
            "plain.h5" => {
                let torque = table.columns.iter().find(|c| c.name == "g.torque").unwrap();
                assert_eq!(torque.unit.as_deref(), Some("N m"));
            }
            "int96.parquet" | "snappy.parquet" | "zstd.parquet" | "stored.npz" => {
                let stamp = table.columns.iter().find(|c| c.name.starts_with("stamp"));
                assert_eq!(stamp.unwrap().unit.as_deref(), Some("s"));
                assert!(
                    detects(table, "seconds from the first"),
                    "{:?}",
                    table.detected
                );
            }
            _ => {}
        }
    }
}

#[test]
fn json_comes_back_bit_for_bit() {
    let tables = come_back("write_json.py");
    assert_eq!(tables.len(), 13);
    for (name, table) in &tables {
        let wide = name == "columns.json" || name == "indented.json";
        assert_eq!(detects(table, "beyond 2^53"), wide, "{name}");
        let dated = table.columns.iter().find(|c| c.name.ends_with("at"));
        if let Some(column) = dated {
            assert_eq!(column.unit.as_deref(), Some("s"));
            assert!(detects(table, "dates with time"), "{name}");
        }
    }
}

#[test]
fn arrow_comes_back_bit_for_bit() {
    let tables = come_back("write_arrow.py");
    assert_eq!(tables.len(), 17);
    for (name, table) in &tables {
        if name == "one_row.arrow" {
            assert_eq!(table.columns[0].unit.as_deref(), Some("mm"));
            assert_eq!(table.columns[1].unit, None);
        }
        let stamp = table.columns.iter().find(|c| c.name == "stamp_ns");
        assert!(stamp.is_none_or(|column| column.unit.as_deref() == Some("s")));
        assert_eq!(
            detects(table, "beyond 2^53"),
            stamp.is_some(),
            "{name}: {:?}",
            table.detected
        );
    }
}

#[test]
fn mcap_comes_back_bit_for_bit() {
    let tables = come_back("write_mcap.py");
    assert_eq!(tables.len(), 5);
    for (name, table) in &tables {
        let stamps = table
            .columns
            .iter()
            .filter(|c| c.name.ends_with("stamp") || c.name.ends_with("log_time"));
        assert!(stamps.clone().next().is_some(), "{name}");
        for stamp in stamps {
            assert_eq!(stamp.unit.as_deref(), Some("s"), "{name}");
        }
    }
}

#[test]
fn rosbags_come_back_bit_for_bit() {
    let tables = come_back("write_db3.py");
    assert_eq!(tables.len(), 12);
    for (name, table) in &tables {
        let assumed = detects(table, "no definition in the recording");
        let bare = ["humble", "common", "split"];
        let bare = bare.iter().any(|start| name.starts_with(start));
        assert_eq!(assumed, bare, "{name}: {:?}", table.detected);
        let several = detects(table, "3 files, read as one recording");
        assert_eq!(several, name == "split.bag", "{name}");
    }
}

#[test]
fn tdms_comes_back_bit_for_bit() {
    let tables = come_back("write_tdms.py");
    assert_eq!(tables.len(), 6);
    for (name, table) in &tables {
        if name.starts_with("version") {
            assert_eq!(table.columns[0].unit.as_deref(), Some("N m"));
            assert_eq!(table.sample_time, Some(0.001));
            assert!(detects(table, "beyond 2^53"));
        }
        let stamp = table
            .columns
            .iter()
            .find(|c| c.name.ends_with("stamp") || c.name == "g.t");
        assert!(stamp.is_some(), "{name}");
        assert!(detects(table, "time stamps"), "{name}");
    }
}

#[test]
fn svb_comes_back_bit_for_bit() {
    let tables = come_back("write_svb.py");
    assert_eq!(tables.len(), 5);
    for (name, table) in &tables {
        assert!(detects(table, "TwinCAT Scope SVB"), "{name}");
        match name.as_str() {
            "clocks.svb" => {
                assert_eq!(table.sample_time, None);
                assert!(detects(
                    table,
                    "`time of ActPos` applies to `ActPos`, `ActPos (1)`"
                ));
                assert!(detects(table, "display Offset not applied: `ActTorque` 2"));
                assert!(detects(
                    table,
                    "display ScaleFactor not applied: `ActTorque` -1"
                ));
            }
            "no_times.svb" => assert_eq!(table.sample_time, Some(0.00025)),
            _ => {
                assert_eq!(table.columns[0].unit.as_deref(), Some("s"));
                assert_eq!(table.sample_time, Some(0.0005));
                assert!(detects(table, "beyond 2^53"), "{name}");
            }
        }
    }
}

#[test]
fn workbooks_come_back_bit_for_bit() {
    let tables = come_back("write_xlsx.py");
    assert_eq!(tables.len(), 4);
    for (name, table) in &tables {
        let commas = detects(table, "decimal comma in cells that are texts");
        assert_eq!(commas, name == "commas.xlsx", "{name}");
        let force = table
            .columns
            .iter()
            .find(|c| c.name == "Torque" || c.name == "Force")
            .unwrap();
        let unit = match name.as_str() {
            "titled.xlsx" | "commas.xlsx" => "N",
            _ => "N m",
        };
        assert_eq!(force.unit.as_deref(), Some(unit), "{name}");
        assert!(detects(table, "sheet "), "{name}");
    }
}

#[test]
fn a_codec_that_is_not_built_in_is_named() {
    let folder = written("write_binary.py");
    let error = read_table(
        &folder.path().join("refused.parquet"),
        &ReadOptions::default(),
    );
    let error = error.unwrap_err();
    assert_eq!(error.kind, Kind::Format);
    assert_eq!(error.place.column.as_deref(), Some("t"));
    assert!(error.to_string().contains("BROTLI"), "{error}");
    assert!(error.to_string().contains("refused.parquet"), "{error}");
}

#[test]
fn a_member_of_an_hdf5_file_that_cannot_be_read_costs_that_member_alone() {
    assert_eq!(come_back("write_odd_hdf5.py").len(), 48);
}

#[test]
fn mdf_comes_back_bit_for_bit() {
    let tables = come_back("write_mdf.py");
    assert_eq!(tables.len(), 21);
    for (name, table) in &tables {
        assert!(detects(table, "version 4."), "{name}");
        let wide = name.starts_with("version") || name.starts_with("odd");
        assert_eq!(detects(table, "beyond 2^53"), wide, "{name}");
        let unit = |name: &str| {
            let column = table.columns.iter().find(|c| c.name == name);
            column.and_then(|c| c.unit.as_deref())
        };
        if name.starts_with("version") {
            assert_eq!(unit("torque"), Some("N m"), "{name}");
            assert_eq!(unit("Motion.time"), Some("s"), "{name}");
        }
        if name.starts_with("odd") {
            assert_eq!((unit("t"), unit("angle")), (Some("s"), Some("deg")));
            assert!(table.columns[0].stamps);
        }
    }
}
