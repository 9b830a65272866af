//! Whatever the bytes, a reader gives a table or an error that names the file: no panic, no
//! unbounded memory.
//!
//! All in one test and in a program of its own, since its allocator is the program's and the memory of a
//! process can only be watched as a whole.

#[path = "../suite/binary/common.rs"]
mod binary_common;

mod ethercat;
mod lerobot;
mod mdf;
mod small;

use std::cell::Cell;
use std::io::Write;
use std::path::Path;

use binary_common::{recordings, written};
use peak_alloc::PeakAlloc;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use stiction_formats::{Error, Kind, Limits, ReadOptions, Table, read_table, read_wanted};
use stiction_log::{Channel, Log, Mapping};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// 2^17 samples are one MiB; a file may fill them, and the reader hold them three times.
const SAMPLES: u64 = 1 << 17;

/// What is allowed beside the samples: buffers and tables of decoders, names, notes.
const MEMORY_BOUND: usize = 8 << 20;

/// First bytes of the formats; the last of these lead to the text reader.
const STARTS: [&[u8]; 22] = [
    b"\x89HDF\r\n\x1a\n",
    b"\x93NUMPY\x01\x00",
    b"\x93NUMPY\x02\x00",
    b"PK\x03\x04",
    b"PAR1",
    b"\x00\x00\x00\x00\x02\x00\x00\x00\x01\x00\x00\x00\x00\x00\x00\x00\x02\x00\x00\x00q\x00",
    b"\x1f\x8b",
    b"{\"t\": [",
    b"[[",
    b"TDSm\x0e\0\0\0\x69\x12\0\0",
    b"\x89MCAP0\r\n",
    b"SQLite format 3\0\x10\0\x01\x01\0\x40\x20\x20",
    b"MDF     4.10    by hand \0\0\0\0\x9a\x01\0\0",
    b"ARROW1\0\0",
    b"\x0a\x0d\x0d\x0a\x1c\0\0\0\x4d\x3c\x2b\x1a\x01\0\0\0\xff\xff\xff\xff\xff\xff\xff\xff\x1c\0\0\0",
    b"\xd4\xc3\xb2\xa1\x02\0\x04\0\0\0\0\0\0\0\0\0\xff\xff\0\0\x01\0\0\0",
    b"\xa1\xb2\x3c\x4d\0\x02\0\x04\0\0\0\0\0\0\0\0\0\0\xff\xff\0\0\0\x01",
    b"\xff\xff\xff\xff\x10\0\0\0",
    b"[{\"q\":",
    // The header of an SVB file of one channel, recorded in 2022.
    b"\xb0\0\0\0\0\0\0\0\x01\0\0\0q\x80\x1b\x80\x05\x47\x5e\xd8\x01\x80\x1b\x80\x05\x47\x5e\xd8\x01\x01\0\0\0",
    b"time;force\n",
    b"",
];

// As in the crate: an error is made once, at the end.
#[allow(clippy::result_large_err)]
fn read(path: &Path) -> Result<Table, Error> {
    read_within(path, SAMPLES, MEMORY_BOUND)
}

// As above.
#[allow(clippy::result_large_err)]
fn read_within(path: &Path, samples: u64, bound: usize) -> Result<Table, Error> {
    let options = ReadOptions {
        limits: Limits {
            memory: samples * 24,
        },
        ..ReadOptions::default()
    };
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let result = read_table(path, &options);
    let used = MEMORY.peak_usage().saturating_sub(before);
    assert!(used <= bound, "{used} bytes for {}", path.display());
    if let Err(error) = &result {
        assert_eq!(error.file.as_deref(), Some(path));
        assert!(!error.found.is_empty());
    }
    result
}

/// One piece of damage, at a place given as a fraction of the file.
#[derive(Clone, Debug)]
enum Damage {
    Byte(f64, u8),
    Word(f64, u32),
    Cut(f64),
    Insert(f64, Vec<u8>),
    Copy(f64, f64, usize),
}

