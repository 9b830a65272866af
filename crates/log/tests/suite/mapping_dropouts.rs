//! What no sensor measured is found in a temperature or a load; what they may really do is left alone.

use crate::mapping_common::{axis, codes, column, message, noise, warnings};
use proptest::prelude::*;
use stiction_formats::Table;
use stiction_log::{Log, Mapping, Role, Severity};

const ROWS: usize = 4000;

/// What stands in a row in place of what the sensor measures.
type Fault = fn(usize) -> Option<f64>;

/// An axis with such a channel as its last column.
fn with(header: &str, values: Vec<f64>) -> Table {
    let mut table = axis(ROWS).table();
    table.columns.push(column(header, values));
    table
}

/// Warms up from 25 to 35 degrees Celsius, with noise.
fn warm(i: usize) -> f64 {
    25.0 + 10.0 * i as f64 / ROWS as f64 + 0.1 * noise(i)
}

fn temperature(at: impl Fn(usize) -> f64) -> Table {
    with("Temperature [degC]", (0..ROWS).map(at).collect())
}

fn load(at: impl Fn(usize) -> f64) -> Table {
    with("Normal load [N]", (0..ROWS).map(at).collect())
}

fn read(table: &Table) -> Log {
    let log = Log::from_table(table, &Mapping::default()).unwrap();
    // The same where the table is given away.
    assert!(Log::of_table(table.clone(), &Mapping::default()).as_ref() == Ok(&log));
    log
}

/// How far the temperature of a log is off at most, K.
fn off(log: &Log) -> f64 {
    let kelvins = log.temperature.as_ref().unwrap().iter().enumerate();
    kelvins.fold(0.0, |most, (i, x)| most.max((x - 273.15 - warm(i)).abs()))
}

#[test]
fn a_temperature_that_drops_out_is_bridged() {
    let faults: [(&str, Fault); 8] = [
        ("a row at 0", |i| (i == 700).then_some(0.0)),
        ("a row at 0 K", |i| (i == 700).then_some(-273.15)),
        ("end of the range", |i| {
            (700..760).contains(&i).then_some(850.0)
        }),
        ("mark", |i| (i % 97 == 5).then_some(-999.0)),
        ("several", |i| match i {
            700..720 => Some(-999.0),
            720..740 => Some(850.0),
            3000 => Some(0.0),
            _ => None,
        }),
        ("from the start", |i| (i < 300).then_some(0.0)),
        ("to the end", |i| (i >= 3700).then_some(0.0)),
        ("blank beside", |i| match i {
            700 | 702 => Some(-999.0),
            701 => Some(f64::NAN),
            _ => None,
        }),
    ];
    for (name, fault) in faults {
        let table = temperature(|i| fault(i).unwrap_or_else(|| warm(i)));
        let log = read(&table);
        assert_eq!(
            warnings(&log),
            ["sensor-dropout"].repeat(warnings(&log).len()),
            "{name}"
        );
        assert!(
            message(&log, "sensor-dropout").contains("of column 5 \"Temperature [degC]\""),
            "{name}"
        );
        assert!(off(&log) < 1.0, "{name}: off by {} K", off(&log));
        // The motion is whole.
        assert!(log.excluded.is_empty(), "{name}");
        assert_eq!(log.time.len(), ROWS);
    }
}

#[test]
fn what_is_said_of_them() {
    let of = |table: &Table| {
        let log = read(table);
        let said = log
            .findings
            .iter()
            .filter(|f| f.severity == Severity::Warning);
        let said: Vec<_> = said.map(|f| format!("{}: {}", f.code(), f)).collect();
        let columns = log
            .columns
            .iter()
            .filter(|c| c.role == Some(Role::Temperature) || c.role == Some(Role::Load));
        let columns: Vec<_> = columns.map(|c| c.reason.clone()).collect();
        format!("{}\n  {}", said.join("\n"), columns.join("\n  "))
    };
    let mut rows_left_out = temperature(|i| if i == 900 { -999.0 } else { warm(i) });
    rows_left_out.columns[0].values[10] = f64::NAN;
    rows_left_out.columns[0].values[20] = f64::NAN;
    let said = [
        of(&rows_left_out),
        of(&temperature(|i| match i {
            50 => -300.0,
            700..740 => 850.0,
            _ => warm(i),
        })),
        of(&temperature(|i| if i % 2 == 0 { 0.0 } else { warm(i) })),
        of(&temperature(|i| if i < 1500 { warm(i) } else { f64::NAN })),
        of(&temperature(|i| if i < 3000 { warm(i) } else { f64::NAN })),
        of(&load(|i| match i {
            700..720 => -999.0,
            3000 => 0.0,
            _ => 500.0 + 0.2 * noise(i),
        })),
    ];
    insta::assert_snapshot!(said.join("\n\n"));
}

