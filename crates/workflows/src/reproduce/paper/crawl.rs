//! Crawling at low speed, over the stiffness of what pulls the axis; and the controllers at the same speed.

use super::compensation::Compensation;
use super::fault::Fault;
use super::stage::{Control, Stage};
use crate::reproduce::watch::Watch;
use rayon::prelude::*;
use stiction_friction::{LuGre, ParamError};
use stiction_servo::axis::{AxisSettings, Sample};
use stiction_servo::controller::Controller;
use stiction_servo::metrics::Crawl;
use stiction_servo::pid::Pid;
use stiction_servo::speeds::{SpeedRun, Speeds};

/// Constant reference velocity, m/s: a third of the Stribeck velocity of our stage.
pub(super) const VELOCITY: f64 = 1e-3;
/// Time at it, and to reach and leave it, s: 3 s together, as long as the paper simulates.
const HOLD: f64 = 2.9;
const RAMP: f64 = 0.05;
/// Bandwidths of the PIDs without their integral, which are springs with dampers, in parts of that of the controllers: their
/// stiffness grows as the square.
pub(super) const SPRINGS: [f64; 7] = [0.133, 0.2, 0.25, 0.333, 0.5, 1.0, 2.0];

/// What pulls the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pull {
    /// A spring of this stiffness, N/m (N m/rad), with a damper, whose other end has the reference velocity.
    Spring(f64),
    /// A controller.
    Control(Control),
}

/// One run of 3 s.
#[derive(Clone, Debug)]
pub struct Crawled {
    /// What pulls.
    pub pull: Pull,
    /// What compensates.
    pub compensation: Compensation,
    /// s
    pub time: Vec<f64>,
    /// Reference and axis, m (rad).
    pub position: [Vec<f64>; 2],
    /// m/s (rad/s)
    pub velocity: Vec<f64>,
    /// How evenly it goes, from the middle of the constant velocity on.
    pub crawl: Crawl,
}

/// Springs from the softest on, then the controllers; each without and with the law on the reference velocity.
pub(super) fn run(stage: &Stage, law: &LuGre<f64>, watch: &Watch) -> Result<Vec<Crawled>, Fault> {
    let mut pulled = Vec::new();
    for part in SPRINGS {
        let settings = sprung(stage, part * stage.bandwidths()[0])?;
        let Controller::Pid(spring) = settings.controller else {
            continue;
        };
        pulled.push((Pull::Spring(spring.proportional), settings));
    }
    for control in Control::ALL {
        pulled.push((Pull::Control(control), stage.settings(control)?));
    }
    let each = [Compensation::Nothing, Compensation::Reference];
    let runs: Vec<(Pull, AxisSettings, Compensation)> = pulled
        .into_iter()
        .flat_map(|(pull, settings)| each.map(|of| (pull, settings.clone(), of)))
        .collect();
    let runs: Result<Vec<Crawled>, ParamError> =
        runs.par_iter().map(|run| one(stage, run, law)).collect();
    let runs = runs?;
    watch.done()?;
    Ok(runs)
}

fn one(
    stage: &Stage,
    (pull, settings, compensation): &(Pull, AxisSettings, Compensation),
    law: &LuGre<f64>,
) -> Result<Crawled, ParamError> {
    let run = SpeedRun {
        velocity: stage.speed(VELOCITY),
        hold: HOLD,
        ramp: RAMP,
    };
    let settings = compensation.compensate(settings.clone(), law)?;
    let samples = stage.along(&settings, &Speeds::new(vec![run])?)?;
    let column = |of: fn(&Sample) -> f64| samples.iter().map(of).collect::<Vec<f64>>();
    Ok(Crawled {
        pull: *pull,
        compensation: *compensation,
        // The whole record has one stretch of constant velocity.
        crawl: Crawl::of(&samples).unwrap_or(Crawl {
            ripple: f64::NAN,
            rest_share: f64::NAN,
        }),
        time: column(|s| s.time),
        position: [column(|s| s.reference.position), column(|s| s.position)],
        velocity: column(|s| s.velocity),
    })
}

/// The axis on a spring with a damper: the PID without its integral.
pub(super) fn sprung(stage: &Stage, bandwidth: f64) -> Result<AxisSettings, ParamError> {
    let settings = stage.settings(Control::Pid)?;
    let limit = settings.controller.force_limit();
    let spring = Pid {
        integral: 0.0,
        mass_feedforward: 0.0,
        ..Pid::tuned(stage.truth.mass, bandwidth, limit)?
    };
    Ok(AxisSettings {
        controller: Controller::Pid(spring),
        ..settings
    })
}
