//! Whether acceleration and position describe the same motion.

use super::finding::Finding;
use super::ratio::{Sums, fault};
use crate::log::Log;
use stiction_policy::signal;
use stiction_say::Found;

/// Samples on each side over which both are compared: long enough that noise and delay matter little.
const REACH: usize = 32;

/// Ratios that have a usual cause: that of the position over the acceleration of the log.
const CAUSES: &[(f64, &str)] = &[
    (1000.0, "position in mm taken as m"),
    (1e-3, "acceleration in mm/s^2 taken as m/s^2"),
    (9.806_65, "acceleration in g taken as m/s^2"),
    (0.101_971_621, "acceleration in m/s^2 taken as g"),
    (57.295_779_513, "position in degrees taken as rad"),
    (0.017_453_292_5, "acceleration in deg/s^2 taken as rad/s^2"),
];

/// A difference of positions is a weighted mean of the acceleration between them, exactly:
///
/// ```text
/// x(t + T) - 2 x(t) + x(t - T) = integral of (T - |s|) a(t + s) over s from -T to T
/// ```
pub(super) fn consistency(log: &mut Log) {
    let (Some(position), Some(acceleration)) = (&log.position, &log.acceleration) else {
        return;
    };
    let step = 1.0 / log.rate_hz;
    let whole = |from: usize, to: usize| {
        (from..to).all(|i| !log.gap_after(i) && !log.starts_segment(i + 1))
    };
    let mut pairs = Vec::new();
    let mut at = REACH;
    while at + REACH < position.len() {
        if whole(at - REACH, at + REACH) {
            let bend = position[at + REACH] - 2.0 * position[at] + position[at - REACH];
            let weighed = (0..=2 * REACH).map(|i| {
                let weight = REACH - i.abs_diff(REACH);
                weight as f64 * acceleration[at - REACH + i]
            });
            pairs.push((bend, weighed.sum::<f64>() * step * step));
        }
        at += REACH;
    }
    let count = pairs.len() as f64;
    // A constant is a mount that is not level, or gravity.
    let mean = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / count.max(1.0);
    let (x0, a0) = (mean(|p| p.0), mean(|p| p.1));
    let (mut xx, mut aa, mut xa) = (0.0, 0.0, 0.0);
    for (x, a) in &pairs {
        xx += (x - x0) * (x - x0);
        aa += (a - a0) * (a - a0);
        xa += (x - x0) * (a - a0);
    }
    let rms = (xx / count.max(1.0)).sqrt();
    if pairs.len() < signal::MIN_ACCELERATIONS
        || aa == 0.0
        || rms <= signal::MIN_ACCELERATION_STEPS * log.quantum.unwrap_or(0.0)
    {
        return;
    }
    let sums = Sums {
        position: xx,
        other: aa,
        both: xa,
    };
    let found = fault(&sums, 2 * REACH, CAUSES).map(Found::Acceleration);
    log.findings.extend(found.map(Finding::warning));
}
