//! Missing samples that an export wrote as 0 are found; channels that are really 0 are left alone.

use crate::mapping_common::{axis, codes, column, message, noise, table};
use proptest::prelude::*;
use stiction_formats::{Kind, Table};
use stiction_log::{Log, Mapping};

/// Sets every `nth` sample of a column to a value.
fn fill(table: &mut Table, column: usize, nth: usize, value: f64) {
    for x in table.columns[column].values.iter_mut().step_by(nth) {
        *x = value;
    }
}

fn read(table: &Table) -> Log {
    Log::from_table(table, &Mapping::default()).unwrap()
}

#[test]
fn zeros_between_samples_far_from_zero_are_missing() {
    for (name, column) in [("position", 1), ("force", 3)] {
        for (nth, value) in [(2, 0.0), (3, 5e-324), (3, -0.0), (10, 0.0), (50, 1e-20)] {
            let mut table = axis(3000).table();
            fill(&mut table, column, nth, value);
            let mut empty = axis(3000).table();
            fill(&mut empty, column, nth, f64::NAN);
            let (log, expected) = (read(&table), read(&empty));
            assert!(
                message(&log, "zero-filled").starts_with(&format!("{name} is 0")),
                "{name} {nth}"
            );
            // From here on they are empty cells.
            assert_eq!(log.time, expected.time);
            assert_eq!(log.position, expected.position);
            assert_eq!(log.force, expected.force);
            assert_eq!(log.excluded, expected.excluded);
        }
    }
}

#[test]
fn what_is_said_of_them() {
    let mut table = axis(3000).table();
    fill(&mut table, 3, 3, 5e-324);
    fill(&mut table, 1, 10, 0.0);
    let log = read(&table);
    let said: Vec<_> = log
        .findings
        .iter()
        .filter(|f| ["zero-filled", "missing-cells"].contains(&f.code().as_str()))
        .map(|f| format!("{:?} {}: {}", f.severity, f.code(), f))
        .collect();
    insta::assert_snapshot!(said.join("\n"));
}

#[test]
fn more_than_half_is_refused() {
    let mut table = axis(3000).table();
    fill(&mut table, 3, 2, 0.0);
    fill(&mut table, 3, 3, 0.0);
    let error = Log::from_table(&table, &Mapping::default()).unwrap_err();
    assert_eq!(error.kind, Kind::Value);
    insta::assert_snapshot!(error.to_string());
}

/// A relay, a force in pulses, an axis that rests at 0, a coarse drive, dropouts that are few.
#[test]
fn real_zeros_stay() {
    let n = 3000;
    let pulses = |on: usize, off: usize| -> Vec<f64> {
        (0..n)
            .map(|i| if i % (on + off) < on { 5.0 } else { 0.0 })
            .collect()
    };
    let relay = (0..n).map(|i| [7.0, 0.0, -7.0, 0.0][i / 4 % 4]).collect();
    let coarse = (0..n)
        .map(|i| (2.5 + 2.5 * noise(i)).round())
        .collect::<Vec<_>>();
    let spikes = (0..n)
        .map(|i| if i % 40 == 7 { 90.0 } else { 0.1 * noise(i) })
        .collect();
    let few = (0..n)
        .map(|i| {
            if i % 1000 == 7 {
                0.0
            } else {
                9.0 + 0.1 * noise(i)
            }
        })
        .collect();
    for (name, force) in [
        ("pulses", pulses(20, 3)),
        ("spaced pulses", pulses(3, 40)),
        ("relay", relay),
        ("coarse", coarse),
        ("spikes", spikes),
        ("few", few),
    ] {
        let mut table = axis(n).table();
        table.columns[3].values = force;
        assert!(!codes(&read(&table)).contains(&"zero-filled"), "{name}");
    }
    // Counted from encoder pulses: at low speed most periods see none.
    let mut table = axis(n).table();
    let counted = (0..n)
        .map(|i| if i % 4 == 1 { 1e-3 } else { 0.0 })
        .collect();
    table.columns[2].values = counted;
    assert!(!codes(&read(&table)).contains(&"zero-filled"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Any sine with noise on an offset, in any steps, clipped or not, passes through 0 or rests
    /// there without being taken for filled. It rests for half of each turn at most: what leaves a clipped level for two or three
    /// samples, one of them in the step at 0, cannot be told from a level with a sample filled in.
    #[test]
    fn stepped_and_clipped_signals_are_not_filled(
        per_turn in 20.0..2000.0_f64,
        offset in -1.5..1.5_f64,
        noisy in 0.0..0.5_f64,
        step in 0.0..0.6_f64,
        clip in 0.2..2.0_f64,
        rest in 0.0..0.5_f64,
        seed in 0..9999_usize,
    ) {
        let steps = |x: f64| if step > 0.01 { step * (x / step).round() } else { x };
        let signal: Vec<f64> = (0..2000)
            .map(|i| {
                let turn = i as f64 / per_turn;
                let sine = (std::f64::consts::TAU * turn).sin();
                let quiet = if turn.fract() < rest { 0.0 } else { sine };
                let x = offset + quiet + noisy * noise(seed * 10_000 + i);
                steps(x.clamp(-clip, clip))
            })
            .collect();
        let time = (0..2000).map(|i| i as f64 / 1000.0).collect();
        let table = table(vec![
            column("time [s]", time),
            column("position [m]", signal.clone()),
            column("force [N]", signal),
        ]);
        let log = read(&table);
        prop_assert!(!codes(&log).contains(&"zero-filled"), "{}", message(&log, "zero-filled"));
    }
}
