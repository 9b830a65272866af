//! The offset between the clocks of two files, estimated on simulated axes on which it is known.

use crate::mapping_common::{column, message, noise, table};
use proptest::prelude::*;
use stiction_formats::{Error, Kind, Table};
use stiction_log::{Channel, Elsewhere, Found, Joined, Log, Mapping, Offset, Role};
use stiction_testkit::worlds::{Machine, Motion, Recording, World, record};

/// The clock of the other file is behind by this, s.
const BEHIND: f64 = 1_700_000_000.123_4;

/// Rows of the other file: every so many, from one row on, with noise of a part of the size of the force.
#[derive(Clone, Copy)]
struct Kept {
    every: usize,
    from: usize,
    noise: f64,
}

fn wave(machine: &Machine, motion: Motion) -> Recording {
    record(machine, motion, World::Faithful, 1)
}

/// The motion of a recording, and its force on another clock.
fn apart(log: &Recording, kept: Kept) -> [Table; 2] {
    let size = log.force.iter().map(|f| f.abs()).fold(0.0, f64::max);
    let rows = (kept.from..log.force.len()).step_by(kept.every);
    let time = rows.clone().map(|row| log.time[row] - BEHIND).collect();
    let force = rows.map(|row| log.force[row] + kept.noise * size * noise(row));
    let position = log.position.clone().unwrap();
    [
        table(vec![
            column("time [s]", log.time.clone()),
            column("position [m]", position),
        ]),
        table(vec![
            column("stamp [s]", time),
            column("F [N]", force.collect()),
        ]),
    ]
}

fn joined(log: &Table, other: &Table, role: Role, offset: Offset) -> Result<Log, Error> {
    let mut mapping = Mapping::default();
    match role {
        Role::Force => mapping.force = Some(Channel::named("F")),
        Role::Position => mapping.position = Some(Channel::named("position")),
        _ => mapping.temperature = Some(Channel::named("oil")),
    }
    let from = Elsewhere {
        role,
        time: None,
        offset,
    };
    let mut joined = Joined::new(log.clone(), &mapping);
    joined.join("tau.csv", other, &from)?;
    Log::from_joined(&joined)
}

fn estimated(log: &Table, other: &Table, role: Role) -> Result<Log, Error> {
    joined(log, other, role, Offset::Estimated)
}

/// The offset that was found, and how far it may be off by what is said, s.
fn said(log: &Log) -> (f64, f64) {
    let mut found = log.findings.iter().map(|finding| &finding.kind);
    let offset = found.find_map(|found| match found {
        Found::Offset {
            seconds,
            half_width,
            ..
        } => Some((seconds.parse().unwrap(), *half_width)),
        _ => None,
    });
    offset.unwrap()
}

#[test]
fn a_force_goes_with_the_motion_that_it_drives() {
    let every = |every, from, noise| Kept { every, from, noise };
    for (machine, kept) in [
        (Machine::screw(1), every(1, 700, 0.2)),
        (Machine::screw(2), every(3, 1500, 0.05)),
        (Machine::screw(3), every(10, 0, 0.0)),
        (Machine::joint(1), every(10, 300, 0.1)),
    ] {
        let recording = wave(&machine, Motion::Commissioning);
        let [mut log, other] = apart(&recording, kept);
        if machine.kind == "rotary" {
            log.columns[1].unit = Some("rad".into());
        }
        let found = estimated(&log, &other, Role::Force).unwrap();
        let (seconds, within) = said(&found);
        let rows = 4.0 * kept.every.max(1) as f64 / machine.rate;
        assert!((seconds - BEHIND).abs() <= within, "{seconds} +- {within}");
        assert!(within <= rows, "{within} of {rows}");
        // Written down it gives the same log.
        let given = joined(&log, &other, Role::Force, Offset::Given(seconds)).unwrap();
        assert_eq!((given.time, given.force), (found.time, found.force));
    }
}

#[test]
fn a_motion_goes_with_the_force_of_the_log() {
    let kept = Kept {
        every: 1,
        from: 0,
        noise: 0.05,
    };
    let [motion, mut force] = apart(&wave(&Machine::screw(1), Motion::Commissioning), kept);
    force.columns[1].name = "force".into();
    let log = estimated(&force, &motion, Role::Position).unwrap();
    let (seconds, within) = said(&log);
    assert!((seconds + BEHIND).abs() <= within, "{seconds} +- {within}");
    insta::assert_snapshot!(message(&log, "offset-estimated"));
}

