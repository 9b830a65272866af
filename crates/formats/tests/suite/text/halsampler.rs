//! Logs of LinuxCNC's halsampler: what it lost has rows of its own.

use super::detect;
use proptest::prelude::*;
use std::fmt::Write;
use stiction_formats::text::{TextOptions, read_file};
use stiction_formats::{Error, Kind, Table, Unit};
use stiction_log::{Channel, Log, Mapping};
use stiction_testkit::hal;

/// What halsampler writes of these samples, by number: position and force.
fn written(numbers: &[usize], tagged: bool) -> String {
    let mut text = String::new();
    let mut next = 0;
    for &number in numbers {
        if number != next {
            text += "overrun\n";
        }
        next = number + 1;
        if tagged {
            write!(text, "{number} ").unwrap();
        }
        let [x, force] = sample(number);
        writeln!(text, "{x:.6} {force:.6} ").unwrap();
    }
    text
}

fn sample(number: usize) -> [f64; 2] {
    let phase = number as f64 * 1e-3 * std::f64::consts::TAU;
    let round = |value: f64| (value * 1e6).round() / 1e6;
    [round(20.0 * phase.sin()), round(5.0 * phase.cos())]
}

fn missing(table: &Table) -> Vec<usize> {
    let values = &table.columns[1].values;
    (0..values.len()).filter(|i| values[*i].is_nan()).collect()
}

fn error(text: &str) -> Error {
    detect(text).unwrap_err()
}

#[test]
fn what_was_lost_is_missing() {
    let numbers: Vec<usize> = (500..800).chain(840..1000).chain(1010..2000).collect();
    let table = detect(written(&numbers, true)).unwrap();
    let whole: Vec<f64> = (500..2000_u32).map(f64::from).collect();
    assert_eq!(table.columns[0].values, whole);
    let lost: Vec<usize> = (800..840).chain(1000..1010).map(|n| n - 500).collect();
    assert_eq!(missing(&table), lost);
    assert_eq!(table.columns[2].values[499], sample(999)[1]);
    insta::assert_snapshot!(table.detected.join("\n"), @r"
    separator blanks
    1 preamble line
    no header
    `overrun` in 2 places, first after data row 300: 50 samples missing, in rows without values
    decimal point
    ");
    // A rate then gives the time of every row, and the record has its gaps where they were.
    let unit = |text: &str| Unit::parse(text).unwrap();
    let mapping = Mapping {
        rate_hz: Some(1000.0),
        position: Some(Channel::index(2).unit(unit("mm"))),
        force: Some(Channel::index(3).unit(unit("N"))),
        ..Mapping::default()
    };
    let log = Log::from_table(&table, &mapping).unwrap();
    assert_eq!(log.time.len(), numbers.len());
    for (time, number) in log.time.iter().zip(&numbers) {
        assert!(
            (time - (number - 500) as f64 * 1e-3).abs() < 1e-9,
            "{time} {number}"
        );
    }
}

#[test]
fn what_cannot_be_placed_is_refused() {
    let text = written(&(0..20).chain(25..40).collect::<Vec<_>>(), false);
    let errors = [
        error(&text),
        // A first column that does not number the rows.
        error(&text.replace(" \n", " 7\n")),
        // More lost than there is.
        error(&written(&(0..20).chain(60..70).collect::<Vec<_>>(), true)),
        error(&written(
            &(0..20).chain((1 << 31)..(1 << 31) + 10).collect::<Vec<_>>(),
            true,
        )),
    ];
    let shown: Vec<String> = errors
        .iter()
        .map(|e| format!("{:?}: {e}", e.kind))
        .collect();
    insta::assert_snapshot!(shown.join("\n"), @r"
    Time: `overrun` after data row 20: samples are missing, and no sample number in front of each row tells how many; log with `halsampler -t`; a larger depth= of `loadrt sampler` loses none; or keep the rows before the first overrun alone
    Time: `overrun` after data row 20: samples are missing, and no sample number in front of each row tells how many; log with `halsampler -t`; a larger depth= of `loadrt sampler` loses none; or keep the rows before the first overrun alone
    Limit: `overrun` after data row 20: 40 samples are missing, and 30 are there; at most as many missing as there are; log with a larger depth= of `loadrt sampler`, or keep the rows before the first overrun alone
    Limit: `overrun` after data row 20: 2147483628 samples are missing, and 30 are there; at most as many missing as there are; log with a larger depth= of `loadrt sampler`, or keep the rows before the first overrun alone
    ");
    // Where nothing is lost between rows, rows need no numbers.
    let table = detect(format!(
        "overrun\n{}overrun\n",
        written(&[0, 1, 2, 3], false)
    ))
    .unwrap();
    assert_eq!(table.rows(), 4);
    // A column may be called so, and a table with names is no log of halsampler.
    assert_eq!(error("t x\n0 1\n1 2\noverrun\n5 3\n").kind, Kind::Format);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Wherever samples are lost, also across the blocks that are read at once, the rest stays in its rows.
    #[test]
    fn rows_stay_where_they_were(
        gaps in prop::collection::vec((1_usize..4000, 1_usize..50), 1..12),
        start in prop::sample::select(vec![0_usize, 1, 70_000]),
    ) {
        let mut numbers = Vec::new();
        let mut at = start;
        for (there, lost) in gaps {
            numbers.extend(at..at + there + 50);
            at += there + 50 + lost;
        }
        let table = detect(written(&numbers, true)).unwrap();
        let last = *numbers.last().unwrap();
        prop_assert_eq!(table.rows(), last + 1 - start);
        let mut there = numbers.iter().peekable();
        for row in 0..table.rows() {
            let number = start + row;
            prop_assert_eq!(table.columns[0].values[row], number as f64);
            let found = [table.columns[1].values[row], table.columns[2].values[row]];
            if there.next_if_eq(&&number).is_some() {
                prop_assert_eq!(found, sample(number));
            } else {
                prop_assert!(found.iter().all(|v| v.is_nan()));
            }
        }
    }
}

/// The program itself, started when sampling has gone on for a while, so that its log begins with `overrun`.
#[test]
fn the_program_itself() {
    let _alone = hal::alone();
    let dir = tempfile::tempdir().unwrap();
    let script = "loadrt threads name1=servo period1=1000000\nloadrt siggen\nloadrt sampler depth=4000 cfg=fbs\n\
                  net x siggen.0.sine => sampler.0.pin.0\naddf siggen.0.update servo\naddf sampler.0 servo\nstart\n\
                  loadusr -w halsampler -n 50 first.txt\nloadusr -w halsampler -t -n 200 log.txt\n";
    std::fs::write(dir.path().join("log.hal"), script).unwrap();
    let mut command = hal::command("halrun", dir.path());
    let run = command
        .arg("log.hal")
        .output()
        .expect("halrun of LinuxCNC: run `cargo xtask setup`");
    assert!(
        run.status.success(),
        "{}",
        String::from_utf8_lossy(&run.stderr)
    );
    let text = std::fs::read_to_string(dir.path().join("log.txt")).unwrap();
    assert!(text.starts_with("overrun\n"), "{text}");
    let table = read_file(&dir.path().join("log.txt"), &TextOptions::default()).unwrap();
    let numbers = &table.columns[0].values;
    assert_eq!(numbers.len(), 200);
    assert!(
        numbers.windows(2).all(|p| p[1] - p[0] == 1.0),
        "{numbers:?}"
    );
    assert_eq!(table.columns.len(), 4);
}
