//! Rows that an enable or mode column leaves out, and flags, which are no quantity.

use crate::mapping_common::{axis, codes, column, message, table, told, warnings};
use proptest::prelude::*;
use stiction_formats::Table;
use stiction_log::{Enable, Log, Mapping, Selector};

fn enable(name: &str, equals: Option<f64>) -> Mapping {
    Mapping {
        enable: Some(Enable {
            column: Selector::Name(name.into()),
            equals,
            mask: None,
        }),
        ..Mapping::default()
    }
}

/// A clean log with one more column.
fn with(name: &str, value: impl Fn(usize) -> f64) -> Table {
    let mut table = axis(4000).table();
    table
        .columns
        .push(column(name, (0..4000).map(value).collect()));
    table
}

fn flag(on: bool) -> f64 {
    f64::from(u8::from(on))
}

#[test]
fn rows_that_are_not_enabled_leave_a_gap() {
    // From the second stretch on: one row only.
    let off = |i: usize| (500..900).contains(&i) || i == 2000 || i >= 3990;
    let log = Log::from_table(
        &with("Enabled", |i| flag(!off(i))),
        &enable("Enabled", None),
    )
    .unwrap();
    assert_eq!(log.time.len(), 4000 - 411);
    assert_eq!(log.segments, [0..500, 500..1600, 1600..3589]);
    // They are not missing: they are left out.
    assert_eq!(warnings(&log), [""; 0]);
    assert!(!codes(&log).contains(&"gap"), "{:?}", codes(&log));
    insta::assert_snapshot!(message(&log, "not-enabled"));
    let left_out = log.not_enabled.unwrap();
    assert_eq!((left_out.rows, left_out.of), (411, 4000));
    assert_eq!(left_out.column, "5 \"Enabled\"");
}

/// The status word of CiA 402: bit 4 (voltage) and 9 (remote) say nothing of the state, bit 5 is 0 while a quick stop is active.
#[test]
fn a_status_word_says_where_operation_is_enabled() {
    let word = |i: usize| match i {
        500..700 => f64::from(0x1231),
        700..800 => f64::from(0x1633),
        800..900 => f64::from(0x1607),
        i if i % 2 == 0 => f64::from(0x1637),
        _ => f64::from(0x1227),
    };
    for name in [
        "6041h Statusword",
        "axis1.Status word",
        "0x6041",
        "status_word",
    ] {
        let log = Log::from_table(&with(name, word), &Mapping::default()).unwrap();
        assert_eq!(warnings(&log), ["enable-ignored"], "{name}");
    }
    let table = with("Statusword", word);
    let log = Log::from_table(&table, &Mapping::default()).unwrap();
    insta::assert_snapshot!(message(&log, "enable-ignored"));
    let masked = |mask: u32, equals: Option<f64>| {
        let mut mapping = enable("Statusword", equals);
        mapping.enable.as_mut().unwrap().mask = Some(mask);
        Log::from_table(&table, &mapping)
    };
    let log = masked(0x6f, Some(39.0)).unwrap();
    assert_eq!(log.segments, [0..500, 500..3600]);
    assert_eq!(log.time.len(), 3600);
    // Signed numbers of 16 bits have the same bits.
    let signed = with("Statusword", |i| word(i) - 65536.0);
    let mut mapping = enable("Statusword", Some(39.0));
    mapping.enable.as_mut().unwrap().mask = Some(0x6f);
    assert_eq!(Log::from_table(&signed, &mapping).unwrap().time.len(), 3600);
    // Without equals all bits of the mask are to be set.
    assert_eq!(masked(0x27, None).unwrap().time.len(), 3600);
    insta::assert_snapshot!(masked(0x6f, Some(15.0)).unwrap_err().to_string());
    // Enabled throughout, or no status word at all.
    for value in [f64::from(0x1637), 0.5] {
        let log = Log::from_table(&with("Statusword", |_| value), &Mapping::default()).unwrap();
        assert!(!warnings(&log).contains(&"enable-ignored"), "{value}");
    }
}

#[test]
fn a_column_that_says_enabled_and_is_not_used_is_a_warning() {
    let some_off = |i: usize| flag(!(500..900).contains(&i));
    for name in ["Drive enabled", "bEnable", "axis1.ServoOn", "Freigabe"] {
        let log = Log::from_table(&with(name, some_off), &Mapping::default()).unwrap();
        assert_eq!(warnings(&log), ["enable-ignored"], "{name}");
        assert_eq!(log.time.len(), 4000);
    }
    let log = Log::from_table(&with("Drive enabled", some_off), &Mapping::default()).unwrap();
    insta::assert_snapshot!(message(&log, "enable-ignored"));
    // Always enabled, no flag, or a flag of something else.
    for (name, value) in [("Drive enabled", 1.0), ("Enabled", 3.0), ("Brake on", 0.0)] {
        let late = |i: usize| if i < 2000 { value } else { 1.0 };
        let log = Log::from_table(&with(name, late), &Mapping::default()).unwrap();
        assert_eq!(warnings(&log), [""; 0], "{name}");
    }
}

#[test]
fn a_mode_keeps_its_rows() {
    let mode = |i: usize| match i {
        0..1000 => 6.0,
        1000..3000 => 8.0,
        _ => f64::NAN,
    };
    let log = Log::from_table(&with("Mode", mode), &enable("Mode", Some(8.0))).unwrap();
    assert_eq!(log.time.len(), 2000);
    assert_eq!((log.time[0], log.start), (0.0, 1.0));
    assert_eq!(log.segments.len(), 1);
}