#[test]
fn the_same_position_in_both_files_tells_it_best() {
    let recording = wave(&Machine::stage(1), Motion::Commissioning);
    let kept = Kept {
        every: 4,
        from: 900,
        noise: 0.0,
    };
    let [log, mut other] = apart(&recording, kept);
    let position = recording.position.as_ref().unwrap();
    let position = position.iter().skip(900).step_by(4);
    // In another unit, and from another zero.
    let position = position.map(|x| 1e3 * x + 7.0).collect();
    other.columns.push(column("act pos [mm]", position));
    let log = estimated(&log, &other, Role::Force).unwrap();
    let (seconds, within) = said(&log);
    assert!(within <= 6e-4, "{within}");
    assert!((seconds - BEHIND).abs() <= within, "{seconds}");
    insta::assert_snapshot!(message(&log, "offset-estimated"));
}

#[test]
fn what_cannot_be_told_is_refused_with_the_line_to_write() {
    let kept = Kept {
        every: 1,
        from: 0,
        noise: 0.0,
    };
    let screw = Machine::screw(1);
    let [log, other] = apart(&wave(&screw, Motion::Commissioning), kept);
    let mut noisy = other.clone();
    noisy.columns[1]
        .values
        .iter_mut()
        .enumerate()
        .for_each(|(row, f)| *f = noise(row));
    let mut still = other.clone();
    still.columns[1].values.fill(3.0);
    let mut short = other.clone();
    short.columns.iter_mut().for_each(|c| c.values.truncate(80));
    // Two samples that are a second apart go with anything.
    let mut two = other.clone();
    let rows = [0, two.rows() - 1];
    two.columns
        .iter_mut()
        .for_each(|c| c.values = rows.map(|row| c.values[row]).to_vec());
    let mut oil = other.clone();
    oil.columns[1] = column("oil [degC]", vec![30.0; other.rows()]);
    let repeats = |motion| apart(&wave(&screw, motion), kept);
    let fast = apart(&wave(&Machine::stage(1), Motion::Commissioning), kept);
    let mut refused = Vec::new();
    for ([log, other], role) in [
        (repeats(Motion::Sine), Role::Force),
        (repeats(Motion::Trapezoid), Role::Force),
        (fast, Role::Force),
        ([log.clone(), noisy], Role::Force),
        ([log.clone(), still], Role::Force),
        ([log.clone(), short], Role::Force),
        ([log.clone(), two], Role::Force),
        ([log, oil], Role::Temperature),
    ] {
        let error = estimated(&log, &other, role).unwrap_err();
        refused.push(format!(
            "{error} <- {}",
            error.setting().unwrap_or("no key")
        ));
    }
    insta::assert_snapshot!(refused.join("\n\n"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Two encoders on one axis, at any rates, with gaps and noise: the offset is told, or, where the motion happens to do nearly the
    /// same twice, it is one of those that are left to choose.
    #[test]
    fn two_encoders_tell_the_offset(
        steps in (5e-4_f64..4e-3, 5e-4_f64..1e-2),
        parts in (0.0_f64..2.0, 8.0_f64..12.0),
        gap in 3.0_f64..6.0,
        behind in -1e4_f64..1e4,
        seed in 0_usize..1000,
    ) {
        let position = |t: f64| -> f64 {
            let wave = |n: usize| (noise(100 * seed + n) * 3.0, 1.0 + noise(77 * seed + n + 50));
            (0..12).map(wave).map(|(size, speed)| size * (4.0 * speed * t + 9.0 * size).sin()).sum()
        };
        let sampled = |step: f64, from: f64, to: f64| -> Vec<f64> {
            (0..).map(|n| from + step * f64::from(n)).take_while(|t| *t < to).collect()
        };
        let own = sampled(steps.0, 0.0, 10.0);
        let others = sampled(steps.1, parts.0, parts.1).into_iter();
        let others: Vec<f64> = others.filter(|t| !(gap..gap + 0.5).contains(t)).collect();
        let counted = |t: &f64, n: usize| position(*t) + 2e-3 * noise(n);
        let at = |times: &[f64]| times.iter().enumerate().map(|(n, t)| counted(t, n)).collect();
        let log = table(vec![column("time [s]", own.clone()), column("position [mm]", at(&own))]);
        let times = others.iter().map(|t| t - behind).collect();
        let force = others.iter().map(|t| t.sin()).collect();
        let other = table(vec![
            column("time [s]", times),
            column("position [mm]", at(&others)),
            column("F [N]", force),
        ]);
        match estimated(&log, &other, Role::Force) {
            Ok(log) => {
                let (seconds, within) = said(&log);
                prop_assert!((seconds - behind).abs() <= 1.5 * within, "{} +- {}", seconds - behind, within);
            }
            Err(error) => {
                prop_assert_eq!(error.kind, Kind::Ambiguous);
                let choices = error.allowed.split("offset = \"").skip(1);
                let mut choices = choices.map(|rest| rest.split(' ').next().unwrap().parse::<f64>().unwrap());
                prop_assert!(choices.any(|seconds| (seconds - behind).abs() <= 1.5 * steps.0.max(steps.1)), "{}", error);
            }
        }
    }
}