impl Damage {
    fn apply(&self, bytes: &mut Vec<u8>) {
        let at = |place: f64| (place * bytes.len() as f64) as usize;
        match *self {
            Damage::Byte(place, byte) => {
                let at = at(place);
                bytes[at..].iter_mut().take(1).for_each(|b| *b = byte);
            }
            Damage::Word(place, word) => {
                let at = at(place) & !3;
                let word = word.to_le_bytes();
                bytes[at..].iter_mut().zip(word).for_each(|(b, w)| *b = w);
            }
            Damage::Cut(place) => {
                let at = at(place);
                bytes.truncate(at);
            }
            Damage::Insert(place, ref more) => {
                let at = at(place);
                bytes.splice(at..at, more.iter().copied());
            }
            Damage::Copy(from, to, length) => {
                let (from, to) = (at(from), at(to));
                let end = (from + length).min(bytes.len());
                let part = bytes[from..end].to_vec();
                bytes[to..].iter_mut().zip(part).for_each(|(b, p)| *b = p);
            }
        }
    }
}

fn damage() -> impl Strategy<Value = Damage> {
    let byte = prop_oneof![any::<u8>(), Just(0), Just(0xff), Just(0x7f), Just(0x80)];
    let word = prop_oneof![
        any::<u32>(),
        0u32..64,
        Just(u32::MAX),
        Just(i32::MAX as u32),
        Just(1 << 20),
        Just(1 << 28)
    ];
    let place = 0.0..1.0f64;
    prop_oneof![
        6 => (place.clone(), byte).prop_map(|(at, byte)| Damage::Byte(at, byte)),
        4 => (place.clone(), word).prop_map(|(at, word)| Damage::Word(at, word)),
        1 => place.clone().prop_map(Damage::Cut),
        1 => (place.clone(), vec(any::<u8>(), 1..9)).prop_map(|(at, b)| Damage::Insert(at, b)),
        2 => (place.clone(), place, 1..64usize).prop_map(|(a, b, n)| Damage::Copy(a, b, n)),
    ]
}

fn runner(cases: u32) -> TestRunner {
    let cases = std::env::var("PROPTEST_CASES").map_or(cases, |text| text.parse().unwrap());
    TestRunner::new_with_rng(
        Config {
            cases,
            failure_persistence: None,
            ..Config::default()
        },
        proptest::test_runner::TestRng::deterministic_rng(
            proptest::test_runner::RngAlgorithm::ChaCha,
        ),
    )
}

#[test]
fn hostile_files() {
    let folder = written("write_small.py");
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("hostile");
    odd_files(scratch.path());
    bombs(&path);
    mdf::hostile(&path);
    small::hostile(&path);
    lerobot::hostile();
    ethercat::hostile(&path);
    arrays(&path);
    wide(&path);

    let (some, all) = mdf::every_byte(folder.path(), &path);
    eprintln!("{some} of {all} files of MDF refused that have one byte changed");

    let mut random = runner(600);
    random
        .run(
            &(0..STARTS.len(), vec(any::<u8>(), 0..600)),
            |(start, rest)| {
                std::fs::write(&path, [STARTS[start], &rest].concat()).unwrap();
                // Random bytes may by chance be a text file of one number.
                let _ = read(&path);
                // The same behind the header of a MAT file of version 5.
                let head = [&[b' '; 124][..], &[0, 1], b"IM", &rest].concat();
                std::fs::write(&path, head).unwrap();
                prop_assert!(read(&path).is_err());
                Ok(())
            },
        )
        .unwrap();

    let mut refused = (0, 0, 0);
    for recording in recordings(folder.path()) {
        let name = recording.file_name().unwrap().to_str().unwrap();
        let result = read(&recording);
        assert_eq!(result.is_err(), name.starts_with("refused"), "{result:?}");
        damaged(&recording, &path, 150, &read, &mut refused);
    }
    let (some, all, panics) = refused;
    eprintln!("{some} of {all} damaged files refused, {panics} at a panic of a decoder");

    let mut refused = (0, 0, 0);
    if let Some(folder) = stiction_testkit::recordings() {
        for file in MEASURED {
            let read = |path: &Path| read_within(path, MEASURED_SAMPLES, MEASURED_BOUND);
            assert!(read(&folder.join(file)).is_ok(), "{file}");
            damaged(&folder.join(file), &path, 12, &read, &mut refused);
        }
    }
    let (some, all, panics) = refused;
    eprintln!("{some} of {all} damaged recordings refused, {panics} at a panic of a decoder");
}

/// One measured recording of every kind.
const MEASURED: [&str; 5] = [
    "emps/DATA_EMPS.mat",
    "damiao/motor_1.npz",
    "tribometer/presliding.tsv",
    "servo/breakaway_1.txt",
    "ur10e/joint_1.csv",
];

