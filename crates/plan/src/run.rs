//! A motion on a candidate, simulated in closed loop with its encoder.

use crate::candidate::Candidate;
use crate::pushed::{Push, Pushed, depends};
use crate::rig::Rig;
use stiction_friction::{Held, ParamError};
use stiction_servo::axis::{Axis, AxisSettings, Correction};
use stiction_servo::controller::Controller;
use stiction_servo::drive::Drive;
use stiction_servo::encoder::Encoder;
use stiction_servo::feedforward::Feedforward;
use stiction_servo::integrator::{Integrator, Mid, Quick};
use stiction_servo::levelled::{Depending, Levelled};
use stiction_servo::path::Reference;
use stiction_servo::plant::Plant;
use stiction_servo::trajectory::Trajectory;

/// What a run shows, at the rate of the log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// Position as the encoder reads it, m (rad).
    pub reading: Vec<f64>,
    /// True velocity, m/s (rad/s).
    pub velocity: Vec<f64>,
    /// Force about the instant of each sample, N (N m): the mean of what acts before and after it.
    pub force: Vec<f64>,
    /// Force that the controller asks for in answer to each sample, N (N m): what a drive logs beside the position.
    pub command: Vec<f64>,
    /// What happened between samples too.
    pub peaks: Peaks,
}

/// The largest of what a run did, in every control period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Peaks {
    /// Least and largest true position, m (rad).
    pub position: [f64; 2],
    /// Largest true speed, m/s (rad/s).
    pub speed: f64,
    /// Largest force, N (N m).
    pub force: f64,
    /// Mean of its square, N^2.
    pub force_square: f64,
    /// Largest difference of reference and position, m (rad).
    pub error: f64,
    /// Share of the control periods in which the force is at its limit.
    pub saturated: f64,
    /// Sum of the squares of the true velocity over that of the reference velocity: far below 1 where the axis sticks.
    pub followed: f64,
}

/// Largest step of the plant, as the angle by which its bristles swing meanwhile, rad; and that of one that stands for a machine. With
/// 0.4 rad stiff bristles have a micro-damping that is up to 1.5 % off, and what a slow log makes of their stiffness is not seen.
const BRISTLE_STEP: f64 = 0.15;
const FINE_STEP: f64 = 0.02;
/// Most steps of the plant in a control period.
const MOST_STEPS: f64 = 64.0;

/// Runs a motion from rest on the candidate under a largest force, N (N m). `phase`, 0 to 1, is where the encoder stands in its
/// step. The controller holds at the start what pushes the axis there.
pub fn run(
    motion: &impl Trajectory,
    candidate: &Candidate,
    rig: &Rig,
    force_limit: f64,
    phase: f64,
) -> Result<Run, ParamError> {
    with_steps(motion, candidate, rig, (force_limit, phase), BRISTLE_STEP)
}

/// The same by short steps, for logs that stand for those of a machine: some ten times slower.
///
/// # Errors
/// As [`run`].
pub fn run_finely(
    motion: &impl Trajectory,
    candidate: &Candidate,
    rig: &Rig,
    force_limit: f64,
    phase: f64,
) -> Result<Run, ParamError> {
    with_steps(motion, candidate, rig, (force_limit, phase), FINE_STEP)
}

fn with_steps(
    motion: &impl Trajectory,
    candidate: &Candidate,
    rig: &Rig,
    (force_limit, phase): (f64, f64),
    bristle_step: f64,
) -> Result<Run, ParamError> {
    let with = (force_limit, phase, bristle_step);
    let push = Push::of(candidate);
    let hold = push.asks(0.0, 0.0);
    if let Some(slip) = &candidate.slip {
        let law = slip.law(candidate)?;
        let settings = settings(law, candidate, rig, with)?;
        let pushed = Pushed::new(Mid::new(1)?, push);
        return follow(Axis::new(settings, pushed)?, motion, rig, hold);
    }
    let law = candidate.law()?;
    match (depends(candidate), push.is_none()) {
        (None, true) => {
            let settings = settings(law, candidate, rig, with)?;
            follow(Axis::new(settings, Quick::new(1)?)?, motion, rig, hold)
        }
        (None, false) => {
            let settings = settings(law, candidate, rig, with)?;
            let pushed = Pushed::new(Quick::new(1)?, push);
            follow(Axis::new(settings, pushed)?, motion, rig, hold)
        }
        (Some(depends), _) => {
            let law = Levelled::unchanged(law);
            let settings = settings(law, candidate, rig, with)?;
            let pushed = Pushed::new(Depending::new(Mid::new(1)?, depends), push);
            follow(Axis::new(settings, pushed)?, motion, rig, hold)
        }
    }
}