#[test]
fn a_temperature_without_numbers_for_most_of_the_time_is_left_out() {
    let blank = [
        temperature(|i| if i < 1500 { warm(i) } else { f64::NAN }),
        temperature(|i| {
            if (1000..3200).contains(&i) {
                f64::NAN
            } else {
                warm(i)
            }
        }),
        temperature(|_| f64::NAN),
        temperature(|_| -300.0),
        temperature(|i| if i % 2 == 0 { 0.0 } else { warm(i) }),
    ];
    for table in blank {
        let log = read(&table);
        assert!(log.temperature.is_none());
        let column = log.columns.last().unwrap();
        assert_eq!(column.role, Some(Role::Temperature));
        assert!(column.reason.starts_with("left out: "), "{}", column.reason);
        assert!(!warnings(&log).is_empty());
    }
    // A slower channel is whole.
    for every in [2, 3, 10, 300] {
        let log = read(&temperature(|i| {
            if i % every == 0 { warm(i) } else { f64::NAN }
        }));
        assert_eq!(warnings(&log), [""; 0], "{every}");
        assert!(off(&log) < 1.0);
    }
}

#[test]
fn a_load_may_jump() {
    let loads: [fn(usize) -> f64; 7] = [
        |i| 500.0 + 400.0 * (i as f64 / 50.0).sin(),
        |i| if i / 500 % 2 == 0 { 500.0 } else { 0.0 },
        |i| if i % 40 < 3 { 500.0 } else { 0.0 },
        |i| if i % 40 < 3 { 0.0 } else { 500.0 },
        |i| if i < 2000 { 100.0 } else { 900.0 },
        |i| 100.0 * (i / 800) as f64,
        |i| {
            if (700..1000).contains(&i) {
                0.0
            } else {
                500.0 + noise(i)
            }
        },
    ];
    for (name, at) in loads.into_iter().enumerate() {
        let log = read(&load(at));
        assert!(!codes(&log).contains(&"sensor-dropout"), "{name}");
        let same = log
            .load
            .as_ref()
            .unwrap()
            .iter()
            .enumerate()
            .all(|(i, x)| *x == at(i));
        assert!(same, "{name}");
    }
}

#[test]
fn a_load_that_drops_out_is_bridged() {
    let faults: [Fault; 4] = [
        |i| (i == 700).then_some(0.0),
        |i| (i % 210 == 7).then_some(-999.0),
        |i| (700..730).contains(&i).then_some(-999.0),
        |i| (i % 3 == 0).then_some(0.0),
    ];
    for (name, fault) in faults.into_iter().enumerate() {
        let true_load = |i: usize| 500.0 + 40.0 * (i as f64 / 300.0).sin() + 0.2 * noise(i);
        let log = read(&load(|i| fault(i).unwrap_or_else(|| true_load(i))));
        assert_eq!(warnings(&log).len(), 1, "{name}");
        let off = log.load.as_ref().unwrap().iter().enumerate();
        let off = off.fold(0.0_f64, |most, (i, x)| most.max((x - true_load(i)).abs()));
        assert!(off < 3.0, "{name}: off by {off} N");
        assert!(log.excluded.is_empty());
    }
}

#[test]
fn a_pause_in_the_record_is_no_dropout() {
    let mut table = temperature(|i| if i < 2000 { 25.0 } else { 55.0 } + 0.1 * noise(i));
    for t in &mut table.columns[0].values[2000..] {
        *t += 600.0;
    }
    assert!(!codes(&read(&table)).contains(&"sensor-dropout"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Temperatures that drift and swing with noise, in any steps, renewed now and then.
    #[test]
    fn a_temperature_that_works_is_left_alone(
        from in -20.0..90.0_f64,
        drift in -60.0..60.0_f64,
        swing in 0.0..5.0_f64,
        noisy in 0.0..1.5_f64,
        step in prop::sample::select(vec![0.0, 0.1, 0.5, 1.0, 2.0]),
        every in prop::sample::select(vec![1_usize, 10, 100, 300]),
        blank: bool,
        seed in 0..999_usize,
    ) {
        let at = |i: usize| {
            let own = i / every * every;
            if blank && own != i {
                return f64::NAN;
            }
            let turn = own as f64 / ROWS as f64;
            let x = from + drift * turn + swing * (9.0 * turn).sin() + noisy * noise(seed * 5000 + own);
            if step > 0.0 { step * (x / step).round() } else { x }
        };
        // Renewed seldom, a steep drift or swing steps by more than a part of a machine does in a row.
        let slope = drift.abs() + 9.0 * swing;
        prop_assume!(slope * every as f64 / (ROWS as f64) + 2.0 * noisy < 2.5 || every == 1);
        let log = read(&temperature(at));
        prop_assert!(!codes(&log).contains(&"sensor-dropout"), "{}", message(&log, "sensor-dropout"));
        prop_assert!(log.temperature.is_some());
    }
}