/// What recordings may hold, and what reading them may take: three times that, and what the text reader has on its way.
const MEASURED_SAMPLES: u64 = 1 << 21;
const MEASURED_BOUND: usize = (3 << 24) + (28 << 20);

/// Damages a file in many ways and reads it; counts refusals, cases, and panics that were caught.
fn damaged(
    recording: &Path,
    scratch: &Path,
    cases: u32,
    read: &dyn Fn(&Path) -> Result<Table, Error>,
    count: &mut (u32, u32, u32),
) {
    let whole = std::fs::read(recording).unwrap();
    let counted = Cell::new(*count);
    let name = recording.file_name().unwrap().to_str().unwrap();
    let path = scratch.with_file_name(format!("damaged_{name}"));
    runner(cases)
        .run(&vec(damage(), 1..4), |damages| {
            let mut bytes = whole.clone();
            damages.iter().for_each(|damage| damage.apply(&mut bytes));
            std::fs::write(&path, bytes).unwrap();
            let result = read(&path);
            let panicked = result.as_ref().is_err_and(|e| e.found.contains("gave up"));
            let (refused, all, panics) = counted.get();
            let refused = refused + u32::from(result.is_err());
            counted.set((refused, all + 1, panics + u32::from(panicked)));
            Ok(())
        })
        .unwrap();
    *count = counted.get();
}

/// Things that are no recordings at all.
fn odd_files(folder: &Path) {
    let refuse = |path: &Path, kind: Kind, word: &str| {
        let error = read(path).unwrap_err();
        assert_eq!(error.kind, kind, "{error}");
        assert!(error.to_string().contains(word), "{error}");
    };
    refuse(folder, Kind::Io, "folder");
    refuse(&folder.join("nowhere.mat"), Kind::Io, "nowhere.mat");
    #[cfg(unix)]
    refuse(Path::new("/dev/zero"), Kind::Io, "regular");
    let empty = folder.join("empty");
    std::fs::write(&empty, b"").unwrap();
    refuse(&empty, Kind::Format, "empty");
    for three in [b"PAR", b"\x89HD", b"PK\x03", b"\0\0\0", b"\x93NU", b"a,b"] {
        std::fs::write(&empty, three).unwrap();
        assert!(read(&empty).is_err(), "{three:?}");
    }
    std::fs::write(&empty, b"\x1f\x8b\x08 some more").unwrap();
    refuse(&empty, Kind::Format, "gzip");
    for start in [b"MDF     3.30    ", b"UnFinMF 4.10    "] {
        std::fs::write(&empty, [&start[..], &[0; 600]].concat()).unwrap();
        refuse(&empty, Kind::Format, "asammdf");
    }
    // The decoder of HDF5 holds the file.
    let mut large = std::fs::File::create(&empty).unwrap();
    large.write_all(b"\x89HDF\r\n\x1a\n").unwrap();
    large.set_len(SAMPLES * 24 + 1).unwrap();
    refuse(&empty, Kind::Limit, "--max-memory");
}

/// An array of a byte each takes the memory of its samples, and an eighth of that.
fn arrays(path: &Path) {
    const SAMPLES: usize = 1 << 23;
    const KEPT: usize = SAMPLES * size_of::<f64>();
    for (shape, order) in [
        ("(8388608,)", "False"),
        ("(524288, 16)", "False"),
        ("(524288, 16)", "True"),
    ] {
        let text = format!("{{'descr': '|i1', 'fortran_order': {order}, 'shape': {shape}}}\n");
        let length = (text.len() as u16).to_le_bytes();
        let head = [b"\x93NUMPY\x01\x00", &length[..], text.as_bytes()].concat();
        std::fs::write(path, [head, vec![1; SAMPLES]].concat()).unwrap();
        let before = MEMORY.current_usage();
        MEMORY.reset_peak_usage();
        let table = read_table(path, &ReadOptions::default()).unwrap();
        let used = MEMORY.peak_usage().saturating_sub(before);
        assert!(used <= KEPT / 8 * 9 + (1 << 20), "{used} bytes for {shape}");
        let samples = table.columns.iter().map(|c| c.values.len()).sum::<usize>();
        assert_eq!(samples, SAMPLES);
    }
}

