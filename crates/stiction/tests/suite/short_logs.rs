//! What is said of logs that are too short to tell much.

use crate::common::identified::identified;
use stiction::{Axis, Options};
use stiction_testkit::worlds::{Machine, Motion, Recording, World, record};

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
            for from in [0.5, 1.1, 2.25, 2.6, 4.5, 5.6, 7.0] {
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
