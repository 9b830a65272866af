//! A column of another file, joined by time stamps.

use crate::mapping_common::{axis, column, message, table};
use proptest::prelude::*;
use stiction_formats::{Error, Table};
use stiction_log::{Channel, Elsewhere, Joined, Log, Mapping, Offset, Role};

/// The clean axis without its force, at 1 kHz from 100 s on.
fn log() -> Table {
    let mut table = axis(4000).table();
    table.columns.pop();
    table.columns[0].values.iter_mut().for_each(|t| *t += 100.0);
    table
}

/// A force that is a straight line of time, at these times on the clock of the log.
fn other(times: impl Iterator<Item = f64>) -> Table {
    let times: Vec<f64> = times.collect();
    let force = times.iter().map(|t| line(*t)).collect();
    table(vec![column("stamp [s]", times), column("x [N]", force)])
}

fn line(t: f64) -> f64 {
    3.0 * (t - 102.0)
}

fn from(role: Role) -> Elsewhere {
    Elsewhere {
        role,
        time: None,
        offset: Offset::Given(0.0),
    }
}

fn joined(log: Table, other: &Table, from: &Elsewhere) -> Result<Log, Error> {
    let mapping = match from.role {
        Role::Temperature => Mapping {
            temperature: Some(Channel::named("x")),
            ..Mapping::default()
        },
        _ => Mapping {
            force: Some(Channel::named("x")),
            ..Mapping::default()
        },
    };
    let mut joined = Joined::new(log, &mapping);
    joined.join("tau.csv", other, from)?;
    Log::from_joined(&joined)
}

/// Whether every force is what it was at its time, at the ends of the other file to within the 1e-4 of its step that are left to the
/// rounding of stamps.
fn is_true(log: &Log, step: f64) -> bool {
    let of_rounding = 1e-4 * (line(step) - line(0.0));
    let mut force = log.time.iter().zip(log.force.as_ref().unwrap());
    force.all(|(t, f)| (f - line(log.start + t)).abs() < 1e-9 + of_rounding)
}

#[test]
fn what_lies_outside_one_of_the_files_is_cut() {
    // Twice as fast, from 0.5 s before the log to 1 s before its end, with a gap of 0.2 s.
    let times = (0..7000).map(|i| 99.5 + 5e-4 * f64::from(i));
    let times = times.filter(|t| !(101.2..101.4).contains(t));
    let log = joined(log(), &other(times), &from(Role::Force)).unwrap();
    assert_eq!(log.segments.len(), 2);
    assert_eq!(log.segments[0], 0..1200);
    assert!((log.start - 100.0).abs() < 1e-9);
    assert!((log.time.last().unwrap() - 3.0).abs() < 2e-3);
    assert!(is_true(&log, 5e-4));
    insta::assert_snapshot!(message(&log, "joined"));
}

/// Of a force from another file, by stamps as they are, that brakes, the clock is doubted before the sign.
#[test]
fn a_force_of_another_clock_that_brakes_is_told_its_offset() {
    let whole = axis(4000).table();
    let at = |name: &str| {
        let mut columns = whole.columns.iter();
        columns.find(|c| c.name == name).unwrap().values.clone()
    };
    let stamps: Vec<f64> = at("time").iter().map(|t| t + 100.0).collect();
    let against = at("force").iter().map(|f| -f).collect();
    let other = table(vec![column("stamp [s]", stamps), column("x [N]", against)]);
    let sign = |offset: f64| {
        let from = Elsewhere {
            offset: Offset::Given(offset),
            ..from(Role::Force)
        };
        message(&joined(log(), &other, &from).unwrap(), "force-sign").to_owned()
    };
    insta::assert_snapshot!(sign(0.0));
    assert!(!sign(1e-4).contains("estimate"));
}

#[test]
fn a_slower_force_keeps_the_rows_beside_its_samples() {
    let times = (0..400).map(|i| 100.0042 + 0.01 * f64::from(i));
    let log = joined(log(), &other(times), &from(Role::Force)).unwrap();
    assert_eq!(log.rate_hz, 100.0);
    assert_eq!(log.segments.len(), 1);
    assert!(is_true(&log, 0.01));
    insta::assert_snapshot!(message(&log, "joined"));
}

#[test]
fn a_temperature_is_not_what_thins_a_log() {
    let times = (0..9).map(|i| 100.0 + 0.5 * f64::from(i));
    let mut other = other(times);
    other.columns[1].unit = Some("degC".into());
    let mut log = log();
    log.columns.push(column("force [N]", axis(4000).force));
    let log = joined(log, &other, &from(Role::Temperature)).unwrap();
    assert_eq!((log.rate_hz, log.time.len()), (1000.0, 4000));
    let warm = log.temperature.unwrap();
    assert!((warm[1250] - (273.15 + line(101.25))).abs() < 1e-9);
}

#[test]
fn an_offset_is_added_to_the_other_clock() {
    let late = other((0..4000).map(|i| 0.001 * f64::from(i)));
    let from = Elsewhere {
        offset: Offset::Given(100.25),
        ..from(Role::Force)
    };
    let log = joined(log(), &late, &from).unwrap();
    assert!((log.start - 100.25).abs() < 1e-9);
    let force = log.force.as_ref().unwrap();
    assert!((force[0] - line(0.0)).abs() < 1e-6, "{}", force[0]);
    insta::assert_snapshot!(message(&log, "joined"));
}

#[test]
fn what_is_refused() {
    let refused = |other: &Table, log: Table| {
        let error = joined(log, other, &from(Role::Force)).unwrap_err();
        format!("{error} <- {}", error.setting().unwrap_or("no key"))
    };
    let apart = other((0..4000).map(|i| 0.001 * f64::from(i)));
    let back = other((0..4000).map(|i| 100.0 + 0.001 * f64::from(i % 3000)));
    let mut nameless = other((0..4000).map(|i| 100.0 + 0.001 * f64::from(i)));
    nameless.columns[0].name = "n".into();
    nameless.columns[0].unit = None;
    let mut without = other((0..4000).map(|i| 100.0 + 0.001 * f64::from(i)));
    without.columns[1].name = "y".into();
    let mut no_time = log();
    no_time.columns.remove(0);
    let good = other((0..4000).map(|i| 100.0 + 0.001 * f64::from(i)));
    let lines = [
        refused(&apart, log()),
        refused(&back, log()),
        refused(&nameless, log()),
        refused(&without, log()),
        refused(&other(std::iter::once(100.0)), log()),
        refused(&good, no_time),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// At any rate, with any gaps, every force that is kept is the true one, and none lies in a gap.
    #[test]
    fn nothing_is_made_up(
        step in 2e-4_f64..8e-3,
        start in 99.0_f64..101.0,
        gaps in prop::collection::vec((100.2_f64..103.5, 0.05_f64..0.3), 0..3),
    ) {
        let within = |t: f64| gaps.iter().any(|(from, long)| (*from..from + long).contains(&t));
        let times = (0..).map(|i| start + step * f64::from(i)).take_while(|t| *t < 104.5);
        let times: Vec<f64> = times.filter(|t| !within(*t)).collect();
        let log = joined(log(), &other(times.iter().copied()), &from(Role::Force)).unwrap();
        prop_assert!(is_true(&log, step));
        for t in &log.time {
            let now = log.start + t;
            let nearest = times.iter().map(|s| (s - now).abs()).fold(f64::INFINITY, f64::min);
            prop_assert!(nearest <= 0.75 * step + 1e-9, "{now} is {nearest} s from any sample");
        }
    }
}