/// What stands in the rows that are left out counts nowhere: not as missing, not as saturated, not as motion.
#[test]
fn what_is_left_out_is_not_looked_at() {
    let clean = Log::from_table(
        &with("on", |i| flag(!(500..2900).contains(&i))),
        &enable("on", None),
    )
    .unwrap();
    let mut table = with("on", |i| flag(!(500..2900).contains(&i)));
    for values in table.columns[1..4].iter_mut().map(|c| &mut c.values) {
        values[500..2900].fill(f64::NAN);
        values[1000..1800].fill(1.0);
    }
    let log = Log::from_table(&table, &enable("on", None)).unwrap();
    assert!(Log::of_table(table.clone(), &enable("on", None)).as_ref() == Ok(&log));
    assert_eq!(log, clean);
}

#[test]
fn what_is_refused() {
    let refused = |table: &Table, mapping: &Mapping| {
        let error = Log::from_table(table, mapping).unwrap_err();
        format!("{} <- {}", error, error.setting().unwrap_or("no key"))
    };
    let modes = |i: usize| [0.0, 6.0, 8.0][i % 3];
    let many = |i: usize| (i % 50) as f64;
    let mut short = with("on", |i| flag(i > 9));
    short.columns[4].values.truncate(1000);
    let lines = [
        refused(&with("mode", modes), &enable("mode", None)),
        refused(&with("mode", many), &enable("mode", None)),
        refused(&with("mode", modes), &enable("mode", Some(9.0))),
        refused(&with("on", |_| 0.0), &enable("on", None)),
        refused(&with("on", |_| f64::NAN), &enable("on", None)),
        refused(&with("on", |i| flag(i > 9)), &enable("mode", None)),
        refused(&with("on", |i| flag(i > 9)), &enable("force", None)),
        refused(&with("on", |i| flag(i == 9)), &enable("on", None)),
        refused(&short, &enable("on", None)),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn a_flag_is_no_force_and_no_position() {
    let on = |i: usize| flag(i % 100 < 50);
    let axis = axis(4000);
    let flags = |name: &str| column(name, (0..4000).map(on).collect());
    let columns = vec![
        column("time [s]", axis.time),
        flags("Torque active"),
        flags("Position reached"),
        column("Position [m]", axis.position),
        column("Torque [N]", axis.force),
        flags("Current"),
    ];
    let log = Log::from_table(&table(columns.clone()), &Mapping::default()).unwrap();
    insta::assert_snapshot!(told(&log));
    let why: Vec<_> = log.columns.iter().map(|c| c.reason.as_str()).collect();
    let off = "a flag: 0 and 1 alone; if the axis is enabled where it is 1, leave out the others: enable = \"Torque active\" under [columns]";
    assert_eq!(why[1], off);
    let mut braked = columns.clone();
    braked[1].name = "Brake closed".into();
    let log = Log::from_table(&table(braked), &Mapping::default()).unwrap();
    let held = "a flag: 0 and 1 alone; if a brake holds the axis where it is 1, leave out those rows: enable = { column = \"Brake closed\", equals = 0 } under [columns]";
    assert_eq!(log.columns[1].reason, held);
    // With nothing else that could be the force there is none.
    let without = columns.into_iter().filter(|c| c.name != "Torque");
    let log = Log::from_table(&table(without.collect()), &Mapping::default()).unwrap();
    assert!(log.force.is_none(), "{}", told(&log));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// A log without its rows that are not enabled is the log of the other rows, but for the splits.
    #[test]
    fn enabled_rows_are_kept_as_they_are(ends in prop::collection::btree_set(20_usize..3980, 1..8)) {
        let on = |i: usize| ends.iter().filter(|end| **end <= i).count() % 2 == 0;
        let full = with("on", |i| flag(on(i)));
        let log = Log::from_table(&full, &enable("on", None)).unwrap();
        let kept: Vec<usize> = (0..4000).filter(|i| on(*i)).collect();
        let of = |column: usize| kept.iter().map(|i| full.columns[column].values[*i]).collect::<Vec<_>>();
        prop_assert_eq!(log.position.as_ref(), Some(&of(1)));
        prop_assert_eq!(log.force.as_ref(), Some(&of(3)));
        let starts = (1..4000).filter(|i| on(*i) && !on(i - 1)).count() + 1;
        prop_assert_eq!(log.segments.len(), starts);
        prop_assert_eq!(log.not_enabled.map(|left| left.rows), Some(4000 - kept.len()));
    }
}

/// The time, taken for the enable column, is named as what it is not, before it is missed.
#[test]
fn a_column_of_many_numbers_is_no_enable() {
    let error = Log::from_table(&axis(3000).table(), &enable("time", None)).unwrap_err();
    insta::assert_snapshot!(error.to_string());
    assert_eq!(error.setting(), Some("columns.enable"));
}

/// Rows that are left out at a regular spacing leave the rate of the others.
#[test]
fn rows_that_are_left_out_leave_the_rate() {
    let whole = Log::from_table(&axis(4000).table(), &Mapping::default()).unwrap();
    let every_hundredth = with("on", |i| flag(i % 100 != 99));
    let log = Log::from_table(&every_hundredth, &enable("on", None)).unwrap();
    assert_eq!(log.rate_hz, whole.rate_hz);
    assert_eq!(log.segments.len(), 40);
    assert!(
        !log.findings.iter().any(|f| f.code().as_str() == "jitter"),
        "{}",
        told(&log)
    );
}
