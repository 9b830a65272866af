//! Everything that has to be decided before a table is a log is told at once, and what is written for each of it is enough.

use crate::mapping_common::{column, message, table, warnings};
use stiction_formats::{Error, Kind, Table, Unit};
use stiction_log::{Channel, Code, Log, Mapping, Selector};

/// A second of a sine with a force of two sensors, in milliseconds and without units.
fn bare() -> Table {
    let t = |k: usize| k as f64 * 1e-3;
    let x: Vec<f64> = (0..2000).map(|k| (9.0 * t(k)).sin()).collect();
    let f = |size: f64| {
        (0..2000)
            .map(|k| size * (9.0 * t(k)).cos().signum() + t(k))
            .collect()
    };
    table(vec![
        column("t", (0..2000).map(|k| k as f64).collect()),
        column("x", x),
        column("f1", f(8.0)),
        column("f2", f(9.0)),
    ])
}

fn said(error: Error) -> Vec<(Kind, String)> {
    error
        .each()
        .into_iter()
        .map(|e| (e.kind, e.to_string()))
        .collect()
}

fn named(column: &str, unit: &str) -> Option<Channel> {
    Some(Channel {
        column: Selector::Name(column.into()),
        unit: Unit::parse(unit).ok(),
        ..Channel::index(0)
    })
}

#[test]
fn all_that_is_open_is_told_at_once() {
    let error = Mapping::detect(&bare()).unwrap_err();
    assert_eq!(error.to_string().lines().count(), 3);
    let said = said(error);
    let kinds: Vec<Kind> = said.iter().map(|(kind, _)| *kind).collect();
    assert_eq!(kinds, [Kind::Ambiguous, Kind::Unit, Kind::Unit], "{said:?}");
    for (line, (_, message)) in [
        "force = { column = \"f1\", unit = \"N\" }",
        "time = { column = \"t\", unit = \"ms\" }",
        "position = { column = \"x\", unit = \"mm\" }",
    ]
    .iter()
    .zip(&said)
    {
        assert!(message.contains(line), "{message}");
    }
    // With these lines nothing is left to decide.
    let written = Mapping {
        time: named("t", "ms"),
        position: named("x", "mm"),
        force: named("f1", "N"),
        ..Mapping::default()
    };
    assert!(Log::from_table(&bare(), &written).is_ok());
}

#[test]
fn every_column_that_is_not_there_is_told() {
    let mapping = Mapping {
        time: named("tme", "ms"),
        position: named("pos", "mm"),
        force: named("f1", "N"),
        ..Mapping::default()
    };
    let error = mapping.complete(&bare()).unwrap_err();
    let settings: Vec<Option<String>> = error
        .each()
        .iter()
        .map(|e| e.setting().map(String::from))
        .collect();
    let both = ["columns.time.column", "columns.position.column"];
    assert_eq!(settings, both.map(|key| Some(key.to_string())));
}

#[test]
fn which_force_is_not_asked_where_the_motion_says_it() {
    let rows = |size: f64| {
        (0..500)
            .map(|k| size * (0.02 * f64::from(k)).sin())
            .collect()
    };
    let table = table(vec![
        column("Time [s]", (0..500).map(|k| f64::from(k) * 1e-3).collect()),
        column("X pos [mm]", rows(1.0)),
        column("Y pos [mm]", rows(2.0)),
        column("X torque [N m]", rows(3.0)),
        column("Y torque [N m]", rows(4.0)),
    ]);
    let said = said(Mapping::detect(&table).unwrap_err());
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(
        said[0]
            .1
            .contains("position = \"X pos\" with force = \"X torque\""),
        "{said:?}"
    );
}

/// A position of whole numbers up to 16 bits, which begins again.
fn counter(name: &str) -> Table {
    let t = |k: usize| k as f64 * 1e-3;
    let counts = |k: usize| (1e5 * (3.0 * t(k)).sin()).round().rem_euclid(65536.0);
    table(vec![
        column("Time [s]", (0..4000).map(t).collect()),
        column(name, (0..4000).map(counts).collect()),
        column(
            "Force [N]",
            (0..4000).map(|k| (3.0 * t(k)).cos() + t(k)).collect(),
        ),
    ])
}

