//! `trajectory_msgs/msg/JointTrajectory` of ROS 2, as YAML.

use super::{Carried, Carrier, Job, piecewise};
use crate::atom::Instant;
use std::fmt::Write;
use stiction_number::short;

/// Distances of points, ms, of which the largest is taken with which quintics between points keep to the motion.
const STEPS: [f64; 6] = [50.0, 20.0, 10.0, 5.0, 2.0, 1.0];
/// How far they may be off: this part of an encoder step.
const PART: f64 = 0.1;

/// Points with velocities and accelerations, between which a joint trajectory controller follows quintics.
pub(super) fn carry(job: &Job) -> Carried {
    let allowed = PART * job.resolution;
    let all = STEPS.map(|ms| (ms, piecewise::off(job, 1e-3 * ms, quintic)));
    let last = all[STEPS.len() - 1];
    let (ms, off) = (all.into_iter().find(|(_, off)| *off <= allowed)).unwrap_or(last);
    let mut text = format!(
        "# A planned motion of stiction, from rest to rest: points every {} ms, quintics between them.\n\
         joint_names: [{}]\npoints:\n",
        short(ms),
        job.identifier
    );
    for (k, (_, at)) in piecewise::rows(job, 1e-3 * ms).into_iter().enumerate() {
        // In whole nanoseconds, so that no sum of steps goes into it.
        let nanoseconds = k as u64 * (1e6 * ms) as u64;
        let _ = writeln!(
            text,
            "- {{positions: [{:?}], velocities: [{:?}], accelerations: [{:?}], time_from_start: {{sec: {}, nanosec: {}}}}}",
            at.position,
            at.velocity,
            at.acceleration,
            nanoseconds / 1_000_000_000,
            nanoseconds % 1_000_000_000
        );
    }
    Carried {
        carrier: Carrier::Ros2,
        text,
        note: format!(
            "points every {} ms in {}; the quintics between them are off by at most {} {}; {}",
            short(ms),
            job.length(),
            short(off),
            job.length(),
            job.counts_from()
        ),
    }
}

/// The polynomial of degree five with position, velocity and acceleration of two rows, `t` seconds after the first.
fn quintic([a, b]: [&Instant; 2], step: f64, t: f64) -> f64 {
    let s = t / step;
    let r = 1.0 - s;
    // Hermite's basis: what belongs to the second row is that of the first seen from the end, with the velocity backwards.
    let basis = |s: f64, r: f64| {
        let cube = r * r * r;
        [
            cube * (1.0 + 3.0 * s + 6.0 * s * s),
            cube * s * (1.0 + 3.0 * s),
            0.5 * cube * s * s,
        ]
    };
    let (p, q) = (basis(s, r), basis(r, s));
    p[0] * a.position
        + q[0] * b.position
        + step * (p[1] * a.velocity - q[1] * b.velocity)
        + step * step * (p[2] * a.acceleration + q[2] * b.acceleration)
}
