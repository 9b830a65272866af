//! Lines for `halstreamer` of LinuxCNC.

use super::{Carried, Carrier, Job};
use std::fmt::Write;
use stiction_number::short;

/// Position and velocity in the units of the machine, one line for each period of the thread.
pub(super) fn carry(job: &Job) -> Carried {
    let (unit, of) = job.machine();
    let period = short(1e9 / job.rate);
    let mut text = format!(
        "# {} of stiction: position [{unit}] and velocity [{unit}/s], a line for each period of {period} ns\n\
         # loadrt streamer cfg=ff depth=4000; addf streamer.0 servo-thread before the controller; halstreamer -c 0 FILE\n",
        job.identifier
    );
    for (_, at) in job.samples() {
        let _ = writeln!(text, "{:.9} {:.9}", of * at.position, of * at.velocity);
    }
    Carried {
        carrier: Carrier::Halstreamer,
        text,
        note: format!(
            "position and velocity in {unit} and {unit}/s for streamer cfg=ff in a thread of {period} ns; pins keep the last \
             line, which is at rest; {}",
            job.counts_from()
        ),
    }
}