#[test]
fn encoder_counts_are_offered_counts_and_their_wrap() {
    for name in [
        "Enc_counts",
        "encoder",
        "Motor position ticks",
        "Position inc",
    ] {
        let table = counter(name);
        let said = said(Mapping::detect(&table).unwrap_err());
        assert_eq!(said.len(), 1, "{said:?}");
        let line = format!(
            "position = {{ column = \"{name}\", unit = \"counts\", scale = \"1 um/count\" }}"
        );
        let message = &said[0].1;
        assert!(
            message.contains(&line) && message.contains("wrap = \"65536 counts\""),
            "{message}"
        );
        let clear = Mapping::clear_columns(&table);
        assert_eq!(clear.counter(&table), Some(65536), "{name}");
    }
    // Numbers that are no counts are not offered them for the name of a sensor, and a position that does not jump has no wrap.
    let mut plain = counter("encoder");
    for x in &mut plain.columns[1].values {
        *x = (*x / 65536.0).sin() * 0.1;
    }
    let said = said(Mapping::detect(&plain).unwrap_err());
    assert!(
        said[0].1.contains("unit = \"mm\"") && !said[0].1.contains("wrap"),
        "{said:?}"
    );
}

/// Rows at a rate, with stamps in whole milliseconds.
fn rounded(rate: f64) -> Table {
    let t = |k: usize| k as f64 / rate;
    table(vec![
        column(
            "Time [ms]",
            (0..4000).map(|k| (1e3 * t(k)).round()).collect(),
        ),
        column(
            "Position [mm]",
            (0..4000).map(|k| 20.0 * (7.0 * t(k)).sin()).collect(),
        ),
        column(
            "Force [N]",
            (0..4000).map(|k| (7.0 * t(k)).cos() + 0.1 * t(k)).collect(),
        ),
    ])
}

#[test]
fn rows_of_one_rate_whose_stamps_are_rounded_are_told_their_rate() {
    for rate in [600.0, 700.0, 800.0] {
        let table = rounded(rate);
        let log = Log::from_table(&table, &Mapping::default()).unwrap();
        assert_eq!(log.rate_hz, rate);
        assert_eq!(warnings(&log), ["jitter"]);
        let line = format!("rate = \"{rate} Hz\"");
        assert!(message(&log, "jitter").contains(&line));
        assert!(log.gaps.is_empty());
        let mapping = Mapping::detect(&table).unwrap().mapping;
        assert_eq!(Log::rate_of_coarse_clock(&table, &mapping), Some(rate));
        let counted = Mapping {
            rate_hz: Some(rate),
            ..Mapping::default()
        };
        let log = Log::from_table(&table, &counted).unwrap();
        let found = |code: Code| log.findings.iter().any(|f| f.code() == code);
        assert!(!found(Code::Jitter) && !found(Code::Gap));
    }
    let fine = rounded(1000.0);
    let mapping = Mapping::detect(&fine).unwrap().mapping;
    assert_eq!(Log::rate_of_coarse_clock(&fine, &mapping), None);
    // Faster than the clock: refused, with the rate.
    let fast = rounded(1500.0);
    let mapping = Mapping::detect(&fast).unwrap().mapping;
    assert_eq!(Log::rate_of_coarse_clock(&fast, &mapping), Some(1500.0));
    let refused = Log::from_table(&fast, &Mapping::default()).unwrap_err();
    assert!(
        refused.to_string().contains("rate = \"1500 Hz\""),
        "{refused}"
    );
}

fn seconds() -> Vec<f64> {
    (0..2000).map(|k| f64::from(k) * 1e-3).collect()
}

fn swing(size: f64) -> Vec<f64> {
    let x = |k: i32| (size * (9e-3 * f64::from(k)).sin()).round();
    (0..2000).map(x).collect()
}

