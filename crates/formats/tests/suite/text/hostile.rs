//! Whatever the bytes, the reader answers: a table or an error, in bounded memory, without a panic.

use super::detect;
use proptest::prelude::*;
use stiction_formats::text::{Decimal, Separator, TextOptions, read};
use stiction_formats::{Error, Kind, Table};

/// What must hold for any answer to any bytes.
fn check(bytes: &[u8], options: &TextOptions) -> Result<Table, Error> {
    let answer = read(bytes, options);
    let lines = 1 + bytes.iter().filter(|&&b| b == b'\n' || b == b'\r').count() as u64;
    match &answer {
        Ok(table) => {
            assert!(!table.columns.is_empty());
            let samples: usize = table.columns.iter().map(|c| c.values.len()).sum();
            assert!(
                samples <= bytes.len(),
                "{samples} samples in {} bytes",
                bytes.len()
            );
            assert!(table.detected.iter().any(|d| d.starts_with("separator")));
        }
        Err(error) => {
            assert!(!error.found.is_empty());
            assert!(error.to_string().len() < 1000);
            assert!(
                !error.to_string().contains(|c: char| c.is_control()),
                "{error:?}"
            );
            assert!(
                error.place.row.is_none_or(|row| (1..=lines).contains(&row)),
                "{error}"
            );
            assert_ne!(error.kind, Kind::Io);
        }
    }
    answer
}

fn any_options() -> impl Strategy<Value = TextOptions> {
    use proptest::option::of;
    let separator = prop_oneof![
        Just(Separator::Tab),
        Just(Separator::Semicolon),
        Just(Separator::Comma),
        Just(Separator::Pipe),
        Just(Separator::Colon),
        Just(Separator::Blanks)
    ];
    let decimal = prop_oneof![Just(Decimal::Point), Just(Decimal::Comma)];
    (
        of(separator),
        of(decimal),
        of(any::<bool>()),
        of(0_usize..20),
    )
        .prop_map(|(separator, decimal, header, preamble)| TextOptions {
            separator,
            decimal,
            header,
            preamble,
        })
}

/// Text that is nearly a table: pieces of every dialect in any order.
fn almost_a_table() -> impl Strategy<Value = Vec<u8>> {
    let piece = prop_oneof![
        8 => prop_oneof![
            Just(","), Just(";"), Just("\t"), Just(" "), Just("|"), Just(":"), Just("\n"),
            Just("\r\n"), Just("\r"), Just("\""), Just("."),
        ]
        .prop_map(str::to_owned),
        8 => prop_oneof![
            Just("1"), Just("-2.5"), Just("0,25"), Just("1e-3"), Just("NaN"), Just("inf"),
            Just("TRUE"), Just("1.234,5"), Just("132959733843760000"), Just("12:00:00"),
            Just("2024-05-01T12:00:00.001"), Just("01/02/2024 10:00:00"),
        ]
        .prop_map(str::to_owned),
        4 => prop_oneof![
            Just("Name"), Just("time"), Just("[s]"), Just("(mm)"), Just("x (1)"), Just("#"),
            Just("%"), Just("//"), Just("EOF"), Just("SampleTime[ms]"), Just("Starttime of export"),
            Just("SymbolName"), Just("Unit"), Just("Offset"), Just("\u{FEFF}"), Just("°"),
        ]
        .prop_map(str::to_owned),
        1 => "\\PC{0,4}",
    ];
    proptest::collection::vec(piece, 0..120).prop_map(|pieces| pieces.concat().into_bytes())
}

/// One change to a file: a byte set, a stretch removed, repeated or moved.
#[derive(Clone, Debug)]
enum Change {
    Set(usize, u8),
    Cut(usize, usize),
    Repeat(usize, usize),
    Insert(usize, Vec<u8>),
}

fn changes() -> impl Strategy<Value = Vec<Change>> {
    let at = any::<usize>;
    let change = prop_oneof![
        (at(), any::<u8>()).prop_map(|(a, b)| Change::Set(a, b)),
        (at(), prop::sample::select(b",;.\t\n\r\" -:#0".to_vec()))
            .prop_map(|(a, b)| Change::Set(a, b)),
        (at(), 0_usize..2000).prop_map(|(a, n)| Change::Cut(a, n)),
        (at(), 0_usize..2000).prop_map(|(a, n)| Change::Repeat(a, n)),
        (at(), almost_a_table()).prop_map(|(a, text)| Change::Insert(a, text)),
    ];
    proptest::collection::vec(change, 1..6)
}

fn apply(mut bytes: Vec<u8>, changes: &[Change]) -> Vec<u8> {
    for change in changes {
        let place = |at: usize| at % (bytes.len() + 1);
        let (at, end) = match change {
            Change::Set(at, _) | Change::Insert(at, _) => (place(*at), bytes.len()),
            Change::Cut(at, n) | Change::Repeat(at, n) => {
                (place(*at), (place(*at) + n).min(bytes.len()))
            }
        };
        match change {
            Change::Set(_, byte) => {
                if let Some(b) = bytes.get_mut(at) {
                    *b = *byte;
                }
            }
            Change::Cut(..) => drop(bytes.drain(at..end)),
            Change::Repeat(..) => {
                let copy = bytes[at..end].to_vec();
                bytes.splice(at..at, copy);
            }
            Change::Insert(_, text) => drop(bytes.splice(at..at, text.iter().copied())),
        }
    }
    bytes
}

/// The first part of every real recording, and a Scope export.
fn real_files() -> Vec<Vec<u8>> {
    let mut files = vec![super::twincat::example().into_bytes()];
    if let Some(folder) = stiction_testkit::recordings() {
        for name in [
            "tribometer/presliding.tsv",
            "servo/sliding_1.txt",
            "ur10e/joint_4.csv",
        ] {
            let bytes = std::fs::read(folder.join(name)).unwrap();
            files.push(bytes[..bytes.len().min(6000)].to_vec());
        }
    }
    files
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn arbitrary_bytes(bytes in proptest::collection::vec(any::<u8>(), 0..400), o in any_options()) {
        let _ = check(&bytes, &TextOptions::default());
        let _ = check(&bytes, &o);
    }

    #[test]
    fn nearly_tables(bytes in almost_a_table(), o in any_options()) {
        let _ = check(&bytes, &TextOptions::default());
        let _ = check(&bytes, &o);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn mutated_recordings(changes in changes(), o in any_options()) {
        for file in real_files() {
            let bytes = apply(file, &changes);
            let _ = check(&bytes, &TextOptions::default());
            let _ = check(&bytes, &o);
        }
    }
}

#[test]
fn amplification_is_bounded() {
    // One wide row and then very short ones must not be filled up with missing values.
    let wide: String = (0..4095).map(|c| format!("\tc{c}")).collect();
    let first: String = (0..4095).map(|_| "0\t").collect::<String>() + "0";
    let text = format!("Name{wide}\n\n{first}\n{}", "1\n".repeat(100_000));
    let table = detect(&text).unwrap();
    let samples: usize = table.columns.iter().map(|c| c.values.len()).sum();
    assert!(samples < text.len(), "{samples}");
    // The densest text there is: one byte for one missing value.
    let rows = format!("1{}\n", ";".repeat(4095)).repeat(200);
    let samples: usize = check(rows.as_bytes(), &TextOptions::default())
        .unwrap()
        .rows();
    assert_eq!(samples, 200);
}
