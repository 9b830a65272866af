//! A corner of two axes, with a stop and blended, without and with cross-coupled control: the deviation from it and the feed
//! along it.

use super::compensation::Compensation;
use super::fault::Fault;
use super::stage::{Control, RATE, Stage};
use super::tracking::pairs;
use crate::reproduce::watch::Watch;
use rayon::prelude::*;
use stiction_friction::{LuGre, ParamError};
use stiction_servo::cross_coupling::CrossCoupling;
use stiction_servo::integrator::Ode4;
use stiction_servo::metrics::{Contour, Feed};
use stiction_servo::motion::{Limits, Profile};
use stiction_servo::plane::{Along, FreeForm, Polygon};
use stiction_servo::two_axes::{PlaneSample, TwoAxes};

/// Side of the corner on our stage, m, and the limits along it: 3 m/min.
pub(super) const SIDE: f64 = 20e-3;
pub(super) const LIMITS: Limits = Limits {
    velocity: 0.05,
    acceleration: 2.0,
    jerk: 200.0,
};

/// How long before and after the corner is evaluated, s.
const EVALUATED_ABOUT_CORNER: f64 = 0.2;

/// How both axes go round the corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// They stop in it.
    Stop,
    /// One starts as the other begins to stop, so that the feed goes on and the corner is rounded.
    Blend,
}

/// One run.
#[derive(Clone, Debug)]
pub struct Cornered {
    /// The controller of both axes.
    pub control: Control,
    /// What compensates on both.
    pub compensation: Compensation,
    /// How it goes round the corner.
    pub turn: Turn,
    /// Whether the deviation from the contour is controlled above both axes.
    pub coupled: bool,
    /// What is evaluated: about the corner.
    pub samples: Vec<PlaneSample>,
    /// Deviation from the contour about the corner.
    pub contour: Contour,
    /// Error of the feed about the corner.
    pub feed: Option<Feed>,
}

impl Cornered {
    /// Whether it stands in the pictures.
    pub fn is_drawn(&self) -> bool {
        self.control == Control::Fuzzy && self.compensation.is_drawn()
    }
}

/// With a stop and blended, each without coupling and then with it.
pub(super) fn run(stage: &Stage, law: &LuGre<f64>, watch: &Watch) -> Result<Vec<Cornered>, Fault> {
    let kinds = [Turn::Stop, Turn::Blend]
        .into_iter()
        .flat_map(|turn| [false, true].map(|coupled| (turn, coupled)));
    let runs: Vec<(Turn, bool, Control, Compensation)> = kinds
        .flat_map(|(turn, coupled)| pairs().map(move |(control, of)| (turn, coupled, control, of)))
        .collect();
    let runs: Result<Vec<Cornered>, ParamError> =
        runs.par_iter().map(|run| one(stage, *run, law)).collect();
    let runs = runs?;
    watch.done()?;
    Ok(runs)
}

fn one(
    stage: &Stage,
    (turn, coupled, control, compensation): (Turn, bool, Control, Compensation),
    law: &LuGre<f64>,
) -> Result<Cornered, ParamError> {
    let second = stage.second(control)?;
    let other = *second.plant.law();
    let axes = [
        compensation.compensate(stage.settings(control)?, law)?,
        compensation.compensate(second, &other)?,
    ];
    let limits = stage.limits(LIMITS);
    let coupling = coupled.then(|| {
        let coupling = CrossCoupling::tuned(stage.bandwidths()[1], limits.velocity)?;
        let [x, y] = &axes;
        Ok(coupling.above([&x.controller, &y.controller]))
    });
    let coupling = coupling.transpose()?;
    let edge = Profile::new(stage.stroke(SIDE), limits)?;
    let (axes, ode4) = (TwoAxes { axes, coupling }, Ode4::new(stage.steps)?);
    let (samples, turns) = match turn {
        Turn::Stop => {
            let corner = Along::new(Polygon::corner(edge.distance())?, limits)?;
            (axes.run_with(&corner, ode4)?, edge.duration())
        }
        Turn::Blend => {
            let later = edge.duration() - edge.ramp();
            let points = (0..=((later + edge.duration()) * RATE) as usize).map(|k| k as f64 / RATE);
            let along = |from: f64| points.clone().map(|t| edge.at(t - from).position).collect();
            let corner = FreeForm::new(RATE, along(0.0), along(later))?;
            (axes.run_with(&corner, ode4)?, later + 0.5 * edge.ramp())
        }
    };
    let time = |s: &PlaneSample| s.axes[0].time;
    let from = samples.partition_point(|s| time(s) < turns - EVALUATED_ABOUT_CORNER);
    let to = samples.partition_point(|s| time(s) <= turns + EVALUATED_ABOUT_CORNER);
    Ok(Cornered {
        control,
        compensation,
        turn,
        coupled,
        contour: Contour::of(&samples[from..to]),
        feed: Feed::along(&samples[from..to]),
        samples: samples[from..to].to_vec(),
    })
}
