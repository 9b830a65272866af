//! The axis of the demo in closed loop, and its log.

use std::fmt::Write;
use stiction_friction::ParamError;
use stiction_servo::cascade::Cascade;
use stiction_servo::closed_loop::{ClosedLoop, ForceLog, Record};
use stiction_servo::encoder::Encoder;
use stiction_servo::known::KnownAxis;
use stiction_servo::path::Path as Reference;
use stiction_servo::plant::Plant;
use stiction_servo::trajectory::Trajectory;

/// The axis that is simulated.
pub(super) const AXIS: &str = "machine";
/// One encoder count, m.
pub(super) const ENCODER_COUNT: f64 = 50e-9;
/// Noise of the force (motor current times force constant), N rms.
pub(super) const FORCE_NOISE: f64 = 1.0;
/// Control and log rate, Hz.
pub(super) const RATE: f64 = 4000.0;

/// The axis along three segments of excitation.
pub(super) fn simulate(axis: &KnownAxis, seed: u64) -> Result<Record, ParamError> {
    along(axis, Reference::three_segments(0.196, 9.0)?, seed)
}

/// The axis along a motion.
pub(super) fn along(
    axis: &KnownAxis,
    path: impl Trajectory,
    seed: u64,
) -> Result<Record, ParamError> {
    ClosedLoop {
        plant: Plant::new(axis.mass, axis.law)?,
        controller: Cascade::tuned(axis.mass, 60.0, 500.0)?,
        path,
        encoder: Encoder::new(ENCODER_COUNT)?,
        rate: RATE,
        substeps: 5,
        force_noise: FORCE_NOISE,
        force_log: ForceLog::Centred,
        seed,
    }
    .run()
}

/// The log as a drive would write it: position in whole encoder steps, force with its noise.
pub(super) fn csv(record: &Record) -> String {
    let mut out = String::from("Time [s],Reference [mm],Position [mm],Force [N]\n");
    for i in 0..record.time.len() {
        let _ = writeln!(
            out,
            "{:.6},{:.6},{:.6},{:.4}",
            record.time[i],
            1e3 * record.reference[i],
            1e3 * record.position[i],
            record.force[i]
        );
    }
    out
}
