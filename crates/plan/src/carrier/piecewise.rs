//! What is between rows that are farther apart than samples.

use super::Job;
use crate::atom::Instant;

/// Places between two rows at which the difference is looked at.
const BETWEEN: usize = 8;

/// How far `between`, which is given two rows, their distance in time and the time since the first, is from the motion at most,
/// m (rad), where rows are `step` seconds apart.
pub(super) fn off(job: &Job, step: f64, between: impl Fn([&Instant; 2], f64, f64) -> f64) -> f64 {
    let rows = rows(job, step);
    let mut most = 0.0_f64;
    for pair in rows.windows(2) {
        for k in 1..BETWEEN {
            let since = step * k as f64 / BETWEEN as f64;
            let found = between([&pair[0].1, &pair[1].1], step, since);
            most = most.max((found - job.at(pair[0].0 + since).position).abs());
        }
    }
    most
}

/// Time and reference, `step` seconds apart, the last at rest.
pub(super) fn rows(job: &Job, step: f64) -> Vec<(f64, Instant)> {
    let count = libm::ceil(job.motion.duration() / step) as usize;
    let row = |k: usize| {
        let t = k as f64 * step;
        (t, job.at(t))
    };
    (0..=count).map(row).collect()
}
