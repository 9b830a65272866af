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
    for pair in rows.windows(2) {
        let [_, second, third, fourth, fifth] = powers([&pair[0].1, &pair[1].1], step);
        for k in 0..=PLACES {
            let s = k as f64 / PLACES as f64;
            let bend = 2.0 * second + s * (6.0 * third + s * (12.0 * fourth + s * 20.0 * fifth));
            let turn = 6.0 * third + s * (24.0 * fourth + s * 60.0 * fifth);
            most[0] = most[0].max((bend / (step * step)).abs());
            most[1] = most[1].max((turn / (step * step * step)).abs());
        }
    }
    most
}

/// The polynomial of degree five with position, velocity and acceleration of two rows, `t` seconds after the first.
fn quintic(rows: [&Instant; 2], step: f64, t: f64) -> f64 {
    let s = t / step;
    let way = powers(rows, step);
    rows[0].position + way.iter().rev().fold(0.0, |sum, power| s * (sum + power))
}

/// Its coefficients of the first to the fifth power of t/step, m (rad).
fn powers([a, b]: [&Instant; 2], step: f64) -> [f64; 5] {
    let way = b.position - a.position;
    let [v, w] = [step * a.velocity, step * b.velocity];
    let [p, q] = [a.acceleration, b.acceleration].map(|x| step * step * x);
    [
        v,
        0.5 * p,
        10.0 * way - 6.0 * v - 4.0 * w - 1.5 * p + 0.5 * q,
        -15.0 * way + 8.0 * v + 7.0 * w + 1.5 * p - q,
        6.0 * way - 3.0 * (v + w) + 0.5 * (q - p),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atom::Atom;
    use crate::motion::Motion;

    /// Between close points a quintic accelerates and jerks as the motion does, beside what steps of the jerk make of it.
    #[test]
    fn close_points_have_the_extremes_of_the_motion() {
        let (fade_in, fade_out) = (0.4, 0.4);
        let sine = Atom::Sine {
            amplitude: 1e-3,
            frequency: 5.0,
            duration: 1.0,
            fade_in,
            fade_out,
        };
        let motion = Motion::new(vec![sine]).unwrap();
        let job = Job {
            motion: &motion,
            identifier: "x",
            rotary: false,
            rate: 1e3,
            resolution: 1e-6,
            start: 0.12,
        };
        let [acceleration, jerk] = largest(&job, 1e-3);
        let due = sine.extremes();
        assert!((acceleration / due.acceleration - 1.0).abs() < 0.01);
        assert!((jerk / due.jerk - 1.0).abs() < 0.01, "{jerk} {}", due.jerk);
        assert!(piecewise::off(&job, 1e-3, quintic) < 1e-11);
    }
}
