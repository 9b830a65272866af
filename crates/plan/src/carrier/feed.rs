//! Rows for `MC_ExtSetPointGenFeed` of TwinCAT, one for each cycle of the task that calls it.

use super::{Carried, Carrier, Job};
use std::fmt::Write;
use stiction_number::short;

/// Position, velocity, acceleration and direction: the inputs of the function by name, in the units of the axis of a machine.
pub(super) fn carry(job: &Job) -> Carried {
    let (unit, of) = job.machine();
    let mut text =
        format!("Position [{unit}],Velocity [{unit}/s],Acceleration [{unit}/s2],Direction\n");
    for (_, at) in job.samples() {
        // At rest neither of the two.
        let direction = match at.velocity {
            v if v > 0.0 => 1,
            v if v < 0.0 => -1,
            _ => 0,
        };
        let _ = writeln!(
            text,
            "{:.9},{:.9},{:.9},{direction}",
            of * at.position,
            of * at.velocity,
            of * at.acceleration
        );
    }
    Carried {
        carrier: Carrier::Feed,
        text,
        note: format!(
            "inputs of MC_ExtSetPointGenFeed, a row for each cycle of {} ms, between MC_ExtSetPointGenEnable and \
             MC_ExtSetPointGenDisable; {}",
            short(1e3 / job.rate),
            job.adding("the position of the axis at its start")
        ),
    }
}
