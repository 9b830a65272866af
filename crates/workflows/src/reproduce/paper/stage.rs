//! The axis of the paper, with numbers of our own where it gives none.

use stiction_friction::ParamError;
use stiction_servo::axis::{AxisSettings, Sample};
use stiction_servo::controller::Controller;
use stiction_servo::drive::Drive;
use stiction_servo::feedforward::Feedforward;
use stiction_servo::fuzzy::FuzzyPid;
use stiction_servo::integrator::Ode4;
use stiction_servo::known::{self, KnownAxis};
use stiction_servo::plant::Plant;
use stiction_servo::run::run_with;
use stiction_servo::trajectory::Trajectory;

/// Control rate, Hz: one step of ode4 of 1e-4 s in each period.
pub(super) const RATE: f64 = 1e4;

/// Bandwidths for which the fuzzy PIDs of x and y are tuned, Hz.
const BANDWIDTHS: [f64; 2] = [60.0, 45.0];

/// The simulated truth of the stage that is identified: mass and friction.
pub(super) fn truth() -> Result<KnownAxis, ParamError> {
    axis("motor")
}

fn axis(name: &str) -> Result<KnownAxis, ParamError> {
    known::find(name).ok_or(ParamError::new("axis", 0.0, "a known one"))
}

/// The stage, Z25 eqs. (23)-(24): `M x'' = Ke u - F`, no delay and no current loop of its own.
pub(super) fn settings() -> Result<AxisSettings, ParamError> {
    controlled(&truth()?, BANDWIDTHS[0])
}

/// The axis that carries the stage in the corner: a heavier slide.
pub(super) fn second() -> Result<AxisSettings, ParamError> {
    controlled(&axis("machine")?, BANDWIDTHS[1])
}

fn controlled(axis: &KnownAxis, bandwidth: f64) -> Result<AxisSettings, ParamError> {
    let drive = Drive {
        current_lag: 0.0,
        ..Drive::linear_motor(0.0)
    };
    let friction = axis.law.curve().largest_static_level();
    let fuzzy = FuzzyPid::tuned(axis.mass, bandwidth, drive.peak_force(), friction)?;
    Ok(AxisSettings {
        plant: Plant::new(axis.mass, axis.law)?,
        drive,
        controller: Controller::Fuzzy(fuzzy),
        feedforward: Feedforward::default(),
        substeps: 1,
        ..axis.simulated(RATE, bandwidth)?
    })
}

/// Along a trajectory as the paper integrates it.
pub(super) fn along(
    settings: &AxisSettings,
    trajectory: &impl Trajectory,
) -> Result<Vec<Sample>, ParamError> {
    run_with(settings, trajectory, Ode4::new(1)?)
}
