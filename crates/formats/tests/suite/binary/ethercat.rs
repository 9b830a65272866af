//! Captures of EtherCAT come back as scapy decodes them, and what a capture lacks is named.

use super::common::{Truth, recordings, written};
use std::path::Path;
use stiction_formats::ethercat::{Address, Direction, Entry, ProcessData, Type, object};
use stiction_formats::{Error, Kind, Limits, ReadOptions, Table, read_table, read_table_with};

/// An object of the drive in a byte of a datagram.
fn entry(index: u16, address: Option<Address>, byte: usize) -> Entry {
    let known = object(index).unwrap();
    Entry {
        name: known.name.to_owned(),
        unit: known.unit.map(str::to_owned),
        address,
        byte,
        bit: 0,
        kind: known.kind,
        direction: known.direction,
    }
}

/// The map of the script: inputs of the drive from a byte on, and outputs.
fn map(inputs: (Option<Address>, usize), outputs: Option<Address>) -> ProcessData {
    let (read, from) = inputs;
    let clock = Address::Physical {
        station: 1001,
        offset: 0x910,
    };
    let entries = vec![
        entry(0x6041, read, from),
        entry(0x6064, read, from + 2),
        entry(0x6077, read, from + 6),
        Entry {
            name: "flag".into(),
            unit: None,
            bit: 5,
            kind: Type::Bool,
            ..entry(0x6041, read, from + 8)
        },
        entry(0x6040, outputs, 0),
        entry(0x607a, outputs, 2),
        Entry {
            name: "clock".into(),
            kind: Type::U64,
            ..entry(0x6041, Some(clock), 0)
        },
    ];
    ProcessData { entries }
}

fn of(name: &str) -> ProcessData {
    let station = |offset| {
        Some(Address::Physical {
            station: 1001,
            offset,
        })
    };
    match name.split(['_', '.']).next().unwrap() {
        // The only datagram of its kind needs no address.
        "shared" => map((None, 0), None),
        "apart" => map(
            (Some(Address::Logical(0x10800)), 0),
            Some(Address::Logical(0x10000)),
        ),
        "station" => map((station(0x1100), 0), station(0x1000)),
        _ => map((None, 6), None),
    }
}

fn read(path: &Path, ethercat: ProcessData) -> Result<Table, Error> {
    let options = ReadOptions {
        ethercat,
        ..ReadOptions::default()
    };
    read_table(path, &options)
}

fn shown(error: &Error, folder: &Path) -> String {
    error
        .to_string()
        .replace(&format!("{}/", folder.display()), "")
}

#[test]
fn captures_come_back_as_scapy_decodes_them() {
    let folder = written("write_ethercat.py");
    let mut read_so = 0;
    for path in recordings(folder.path()) {
        let name = path.file_name().unwrap().to_str().unwrap();
        let Some(mut truth) = Truth::beside(&path) else {
            continue;
        };
        let table = read(&path, of(name)).unwrap_or_else(|error| panic!("{error}"));
        let mut found = Truth::of(&table);
        let ((_, time), (_, known)) = (found.columns.remove(0), truth.columns.remove(0));
        // Ticks of 2^-30 s are none of a picosecond.
        let close = |(a, b): (&u64, &u64)| (f64::from_bits(*a) - f64::from_bits(*b)).abs() < 2e-12;
        assert!(
            time.len() == known.len() && time.iter().zip(&known).all(close),
            "{name}"
        );
        assert_eq!(found, truth, "{name}");
        let unit = |column: usize| table.columns[column].unit.as_deref();
        assert_eq!(
            [0, 2, 3, 4].map(unit),
            [Some("s"), Some("counts"), Some("0.1%"), None]
        );
        assert!(table.columns[0].stamps);
        let said = table.detected.join("\n");
        assert!(
            said.contains("3 cycles left out") || name.contains("marked"),
            "{name}: {said}"
        );
        read_so += 1;
    }
    assert_eq!(read_so, 12);
}

#[test]
fn a_capture_without_a_map_lists_its_datagrams() {
    let folder = written("write_ethercat.py");
    let error = read(&folder.path().join("apart.pcapng"), ProcessData::default()).unwrap_err();
    assert_eq!(error.kind, Kind::Missing);
    insta::assert_snapshot!(shown(&error, folder.path()));
}

#[test]
fn what_a_map_misses_is_named() {
    let folder = written("write_ethercat.py");
    let path = folder.path().join("apart.pcapng");
    let one = |entry| ProcessData {
        entries: vec![entry],
    };
    let at = |address| Some(Address::Logical(address));
    let mut said = Vec::new();
    for map in [
        one(entry(0x6064, at(0x20000), 0)),
        one(entry(0x6064, at(0x10800), 6)),
        one(entry(0x6064, at(0x10000), 0)),
        one(Entry {
            direction: Direction::Out,
            ..entry(0x6064, at(0x10800), 0)
        }),
    ] {
        said.push(shown(&read(&path, map).unwrap_err(), folder.path()));
    }
    for name in ["sent.pcapx", "other.pcapx"] {
        let error = read(&folder.path().join(name), of("both")).unwrap_err();
        said.push(shown(&error, folder.path()));
    }
    insta::assert_snapshot!(said.join("\n"));
}

#[test]
fn a_capture_that_is_cut_off_keeps_what_it_has() {
    let folder = written("write_ethercat.py");
    let whole = read(&folder.path().join("both_micro.pcap"), of("both")).unwrap();
    let cut = read(&folder.path().join("cut.pcapx"), of("both")).unwrap();
    assert_eq!(cut.rows(), whole.rows() - 1);
    assert!(
        cut.detected
            .iter()
            .any(|said| said.contains("within a packet"))
    );
}

#[test]
fn all_bytes_count_and_memory_is_bounded() {
    let folder = written("write_ethercat.py");
    let path = folder.path().join("both_nano.pcapng");
    let mut options = ReadOptions {
        ethercat: of("both"),
        ..ReadOptions::default()
    };
    let mut handed = Vec::new();
    read_table_with(&path, &options, |bytes| handed.extend_from_slice(bytes)).unwrap();
    assert!(handed == std::fs::read(&path).unwrap());
    options.limits = Limits {
        memory: 24 * 8 * 93,
    };
    assert_eq!(read_table(&path, &options).unwrap_err().kind, Kind::Limit);
    options.limits = Limits {
        memory: 24 * 8 * 94,
    };
    assert!(read_table(&path, &options).is_ok());
}

#[test]
fn a_description_beside_a_capture_gives_its_map() {
    let folder = written("write_ethercat.py");
    let mut said = Vec::new();
    for name in [
        "eni_image",
        "eni_slaves",
        "esi_apart",
        "esi_both",
        "esi_shared",
        "esi_station",
        "damaged",
    ] {
        let path = folder.path().join(name).join("log.pcapng");
        let error = read(&path, ProcessData::default()).unwrap_err();
        said.push(format!("{name}: {}", error.allowed));
    }
    insta::assert_snapshot!(said.join("\n"));
}
