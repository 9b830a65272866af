//! A low-pass that the torques passed before they were logged.

use super::{Machine, Prior, RobotJoint, rigid_fit};
use stiction_policy::robot;
use stiction_signal::Sos;

/// Order of the low-pass that is looked for, as that of the filters of a record.
const ORDER: usize = 4;
/// Ratio of neighbouring cut-offs of the search, first coarse, then fine.
const RATIOS: [f64; 2] = [1.5, 1.15];
/// Cut-offs of the coarse search below the common one: down to a twelfth of it.
const COARSE: i32 = 6;

/// Finds the cut-off, Hz, of a low-pass through which all torques passed before they were logged: columns of the motion that pass it
/// too leave clearly less of them. `None` where there is none to be seen below the common filter of the records.
pub fn torque_cutoff(machine: Machine, joints: &[RobotJoint], prior: &Prior) -> Option<f64> {
    let record = joints.first()?.record;
    let rate = 1.0 / record.step();
    let common = record.common_hz?;
    let left = |channel: Option<&Sos>| -> Option<f64> {
        let fit = rigid_fit(Machine { channel, ..machine }, joints, prior).ok()?;
        let logs = fit.residual.iter().map(|r| libm::log(*r));
        Some(libm::exp(logs.sum::<f64>() / fit.residual.len() as f64))
    };
    let with = |hertz: f64| -> Option<f64> {
        let filter = Sos::butterworth_low_pass(ORDER, hertz, rate).ok()?;
        left(Some(&filter))
    };
    let none = left(None)?;
    let mut best = (common, none);
    for (ratio, steps) in [
        (RATIOS[0], (1..=COARSE).map(|k| -k).collect::<Vec<_>>()),
        (RATIOS[1], vec![-2, -1, 1, 2]),
    ] {
        let middle = best.0;
        if ratio == RATIOS[1] && middle == common {
            break;
        }
        for step in steps {
            let hertz = middle * ratio.powi(step);
            if let Some(error) = with(hertz).filter(|error| *error < best.1) {
                best = (hertz, error);
            }
        }
    }
    let is_better = best.1 < robot::MAX_FILTERED_ERROR * none;
    (is_better && beyond(joints, 2.0 * best.0, rate)? < robot::MAX_BEYOND_FILTER).then_some(best.0)
}

/// Torque above a frequency, Hz, over the whole, its mean apart: rms, the geometric mean of the joints. A bristle smooths the friction
/// of short strokes as a low-pass does, and leaves the rest of a torque as fast as it is.
fn beyond(joints: &[RobotJoint], hertz: f64, rate: f64) -> Option<f64> {
    let high = Sos::butterworth_high_pass(ORDER, hertz, rate).ok()?;
    let of_joint = |joint: &RobotJoint| -> Option<f64> {
        let [mut fast, mut whole] = [0.0; 2];
        for segment in &joint.record.segments {
            let drive = &segment.drive;
            let mean = drive.iter().sum::<f64>() / drive.len() as f64;
            let Ok(above) = high.zero_phase(drive) else {
                continue;
            };
            fast += above.iter().map(|x| x * x).sum::<f64>();
            whole += drive.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
        }
        (fast > 0.0 && whole > 0.0).then(|| 0.5 * libm::log(fast / whole))
    };
    let logs: Vec<f64> = joints
        .iter()
        .filter(|own| own.counts)
        .filter_map(of_joint)
        .collect();
    Some(libm::exp(
        logs.iter().sum::<f64>() / logs.len().max(1) as f64,
    ))
}
