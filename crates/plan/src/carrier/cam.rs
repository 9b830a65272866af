//! A cam over time.

use super::{Carried, Carrier, Job, piecewise};
use std::fmt::Write;
use stiction_number::short;

/// Master and slave, one row for each sample of the log.
pub(super) fn carry(job: &Job) -> Carried {
    let length = job.length();
    let mut text = format!("master [s],slave [{length}]\n");
    for (t, at) in job.samples() {
        let _ = writeln!(text, "{t:.9},{:.12}", at.position);
    }
    let linear = |[a, b]: [&crate::atom::Instant; 2], step: f64, t: f64| {
        a.position + (b.position - a.position) * t / step
    };
    let off = piecewise::off(job, 1.0 / job.rate, linear);
    Carried {
        carrier: Carrier::Cam,
        text,
        note: format!(
            "cam points every {} ms of a master that moves 1 unit a second; a straight line between them is off by at most {} \
             {length}, a spline by less; keep the jerk limit of the cam coupling out of it; {}",
            short(1e3 / job.rate),
            short(off),
            job.counts_from()
        ),
    }
}