/// The axis with its law, drive, encoder and controller.
fn settings<L: Held<f64>>(
    law: L,
    candidate: &Candidate,
    rig: &Rig,
    (force_limit, phase, bristle_step): (f64, f64, f64),
) -> Result<AxisSettings<L>, ParamError> {
    let rate = rig.rate * rig.periods() as f64;
    let bristles = libm::sqrt(candidate.sigma0 / candidate.mass) / rate;
    let substeps = libm::ceil(bristles / bristle_step).clamp(1.0, MOST_STEPS) as u32;
    Ok(AxisSettings {
        plant: Plant::new(candidate.mass, law)?,
        drive: Drive::ideal(),
        encoder: Encoder::new(rig.encoder_step)?.with_phase(phase)?,
        position_noise: 0.0,
        cogging: None,
        disturbance: None,
        controller: Controller::Cascade(rig.cascade(candidate.mass, force_limit)?),
        feedforward: Feedforward::default(),
        rate,
        substeps,
        seed: 0,
    })
}

/// Runs an axis along a motion, with a force that is held throughout, N (N m): what the integrator of a controller has at the start.
fn follow<L: Held<f64>, I: Integrator<L>>(
    mut axis: Axis<L, I>,
    motion: &impl Trajectory,
    rig: &Rig,
    hold: f64,
) -> Result<Run, ParamError> {
    let every = rig.periods();
    let rate = axis.settings().rate;
    let force_limit = axis.settings().controller.force_limit();
    let samples = libm::floor(motion.duration() * rig.rate + 1e-6) as usize + 1;
    let mut out = Run {
        reading: Vec::with_capacity(samples),
        velocity: Vec::with_capacity(samples),
        force: Vec::with_capacity(samples),
        command: Vec::with_capacity(samples),
        peaks: Peaks::default(),
    };
    let peaks = &mut out.peaks;
    let (mut held, mut asked, mut moved, mut at_limit) = (0.0, 0.0, 0.0, 0_usize);
    let fed = rig.velocity_feedforward();
    let count = (samples - 1) * every + 1;
    for k in 0..count {
        let reference: Reference = motion.at(k as f64 / rate);
        let correction = Correction {
            velocity: (fed - 1.0) * reference.velocity,
            force: hold,
        };
        let sample = axis.step(reference, 0.0, correction);
        if k % every == 0 {
            out.reading.push(sample.measured);
            out.velocity.push(sample.velocity);
            out.force.push(0.5 * (held + sample.command));
            out.command.push(sample.command);
        }
        held = sample.command;
        let [low, high] = &mut peaks.position;
        (*low, *high) = (low.min(sample.position), high.max(sample.position));
        peaks.speed = peaks.speed.max(sample.velocity.abs());
        peaks.force = peaks.force.max(held.abs());
        peaks.force_square += held * held;
        peaks.error = peaks.error.max(sample.error().abs());
        at_limit += usize::from(held.abs() >= force_limit);
        asked += reference.velocity * reference.velocity;
        moved += sample.velocity * sample.velocity;
    }
    peaks.force_square /= count as f64;
    peaks.saturated = at_limit as f64 / count as f64;
    peaks.followed = if asked > 0.0 { moved / asked } else { 1.0 };
    if !(peaks.speed.is_finite() && peaks.force_square.is_finite() && peaks.error.is_finite()) {
        let allowed = "a motion that stays finite: a smaller bandwidth";
        return Err(ParamError::new("bandwidth", rig.bandwidth(), allowed));
    }
    Ok(out)
}