/// Of a text with twelve columns of which three are asked for, reading and mapping take less than twice these three, beside the
/// blocks that are read at once, two for each thread.
fn wide(path: &Path) {
    const ROWS: usize = 600_000;
    const KEPT: usize = 3 * ROWS * size_of::<f64>();
    let mut text = std::io::BufWriter::new(std::fs::File::create(path).unwrap());
    writeln!(text, "t [s];x [mm];F [N];a;b;c;d;e;f;g;h;i").unwrap();
    for row in 0..ROWS {
        let t = row as f64 / 1000.0;
        let (x, f) = (20.0 * t.sin(), 5.0 * t.cos());
        writeln!(text, "{t:.3};{x:.4};{f:.3};2;3;4;5;6;7;8;9;10").unwrap();
    }
    text.into_inner().unwrap();
    let mapping = Mapping {
        position: Some(Channel::named("x")),
        force: Some(Channel::named("F")),
        ..Mapping::default()
    };
    let threads = rayon::ThreadPoolBuilder::new().num_threads(2).build();
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let wanted = |heads: &Table| mapping.wanted(heads);
    let read = || read_wanted(path, &ReadOptions::default(), |_| {}, &wanted);
    let table = threads.unwrap().install(read).unwrap();
    let log = Log::of_table(table, &mapping).unwrap();
    let used = MEMORY.peak_usage().saturating_sub(before);
    assert_eq!(log.time.len(), ROWS);
    assert!(used <= 2 * KEPT + MEMORY_BOUND, "{used} bytes, {KEPT} kept");
}

/// Small files that claim to be huge.
fn bombs(path: &Path) {
    let npy = |descr: &str, shape: &str| {
        let text = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}}}\n");
        let length = (text.len() as u16).to_le_bytes();
        [b"\x93NUMPY\x01\x00", &length[..], text.as_bytes()].concat()
    };
    let claims = [
        (npy("'<f8'", "(1000000000000,)"), Kind::Limit),
        (npy("'<f8'", "(18446744073709551615, 2)"), Kind::Limit),
        (npy("'<f8'", "(60000,)"), Kind::Format),
        (npy("[('a', '<f8'), ('b', '<f4')]", "(80000,)"), Kind::Limit),
        (npy("[('a', '<f8', (99999999,))]", "(4,)"), Kind::Missing),
        (
            npy("[('a', '|S999999999'), ('b', '<f8')]", "(4,)"),
            Kind::Missing,
        ),
        (npy(&"[".repeat(60_000), "(4,)"), Kind::Format),
        (b"\x93NUMPY\x02\x00\xff\xff\xff\xff".to_vec(), Kind::Limit),
    ];
    for (bytes, kind) in claims {
        std::fs::write(path, &bytes).unwrap();
        let error = read(path).unwrap_err();
        assert_eq!(error.kind, kind, "{error}");
    }

    // A compressed variable that unpacks to 100 MB of zeros, honestly declared and not.
    for declared in [12_500_000u32, 50_000] {
        let mut element = Vec::new();
        for word in [
            6u32,
            8,
            6,
            0,
            5,
            8,
            declared,
            1,
            0x0001_0001,
            u32::from(b'q'),
            9,
        ] {
            element.extend(word.to_le_bytes());
        }
        element.extend((declared * 8).to_le_bytes());
        let mut packer = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
        let total = element.len() as u32 + 100_000_000;
        packer.write_all(&14u32.to_le_bytes()).unwrap();
        packer.write_all(&total.to_le_bytes()).unwrap();
        packer.write_all(&element).unwrap();
        for _ in 0..100 {
            packer.write_all(&[0; 1_000_000]).unwrap();
        }
        let packed = packer.finish().unwrap();
        let mut file = [&[b' '; 124][..], &[0, 1], b"IM"].concat();
        file.extend(15u32.to_le_bytes());
        file.extend((packed.len() as u32).to_le_bytes());
        file.extend(&packed);
        std::fs::write(path, &file).unwrap();
        match declared {
            50_000 => assert_eq!(read(path).unwrap().rows(), 50_000),
            _ => {
                let error = read(path).unwrap_err();
                assert_eq!(error.kind, Kind::Limit, "{error}");
                assert_eq!(error.place.column.as_deref(), Some("q"));
                assert_eq!(error.place.byte, Some(128));
            }
        }
    }
}
