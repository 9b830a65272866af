//! A reference that stands still after a move: where the axis stops, whether it hunts, and whether the compensating force
//! chatters.

use super::compensation::Compensation;
use super::crawl::sprung;
use super::fault::Fault;
use super::stage::{Control, Stage};
use crate::reproduce::watch::Watch;
use rayon::prelude::*;
use stiction_friction::{LuGre, ParamError};
use stiction_servo::axis::{AxisSettings, Sample};
use stiction_servo::metrics::{Hunting, standing_error};
use stiction_servo::motion::{Limits, Move, Moves};

/// The move, in deflections at break-away, dimensionless: well out of presliding.
pub(super) const DEFLECTIONS: f64 = 50.0;
/// How long the reference then stands, s: hunting takes tenths of a second and longer a cycle.
pub(super) const DWELL: f64 = 3.0;
/// Limits of the move on our stage, in m and s.
const LIMITS: Limits = Limits {
    velocity: 0.01,
    acceleration: 0.4,
    jerk: 40.0,
};

/// What holds the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hold {
    /// The PID without its integral.
    Pd,
    /// A controller.
    Control(Control),
}

/// One run.
#[derive(Clone, Debug)]
pub struct Rested {
    /// What holds.
    pub hold: Hold,
    /// What compensates.
    pub compensation: Compensation,
    /// The samples from the end of the move on.
    pub samples: Vec<Sample>,
    /// Where the axis stands, off the reference, m (rad).
    pub standing: f64,
    /// The limit cycle, if there is one above a step of the encoder.
    pub hunting: Option<Hunting>,
    /// Highest less lowest compensating force in the second half of the rest, N (N m): chattering.
    pub swing: f64,
}

/// Without an integral, with it, and the cascade, each with what the measured velocity drives and what the reference drives.
pub(super) fn run(stage: &Stage, law: &LuGre<f64>, watch: &Watch) -> Result<Vec<Rested>, Fault> {
    let holds = [
        (Hold::Pd, sprung(stage, stage.bandwidths()[0])?),
        (Hold::Control(Control::Pid), stage.settings(Control::Pid)?),
        (
            Hold::Control(Control::Cascade),
            stage.settings(Control::Cascade)?,
        ),
    ];
    let each = [
        Compensation::Nothing,
        Compensation::StribeckMeasured,
        Compensation::Measured,
        Compensation::Reference,
    ];
    let runs: Vec<(Hold, AxisSettings, Compensation)> = holds
        .into_iter()
        .flat_map(|(hold, settings)| each.map(|of| (hold, settings.clone(), of)))
        .collect();
    let runs: Result<Vec<Rested>, ParamError> =
        runs.par_iter().map(|run| one(stage, run, law)).collect();
    let runs = runs?;
    watch.done()?;
    Ok(runs)
}

fn one(
    stage: &Stage,
    (hold, settings, compensation): &(Hold, AxisSettings, Compensation),
    law: &LuGre<f64>,
) -> Result<Rested, ParamError> {
    let there = Move {
        distance: DEFLECTIONS * stage.truth.law.bound(),
        dwell: DWELL,
    };
    let settings = compensation.compensate(settings.clone(), law)?;
    let samples = stage.along(&settings, &Moves::new(&[there], stage.limits(LIMITS))?)?;
    let end = samples.last().map_or(0.0, |s| s.time);
    let from = samples.partition_point(|s| s.time < end - DWELL);
    let half = &samples[samples.partition_point(|s| s.time < end - 0.5 * DWELL)..];
    let forces = half.iter().map(|s| s.compensation);
    let most = forces.clone().fold(f64::NEG_INFINITY, f64::max);
    let step = stage.encoder.resolution();
    Ok(Rested {
        hold: *hold,
        compensation: *compensation,
        standing: standing_error(&samples).unwrap_or(f64::NAN),
        hunting: Hunting::of(&samples).filter(|h| h.amplitude > step && h.period.is_some()),
        swing: most - forces.fold(f64::INFINITY, f64::min),
        samples: samples[from..].to_vec(),
    })
}
