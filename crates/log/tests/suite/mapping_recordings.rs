//! The measured recordings, read with mappings written by hand: what is known of them must come out.

use crate::mapping_common::{codes, told, warnings};
use std::path::Path;
use stiction_formats::{Kind, ReadOptions, Table, Unit, Value, read_table};
use stiction_log::{Channel, Log, Mapping, Motion, Wrap};
use stiction_testkit::recordings;

fn table(folder: &Path, file: &str) -> Table {
    read_table(&folder.join(file), &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn unit(text: &str) -> Unit {
    Unit::parse(text).unwrap()
}

fn log(table: &Table, mapping: &Mapping) -> Log {
    Log::from_table(table, mapping).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn emps_force_is_the_voltage_times_its_gain() {
    let Some(folder) = recordings() else { return };
    let table = table(&folder, "emps/DATA_EMPS.mat");
    let gain = table
        .scalars
        .iter()
        .find(|s| s.name == "gtau")
        .unwrap()
        .value;
    let mapping = Mapping {
        motion: Some(Motion::Linear),
        time: Some(Channel::named("t")),
        position: Some(Channel::named("qm").unit(unit("m"))),
        reference: Some(Channel::named("qg")),
        force: Some(
            Channel::named("vir")
                .unit(unit("V"))
                .scale(Value::parse("35.15065188 N/V").unwrap()),
        ),
        ..Mapping::default()
    };
    let log = log(&table, &mapping);
    eprintln!("{}", told(&log));
    let vir = &table
        .columns
        .iter()
        .find(|c| c.name == "vir")
        .unwrap()
        .values;
    for (force, volt) in log.force.as_ref().unwrap().iter().zip(vir) {
        assert!((force - gain * volt).abs() <= 1e-8 * force.abs());
    }
    assert_eq!(log.force_unit, "N");
    // Its time stamps are those of a nominal 1 kHz, 16 ppm fast.
    assert!((log.rate_hz - 1000.0).abs() < 0.02);
    assert_eq!(log.time.len(), vir.len());
    assert!((log.time.last().unwrap() - 24.84).abs() < 0.01);
    assert!(log.gaps.is_empty());
    // Encoder of 5e-8 m as its makers say.
    assert!(
        (log.quantum.unwrap() / 5e-8 - 1.0).abs() < 1e-3,
        "{:?}",
        log.quantum
    );
    assert!(
        warnings(&log).iter().all(|code| *code == "saturation"),
        "{}",
        told(&log)
    );
}

#[test]
fn tribometer_has_179_single_gaps_and_a_friction_force() {
    let Some(folder) = recordings() else { return };
    let table = table(&folder, "tribometer/presliding.tsv");
    let detected = log(&table, &Mapping::default());
    eprintln!("{}", told(&detected));
    assert_eq!(detected.motion, Motion::Linear);
    assert_eq!(detected.gaps.len(), 179);
    assert!(detected.gaps.iter().all(|g| g.missing_samples == 1));
    assert_eq!(detected.segments.len(), 1);
    assert_eq!(detected.rate_hz, 200.0);
    // Friction opposes motion: its sign is questioned, and turned round it is not.
    assert!(codes(&detected).contains(&"force-sign"));
    let mapping = Mapping {
        force: Some(Channel::named("Friction").inverted()),
        crop: Some((10.0, 208.0)),
        ..Mapping::default()
    };
    let log = log(&table, &mapping);
    eprintln!("{}", told(&log));
    assert!(!codes(&log).contains(&"force-sign"));
    assert!((10.0..10.005).contains(&log.start));
    let end = log.start + log.time.last().unwrap();
    assert!((207.995..=208.0).contains(&end), "{end}");
    let x = log.position.as_ref().unwrap();
    let low = x.iter().copied().fold(f64::INFINITY, f64::min);
    let high = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    assert!(
        (110e-6..120e-6).contains(&(0.5 * (high - low))),
        "{low} {high}"
    );
}

#[test]
fn servo_logs_have_neither_names_nor_time() {
    let Some(folder) = recordings() else { return };
    let mapping = Mapping {
        rate_hz: Some(1000.0),
        position: Some(Channel::index(1).unit(unit("rad"))),
        velocity: Some(Channel::index(2).unit(unit("rad/s"))),
        force: Some(Channel::index(5).unit(unit("N*m"))),
        ..Mapping::default()
    };
    for (kind, count, seconds) in [
        ("sliding", 7, 12.0),
        ("presliding", 5, 8.0),
        ("breakaway", 5, 3.0),
    ] {
        for run in 1..=count {
            let table = table(&folder, &format!("servo/{kind}_{run}.txt"));
            let error = Log::from_table(&table, &Mapping::default()).unwrap_err();
            assert_eq!(error.kind, Kind::Missing);
            let log = log(&table, &mapping);
            eprintln!("{kind} {run}:\n{}", told(&log));
            assert_eq!((log.motion, log.rate_hz), (Motion::Rotary, 1000.0));
            assert!((log.time.last().unwrap() - seconds).abs() < 0.01);
            if kind == "sliding" {
                assert!((log.quantum.unwrap() / 6.2832e-4 - 1.0).abs() < 1e-3);
            }
            // Between steps of 24 counts this one has a single step of 134, after which it goes on as before.
            let lost = (kind, run) == ("sliding", 1);
            if kind == "sliding" {
                let expected: &[&str] = if lost { &["position-jump"] } else { &[] };
                assert_eq!(warnings(&log), expected);
                assert_eq!(log.segments.len(), 1 + usize::from(lost));
            }
            let faults = [
                "stuck-encoder",
                "saturation",
                "position-jump",
                "force-sign",
                "velocity-mismatch",
                "no-motion",
            ];
            assert!(
                faults
                    .iter()
                    .all(|f| !codes(&log).contains(f) || (lost && *f == "position-jump")),
                "{}",
                told(&log)
            );
        }
    }
}

#[test]
fn ur10e_by_number_with_its_short_and_long_steps() {
    let Some(folder) = recordings() else { return };
    for joint in [1, 4] {
        let table = table(&folder, &format!("ur10e/joint_{joint}.csv"));
        let mapping = Mapping {
            time: Some(Channel::index(1).unit(unit("s"))),
            position: Some(Channel::index(1 + joint).unit(unit("rad"))),
            velocity: Some(Channel::index(7 + joint).unit(unit("rad/s"))),
            force: Some(Channel::index(13 + joint).unit(unit("A"))),
            ..Mapping::default()
        };
        let log = log(&table, &mapping);
        eprintln!("joint {joint}:\n{}", told(&log));
        assert_eq!((log.motion, log.force_unit.as_str()), (Motion::Rotary, "A"));
        // 10 and 12 ms in turn: jitter, not gaps.
        assert!((log.rate_hz - 100.0).abs() < 1e-3);
        assert!(log.gaps.is_empty());
        assert_eq!(warnings(&log), ["jitter"]);
        assert!((log.start - table.columns[0].values[0]).abs() < 1e-9);
    }
}

#[test]
fn damiao_wraps_and_one_motor_misses_five_seconds() {
    let Some(folder) = recordings() else { return };
    for motor in [1, 2] {
        let table = table(&folder, &format!("damiao/motor_{motor}.npz"));
        let open = log(&table, &Mapping::default());
        assert!(
            warnings(&open).contains(&"position-jump"),
            "{}",
            told(&open)
        );
        let mapping = Mapping {
            wrap: Some(Wrap::at(12.5)),
            ..Mapping::default()
        };
        let log = log(&table, &mapping);
        eprintln!("motor {motor}:\n{}", told(&log));
        assert_eq!(
            (log.motion, log.force_unit.as_str()),
            (Motion::Rotary, "N*m")
        );
        assert!((log.rate_hz - 49.0).abs() < 1.0);
        let wraps = log
            .findings
            .iter()
            .find(|f| f.code().as_str() == "position-wrap")
            .unwrap();
        assert!(wraps.to_string().contains("6 times"), "{wraps}");
        let longest = log.gaps.iter().map(|g| g.seconds).fold(0.0, f64::max);
        if motor == 2 {
            assert!((longest - 4.978).abs() < 1e-3);
        } else {
            assert!(longest < 0.1);
        }
        let faults = [
            "stuck-encoder",
            "position-jump",
            "force-sign",
            "velocity-mismatch",
        ];
        assert!(
            faults.iter().all(|f| !codes(&log).contains(f)),
            "{}",
            told(&log)
        );
    }
}
