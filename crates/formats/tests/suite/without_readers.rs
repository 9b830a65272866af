//! A build without the reader of a format refuses its files in words, and reads text as ever.

use stiction_formats::{Kind, ReadOptions, read_table};

/// Whether the reader is there, how its files begin, what they are called.
const FORMATS: [(bool, &[u8], &str); 11] = [
    (
        cfg!(feature = "matlab"),
        b"MATLAB 5.0 MAT-file, of nothing",
        "MATLAB",
    ),
    (cfg!(feature = "hdf5"), b"\x89HDF\r\n\x1a\n", "HDF5"),
    (cfg!(feature = "numpy"), b"\x93NUMPY\x01\x00", "NumPy"),
    (cfg!(feature = "parquet"), b"PAR1", "Parquet"),
    (cfg!(feature = "json"), b"{\"t\": [0, 1]", "JSON"),
    (cfg!(feature = "arrow"), b"ARROW1\0\0", "Arrow"),
    (cfg!(feature = "mcap"), b"\x89MCAP0\r\n", "MCAP"),
    (cfg!(feature = "rosbag"), b"SQLite format 3\0", "rosbag2"),
    (cfg!(feature = "tdms"), b"TDSm", "TDMS"),
    (cfg!(feature = "mdf"), b"MDF     4.10    ", "ASAM MDF"),
    (cfg!(feature = "ethercat"), b"\x0a\x0d\x0d\x0a", "EtherCAT"),
];

#[test]
fn a_missing_reader_is_said() {
    let folder = tempfile::tempdir().unwrap();
    for (there, start, name) in FORMATS {
        let mut bytes = start.to_vec();
        bytes.resize(512, 0);
        if name == "MATLAB" {
            bytes[124..128].copy_from_slice(b"\x00\x01IM");
        }
        let file = folder.path().join("log");
        std::fs::write(&file, bytes).unwrap();
        let error = read_table(&file, &ReadOptions::default()).unwrap_err();
        let message = error.to_string();
        assert_eq!(error.file.as_deref(), Some(file.as_path()));
        let said = message.contains(&format!("this build has no {name}"));
        assert_eq!(said, !there, "{name}: {message}");
        assert!(there || error.kind == Kind::Format, "{name}: {message}");
    }
}

#[test]
fn text_needs_no_feature() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("log.csv");
    std::fs::write(&file, "time;force\n0;1\n1;2\n").unwrap();
    let table = read_table(&file, &ReadOptions::default()).unwrap();
    let names: Vec<&str> = table.columns.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["time", "force"]);
}
