//! The bandwidth of the controllers of an axis: with which it slides evenly at low speed.
//!
//! A loop that is too slow for its mass sticks and slips where friction falls with the velocity; one that is too fast for its
//! encoder shakes the axis with every count. Either way the mean force is not that of the mean velocity.

use super::stage::{BANDWIDTH, Control, Stage};
use super::statics::{RAMP, settle};
use rayon::prelude::*;
use stiction_friction::ParamError;
use stiction_policy::comparison;
use stiction_servo::metrics::Crawl;
use stiction_servo::speeds::{SpeedRun, Speeds};

/// Bandwidths in parts of that of our stage, in the order in which they are tried: as there, faster, slower; half octaves.
const PARTS: [f64; 11] = [
    1.0, 1.41, 2.0, 2.83, 4.0, 5.66, 8.0, 0.707, 0.5, 0.354, 0.25,
];
/// Speeds on our stage, m/s: below its Stribeck velocity, where friction falls, and at it.
const SPEEDS: [f64; 4] = [0.2e-3, 0.75e-3, 1.5e-3, 3e-3];

/// The first bandwidth with which the axis slides evenly, Hz; the one with which it does so best where none is.
pub(super) fn bandwidth(stage: &Stage) -> Result<f64, ParamError> {
    let mut best = (f64::INFINITY, BANDWIDTH);
    for part in PARTS {
        let bandwidth = part * BANDWIDTH;
        let uneven = unevenness(&Stage {
            bandwidth,
            ..stage.clone()
        })?;
        if uneven < best.0 {
            best = (uneven, bandwidth);
        }
        if uneven < comparison::MAX_PAPER_RIPPLE {
            break;
        }
    }
    Ok(best.1)
}

/// Largest rms deviation of the velocity over the speeds, over the Stribeck velocity.
fn unevenness(stage: &Stage) -> Result<f64, ParamError> {
    let slow = stage.truth.law.curve().positive().stribeck_velocity;
    let each: Result<Vec<f64>, ParamError> = SPEEDS
        .par_iter()
        .map(|ours| {
            let velocity = stage.speed(*ours);
            let run = SpeedRun {
                velocity,
                // The second half counts.
                hold: 2.0 * settle(stage, velocity),
                ramp: RAMP,
            };
            let samples =
                stage.along(&stage.settings(Control::Fuzzy)?, &Speeds::new(vec![run])?)?;
            let crawl = Crawl::of(&samples);
            Ok(crawl.map_or(f64::INFINITY, |c| c.ripple * velocity / slow))
        })
        .collect();
    Ok(each?.into_iter().fold(0.0, f64::max))
}
