//! What is said of logs that are too short to tell much.

use crate::common::identified::{identified, identify};
use crate::common::noise;
use std::f64::consts::TAU;
use stiction_files::Axis;
use stiction_log::Column;
use stiction_testkit::gate;
use stiction_testkit::worlds::{Machine, Motion, Recording, World, record};
use stiction_workflows::identify::Options;
use stiction_workflows::source::{Source, in_memory};

/// The rows of a log from `from` s on, of that many seconds.
fn cut(log: &Recording, rate: f64, from: f64, seconds: f64) -> Recording {
    let rows = (from * rate) as usize..((from + seconds) * rate) as usize;
    Recording {
        time: log.time[rows.clone()].to_vec(),
        position: log.position.as_ref().map(|x| x[rows.clone()].to_vec()),
        velocity: None,
        force: log.force[rows].to_vec(),
        beside: Vec::new(),
    }
}

/// Within half a second neither friction nor clocks drift by what a log shows.
#[test]
fn half_a_second_names_nothing_that_takes_time() {
    for (axis, machine) in Machine::all(1) {
        for motion in [Motion::Commissioning, Motion::Trapezoid] {
            let log = record(&machine, motion, World::Faithful, 1);
            for from in gate(2, [1.1, 4.5, 0.5, 2.25, 2.6, 5.6, 7.0]) {
                let part = cut(&log, machine.rate, from, 0.5);
                let fit = identified(&machine, &[part], &Axis::default(), &Options::default());
                // Too little may be seen for any fit.
                let Ok(fit) = fit else { continue };
                let codes = fit.warnings().iter().map(|w| w.code.as_str());
                let named: Vec<&str> = codes
                    .filter(|code| ["clocks-apart", "friction-drift"].contains(code))
                    .collect();
                assert_eq!(named, [""; 0], "{axis}, {motion:?} from {from} s");
            }
        }
    }
}

/// LuGre with 20 N, 1.2e5 N/m, 600 and 60 N s/m under 10 kg, on a sine whose stroke is so many times the travel of the bristles from
/// one side to the other.
fn sine_of(ways: f64) -> Source {
    const FINE: usize = 100;
    let (rate, frequency, seconds) = (4000.0, 12.0, 2.0);
    let (stiffness, level, damping) = (1.2e5, 20.0, 600.0);
    let amplitude = 0.5 * ways * 2.0 * level / stiffness;
    let omega = TAU * frequency;
    let mut z = 0.0_f64;
    let rows = (seconds * rate) as usize;
    let (mut time, mut position, mut force) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..rows {
        let t = k as f64 / rate;
        let motion = |t: f64| {
            let (s, c) = (omega * t).sin_cos();
            [
                -amplitude * c,
                amplitude * omega * s,
                amplitude * omega * omega * c,
            ]
        };
        let [x, v, a] = motion(t);
        let slip = v - stiffness * v.abs() * z / level;
        time.push(t);
        position.push(x);
        force.push(stiffness * z + damping * slip + 60.0 * v + 10.0 * a + 0.3 * noise(9, k));
        for i in 0..FINE {
            let h = 1.0 / (rate * FINE as f64);
            let v = motion(t + (i as f64 + 0.5) * h)[1];
            z += h * (v - stiffness * v.abs() * z / level);
        }
    }
    let column = |name: &str, unit: &str, values: Vec<f64>| Column {
        name: name.into(),
        unit: Some(unit.into()),
        values,
        ..Column::default()
    };
    let columns = vec![
        column("time", "s", time),
        column("position", "m", position),
        column("force", "N", force),
    ];
    in_memory("sine.csv", columns, &Axis::default()).unwrap()
}

/// Where bristles do not come near their level the law says what it is, and another law says another.
#[test]
fn a_level_that_bristles_never_reach_is_open() {
    let claims = |ways: f64| {
        let fit = identify(&[sine_of(ways)], &Axis::default(), &Options::default()).unwrap();
        fit.parameter("coulomb").unwrap().is_identifiable()
    };
    assert!(!claims(1.4));
    assert!(claims(6.0));
}
