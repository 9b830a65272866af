//! Every measured recording reads as it lies there: columns, samples, and what is known of it.
//!
//! The facts are those of the README beside the recordings, and counts that NumPy and SciPy gave.

use std::path::PathBuf;

use stiction_formats::{ReadOptions, Table, read_table};
use stiction_testkit::recordings;

fn table(file: PathBuf) -> Table {
    read_table(&file, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Names, and that every column has this many finite samples.
fn columns(table: &Table, names: &[&str], samples: usize) {
    let found: Vec<&str> = table.columns.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(found, names);
    for column in &table.columns {
        assert_eq!(column.values.len(), samples, "{}", column.name);
        assert!(
            column.values.iter().all(|x| x.is_finite()),
            "{}",
            column.name
        );
    }
}

fn steps(time: &[f64]) -> Vec<f64> {
    time.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn span(values: &[f64]) -> (f64, f64) {
    let fold = |(low, high): (f64, f64), &x: &f64| (low.min(x), high.max(x));
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), fold)
}

/// Largest distance to a whole number of encoder steps, in steps.
fn off_grid(values: &[f64], step: f64) -> f64 {
    let off = |x: &f64| (x / step - (x / step).round()).abs();
    values.iter().map(off).fold(0.0, f64::max)
}

#[test]
fn emps() {
    let Some(folder) = recordings() else { return };
    let table = table(folder.join("emps/DATA_EMPS.mat"));
    columns(&table, &["qg", "qm", "t", "vir"], 24_841);
    let scalars: Vec<(&str, f64)> = table
        .scalars
        .iter()
        .map(|s| (s.name.as_str(), (s.value * 1e4).round() / 1e4))
        .collect();
    assert_eq!(scalars, [("gtau", 35.1507), ("kp", 160.18), ("kv", 243.45)]);
    let [qg, qm, t, vir] = &table.columns[..] else {
        panic!("four columns");
    };
    assert_eq!(t.values.last().copied(), Some(24.84));
    assert!((median(steps(&t.values)) - 1e-3).abs() < 1e-7);
    assert!(off_grid(&qm.values, 5e-8) < 1e-6);
    let follows = |(q, r): (&f64, &f64)| (q - r).abs() < 1e-3;
    assert!(qm.values.iter().zip(&qg.values).all(follows));
    let (low, high) = span(&vir.values);
    assert!(-10.0 < low && high < 10.0, "the controller never saturates");
    assert_eq!(table.detected, ["MATLAB version 5"]);
    assert!(table.skipped.is_empty());
}

#[test]
fn damiao() {
    let Some(folder) = recordings() else { return };
    let names = [
        "time",
        "motor_id",
        "position",
        "velocity",
        "torque_feedback",
        "command_raw",
        "command",
        "position_cmd",
        "velocity_cmd",
        "acceleration_cmd",
        "state",
        "mos_temperature",
        "id_match_ok",
    ];
    for (motor, samples, gap) in [(1, 4218, 0.061), (2, 3538, 4.978)] {
        let table = table(folder.join(format!("damiao/motor_{motor}.npz")));
        columns(&table, &names, samples);
        assert_eq!(table.skipped, ["phase_name: text", "metadata: text"]);
        let steps = steps(&table.columns[0].values);
        assert!((1.0 / median(steps.clone()) - 48.9).abs() < 0.1);
        assert!((span(&steps).1 - gap).abs() < 1e-3);
        let id = f64::from(motor);
        assert!(table.columns[1].values.iter().all(|&x| x == id));
        let (low, high) = span(&table.columns[2].values);
        assert!(-12.5 < low && high < 12.5, "the position wraps at 12.5 rad");
        assert!(table.columns[12].values.iter().all(|&x| x == 1.0), "a flag");
    }
}

#[test]
fn tribometer() {
    let Some(folder) = recordings() else { return };
    let table = table(folder.join("tribometer/presliding.tsv"));
    columns(&table, &["Time", "Normal", "Position", "Friction"], 42_579);
    let units: Vec<Option<&str>> = table.columns.iter().map(|c| c.unit.as_deref()).collect();
    assert_eq!(units, [Some("s"), Some("uN"), Some("mm"), Some("uN")]);
    let time = &table.columns[0].values;
    let steps = steps(time);
    assert!((median(steps.clone()) - 1.0 / 200.0).abs() < 1e-9);
    assert_eq!(
        steps.iter().filter(|&&step| step > 1.5 / 200.0).count(),
        179
    );
    assert!((span(time).1 - 213.784).abs() < 1e-9);
    let normal = &table.columns[1].values;
    let mean = normal.iter().sum::<f64>() / normal.len() as f64;
    assert!((mean / 5e6 - 1.0).abs() < 0.05, "5 N, but for the approach");
}

#[test]
fn servo() {
    let Some(folder) = recordings() else { return };
    for (kind, runs, samples, torque) in [
        ("sliding", 7, 12_000, (-0.05, 0.05)),
        ("presliding", 5, 8_000, (-0.012, 0.012)),
        ("breakaway", 5, 3_000, (0.0, 0.049967)),
    ] {
        for run in 1..=runs {
            let table = table(folder.join(format!("servo/{kind}_{run}.txt")));
            columns(&table, &[""; 5], samples);
            assert!(table.columns.iter().all(|c| c.unit.is_none()));
            assert_eq!(span(&table.columns[4].values), torque, "{kind} {run}");
            if kind == "presliding" {
                let position = &table.columns[0].values;
                assert!(off_grid(position, 6.2832e-4) < 1e-3);
                let (low, high) = span(position);
                let counts = (high - low) / 6.2832e-4;
                assert!(
                    (counts.round() - 6.0).abs() <= 2.0,
                    "about 3 counts each way: {counts}"
                );
            }
        }
    }
}

#[test]
fn ur10e() {
    let Some(folder) = recordings() else { return };
    for (joint, samples, seconds) in [(1, 5889, 62.908), (4, 6288, 67.154)] {
        let table = table(folder.join(format!("ur10e/joint_{joint}.csv")));
        columns(&table, &[""; 31], samples);
        let time = &table.columns[0].values;
        assert!((time[samples - 1] - time[0] - seconds).abs() < 1e-9);
        let steps = steps(time);
        assert!((median(steps.clone()) - 0.01).abs() < 1e-9);
        assert!((span(&steps).1 - 0.012).abs() < 1e-9);
        for other in 1..=6 {
            let (low, high) = span(&table.columns[other].values);
            assert_eq!(high - low > 1.0, other == joint, "only joint {joint} moves");
        }
    }
}

#[test]
fn xl330() {
    let Some(folder) = recordings() else { return };
    for (file, samples) in [("sin_sin", 1116), ("up_and_down", 1120)] {
        let table = table(folder.join(format!("xl330/{file}.json")));
        let names = [
            "position",
            "speed",
            "load",
            "input_volts",
            "temp",
            "timestamp",
            "goal_position",
            "torque_enable",
        ]
        .map(|name| format!("entries.{name}"));
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        columns(&table, &names, samples);
        let scalars: Vec<(&str, f64)> = table
            .scalars
            .iter()
            .map(|s| (s.name.as_str(), s.value))
            .collect();
        assert_eq!(
            scalars,
            [("mass", 0.49), ("length", 0.1), ("kp", 200.0), ("vin", 7.4)]
        );
        // 4096 counts a turn.
        let step = std::f64::consts::TAU / 4096.0;
        assert!(off_grid(&table.columns[0].values, step) < 1e-6);
    }
}

/// The bits of all samples, rotated by their index and added: what `python/sum_db3.py` has of rosbags.
fn sum(values: &[f64]) -> u64 {
    let turned = (0..)
        .zip(values)
        .map(|(at, x)| x.to_bits().rotate_left(at % 64));
    turned.fold(0, u64::wrapping_add)
}

/// The stamps and each joint's position, velocity and effort, bit for bit as rosbags reads them.
fn arm<const N: usize>(robot: &str, samples: usize, stamps: u64, joints: [(&str, [u64; 3]); N]) {
    let Some(folder) = recordings() else { return };
    let table = table(folder.join(format!("robots/ur10_panda/{robot}.db3")));
    let signals = |(joint, sums): (&str, [u64; 3])| {
        let names = ["position", "velocity", "effort"];
        let names = names.map(|signal| format!("joint_states.{joint}.{signal}"));
        names.into_iter().zip(sums).collect::<Vec<_>>()
    };
    let mut expected = vec![("joint_states.header.stamp".to_owned(), stamps)];
    expected.extend(joints.into_iter().flat_map(signals));
    let names: Vec<&str> = expected.iter().map(|(name, _)| name.as_str()).collect();
    columns(&table, &names, samples);
    for (column, (name, expected)) in table.columns.iter().zip(&expected) {
        assert_eq!(sum(&column.values), *expected, "{name}");
    }
}

#[test]
fn ur10() {
    arm(
        "ur10",
        3441,
        0x1d151df914f28d79,
        [
            (
                "shoulder_pan_joint",
                [0x89a2c96f5b1ff042, 0x3b162ffcc710252f, 0x7c2c9841ed0122a7],
            ),
            (
                "shoulder_lift_joint",
                [0xbf8a39c79f83e729, 0xd46a84d1f9bb4554, 0x263c95731ce59e3c],
            ),
            (
                "elbow_joint",
                [0x6ad978de9fcf3ed9, 0x4f1f73218e572070, 0x88a94516033a66d6],
            ),
            (
                "wrist_1_joint",
                [0xc6eafaa8668cdee8, 0x978491db7c87694a, 0x91253e7ade073161],
            ),
            (
                "wrist_2_joint",
                [0x8a1b12eb3718a3aa, 0xb0338f915b82f8b7, 0x521dd995b73ccd27],
            ),
            (
                "wrist_3_joint",
                [0x3d67673503a8069f, 0xee97e24a619ffa2b, 0xab8d75fbd23b2204],
            ),
        ],
    );
}

#[test]
fn panda() {
    arm(
        "panda",
        727,
        0xa52c8f0fce462aaa,
        [
            (
                "fer_joint1",
                [0x08137a9adb366b56, 0x5cc321e48afd60ff, 0xea805cf739830180],
            ),
            (
                "fer_joint2",
                [0xbf2563b511eee2a8, 0xdd5eb1cba06f65be, 0x35b3bec14aae030b],
            ),
            (
                "fer_joint3",
                [0x5f8c903c985b798b, 0x2d09114d0e728eaa, 0x14f53c5ee82c8b26],
            ),
            (
                "fer_joint4",
                [0x1cd54d84094b34a6, 0x1f4407b682130f38, 0xe84ba7d56605b100],
            ),
            (
                "fer_joint5",
                [0x039cfe8a49289423, 0x6344e0ac1c3cb8ea, 0x8fe19a81ec2920e3],
            ),
            (
                "fer_joint6",
                [0xacbfb90003ab0fe3, 0x599c07310c29f269, 0x74230d25295b09b5],
            ),
            (
                "fer_joint7",
                [0x5564aec94cf33afe, 0xd3236282e9690b98, 0xbafc7cd89ed48ee4],
            ),
        ],
    );
}
