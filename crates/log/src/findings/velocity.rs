//! Whether velocity and position describe the same motion.

use super::finding::Finding;
use super::ratio::{Sums, fault};
use crate::log::Log;
use stiction_policy::signal;
use stiction_say::Found;

/// Window over which the travel of both is compared, in samples: long enough that noise and delay matter little.
const WINDOW_SAMPLES: usize = 32;

/// Ratios that have a usual cause: derivative of the position over the velocity.
const CAUSES: &[(f64, &str)] = &[
    (1000.0, "position in mm taken as m, or velocity in km/s"),
    (1e-3, "velocity in mm/s taken as m/s"),
    (57.295_779_513, "position in degrees taken as rad"),
    (0.017_453_292_5, "velocity in deg/s taken as rad/s"),
    (0.159_154_943_1, "position in turns taken as rad"),
    (
        std::f64::consts::TAU,
        "velocity in turns a second taken as rad/s",
    ),
    (0.104_719_755_1, "velocity in rpm taken as rad/s"),
    (1.0 / 60.0, "velocity per minute taken as per second"),
    (60.0, "velocity per second taken as per minute"),
];

pub(super) fn consistency(log: &mut Log) {
    let (Some(position), Some(velocity)) = (&log.position, &log.velocity) else {
        return;
    };
    let gap = |sample| log.gap_after(sample);
    let (mut xx, mut vv, mut xv, mut windows) = (0.0, 0.0, 0.0, 0_usize);
    let (mut start, mut x, mut broken) = (0, 0.0, false);
    for i in 1..log.time.len() {
        x += 0.5 * (velocity[i] + velocity[i - 1]) * (log.time[i] - log.time[i - 1]);
        broken |= gap(i - 1) || log.starts_segment(i);
        if i - start == WINDOW_SAMPLES {
            if !broken {
                let moved = position[i] - position[start];
                xx += moved * moved;
                vv += x * x;
                xv += moved * x;
                windows += 1;
            }
            (start, x, broken) = (i, 0.0, false);
        }
    }
    let step = log.quantum.unwrap_or(0.0);
    let rms = (xx / windows.max(1) as f64).sqrt();
    if windows < 3 || xx == 0.0 || vv == 0.0 || rms <= signal::MIN_VELOCITY_STEPS * step {
        return;
    }
    let sums = Sums {
        position: xx,
        other: vv,
        both: xv,
    };
    let found = fault(&sums, WINDOW_SAMPLES, CAUSES).map(Found::Velocity);
    log.findings.extend(found.map(Finding::warning));
}