/// Columns in counts, by their unit or their name, are offered the size of a count, whatever they are.
#[test]
fn what_is_in_counts_is_offered_the_size_of_a_count() {
    let mut said_of = String::new();
    for (names, units) in [
        (["Time", "Value", "Force"], ["s", "counts", "N"]),
        (["Time", "Axis 1", "Force"], ["s", "inc", "N"]),
        (["Time", "inc", "Force"], ["s", "", "N"]),
        (["Time", "Position", "Force counts"], ["s", "mm", ""]),
        (["Time", "Position", "Force"], ["s", "mm", "counts"]),
        (["t", "x", "Force counts"], ["", "", ""]),
    ] {
        let mut columns = vec![
            column(names[0], seconds()),
            column(names[1], swing(300.0)),
            column(names[2], swing(200.0)),
        ];
        for (column, unit) in columns.iter_mut().zip(units) {
            column.unit = Some(unit.to_string()).filter(|unit| !unit.is_empty());
        }
        let table = table(columns);
        let said = match Log::from_table(&table, &Mapping::default()) {
            Err(e) => e.to_string(),
            Ok(log) => message(&log, "no-force").to_string(),
        };
        said_of.push_str(&format!("{} {units:?}\n{said}\n\n", names.join(" | ")));
    }
    insta::assert_snapshot!(said_of);
}

/// The lines that are offered for columns of one role have units where the file has none, and a letter or two in a group counts.
#[test]
fn candidates_are_offered_with_their_units() {
    let struct_of = table(vec![
        column("run.t", seconds()),
        column("run.q", swing(300.0)),
        column("run.torque_actual", swing(200.0)),
        column("run.iq_actual", swing(100.0)),
    ]);
    let milliseconds = |off: f64| seconds().iter().map(|t| 1e3 * t + off).collect();
    let two_clocks = table(vec![
        column("t1", milliseconds(0.0)),
        column("t2", milliseconds(0.3)),
        column("Position [mm]", swing(300.0)),
        column("current_a", swing(100.0)),
        column("current_b", swing(110.0)),
    ]);
    let said: Vec<String> = [struct_of, two_clocks]
        .iter()
        .map(|table| Mapping::detect(table).unwrap_err().to_string())
        .collect();
    insta::assert_snapshot!(said.join("\n\n"));
}

#[test]
fn a_position_that_is_named_as_force_is_refused() {
    let table = table(vec![
        column("Time [s]", seconds()),
        column("Position [mm]", swing(300.0)),
        column("Force [N]", swing(200.0)),
    ]);
    let mapping = Mapping {
        force: Some(Channel::named("Position")),
        ..Mapping::default()
    };
    let error = mapping.complete(&table).unwrap_err();
    assert_eq!(error.setting(), Some("columns.force.column"));
    insta::assert_snapshot!(error.to_string());
}

/// An angle whose steps are those of an encoder of 18 bits in degrees is no angle in radians, given or assumed.
#[test]
fn degrees_that_are_read_as_radians_are_told() {
    let step = 360.0 / 262_144.0;
    let angle = |size: f64| -> Vec<f64> {
        let q = |k: i32| (size / step * (9e-3 * f64::from(k)).sin()).round() * step;
        (0..2000).map(q).collect()
    };
    let table = |angle| {
        table(vec![
            column("t", seconds()),
            column("q", angle),
            column("torque", swing(200.0)),
        ])
    };
    let log = Log::from_table(&table(angle(20.0)), &Mapping::default()).unwrap();
    insta::assert_snapshot!(message(&log, "unlikely-size"));
    let given = Mapping {
        position: named("q", "rad"),
        force: named("torque", "N m"),
        ..Mapping::default()
    };
    let log = Log::from_table(&table(angle(20.0)), &given).unwrap();
    assert!(warnings(&log).contains(&"unlikely-size"));
    let radians = angle(20.0).iter().map(|q| q.to_radians()).collect();
    let log = Log::from_table(&table(radians), &Mapping::default()).unwrap();
    assert!(!warnings(&log).contains(&"unlikely-size"));
}
