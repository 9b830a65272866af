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
    let [acceleration, jerk] = largest(job, 1e-3 * ms);
    Carried {
        carrier: Carrier::Ros2,
        text,
        note: format!(
            "points every {} ms in {}; the quintics between them are off by at most {} {}, with accelerations up to {} {}/s2 and jerks up to {} \
             {}/s3 between points, where the limits of jerk and acceleration do not hold to the last part; {}",
            short(ms),
            job.length(),
            short(off),
            job.length(),
            short(acceleration),
            job.length(),
            short(jerk),
            job.length(),
            job.counts_from()
        ),
    }
}

/// Places of a quintic at which its derivatives are looked at.
const PLACES: usize = 16;

/// Largest acceleration, m/s^2 (rad/s^2), and jerk, m/s^3 (rad/s^3), of the quintics between points.
fn largest(job: &Job, step: f64) -> [f64; 2] {
    let mut most = [0.0_f64; 2];
    let rows = piecewise::rows(job, step);
    for [a, b] in rows.windows(2).map(|pair| [&pair[0].1, &pair[1].1]) {
        let way = (b.position - a.position) / step;
        let [v, w] = [a.velocity, b.velocity];
        let [p, q] = [step * a.acceleration, step * b.acceleration];
        // Coefficients of the third to the fifth power of s = t/step, of the position over step.
        let third = 10.0 * way - 6.0 * v - 4.0 * w - 1.5 * p + 0.5 * q;
        let fourth = -15.0 * way + 8.0 * v + 7.0 * w + 1.5 * p - q;
        let fifth = 6.0 * way - 3.0 * (v + w) + 0.5 * (q - p);
        for k in 0..=PLACES {
            let s = k as f64 / PLACES as f64;
            let bend = p + 6.0 * third * s + 12.0 * fourth * s * s + 20.0 * fifth * s * s * s;
            let turn = 6.0 * third + 24.0 * fourth * s + 60.0 * fifth * s * s;
            most[0] = most[0].max((bend / step).abs());
            most[1] = most[1].max((turn / (step * step)).abs());
        }
    }
    most
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
