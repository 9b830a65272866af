//! A corner of two axes without and with cross-coupled control, the deviation from it and the feed along it.

use super::compensation::Compensation;
use super::fault::Fault;
use super::stage::{BANDWIDTHS, Control, Stage};
use super::tracking::pairs;
use crate::reproduce::watch::Watch;
use rayon::prelude::*;
use stiction_friction::{LuGre, ParamError};
use stiction_servo::axis::AxisSettings;
use stiction_servo::cross_coupling::CrossCoupling;
use stiction_servo::integrator::Ode4;
use stiction_servo::metrics::{Contour, Feed};
use stiction_servo::motion::Limits;
use stiction_servo::plane::{Along, PlaneMotion, Polygon};
use stiction_servo::two_axes::{PlaneSample, TwoAxes};

/// Side of the corner, m, and the limits along it: 3 m/min.
const SIDE: f64 = 20e-3;
const LIMITS: Limits = Limits {
    velocity: 0.05,
    acceleration: 2.0,
    jerk: 200.0,
};

/// How long before and after the corner is evaluated, s.
const EVALUATED_ABOUT_CORNER: f64 = 0.2;

/// One run.
#[derive(Clone, Debug)]
pub struct Cornered {
    /// The controller of both axes.
    pub control: Control,
    /// What compensates on both.
    pub compensation: Compensation,
    /// Whether the deviation from the contour is controlled above both axes.
    pub coupled: bool,
    /// The whole run.
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

/// All runs without coupling, then all with it; none without a second axis.
pub(super) fn run(stage: &Stage, law: &LuGre<f64>, watch: &Watch) -> Result<Vec<Cornered>, Fault> {
    let runs: Vec<(bool, Control, Compensation)> = [false, true]
        .into_iter()
        .flat_map(|coupled| pairs().map(move |(control, of)| (coupled, control, of)))
        .collect();
    let runs: Result<Vec<Option<Cornered>>, ParamError> =
        runs.par_iter().map(|run| one(stage, *run, law)).collect();
    let runs = runs?;
    watch.done()?;
    Ok(runs.into_iter().flatten().collect())
}

fn one(
    stage: &Stage,
    (coupled, control, compensation): (bool, Control, Compensation),
    law: &LuGre<f64>,
) -> Result<Option<Cornered>, ParamError> {
    let Some(second) = stage.second(control) else {
        return Ok(None);
    };
    let corner = Along::new(Polygon::corner(SIDE)?, LIMITS)?;
    let second = second?;
    let other = *second.plant.law();
    let axes = [
        compensation.compensate(stage.settings(control)?, law)?,
        compensation.compensate(second, &other)?,
    ];
    let coupling = coupled.then(|| coupling(&axes)).transpose()?;
    let samples = TwoAxes { axes, coupling }.run_with(&corner, Ode4::new(1)?)?;
    // Both edges are the same.
    let turns = 0.5 * corner.duration();
    let time = |s: &PlaneSample| s.axes[0].time;
    let from = samples.partition_point(|s| time(s) < turns - EVALUATED_ABOUT_CORNER);
    let to = samples.partition_point(|s| time(s) <= turns + EVALUATED_ABOUT_CORNER);
    Ok(Some(Cornered {
        control,
        compensation,
        coupled,
        contour: Contour::of(&samples[from..to]),
        feed: Feed::along(&samples[from..to]),
        samples,
    }))
}

/// Tuned for the slower axis, limited to the feed.
fn coupling([x, y]: &[AxisSettings; 2]) -> Result<CrossCoupling, ParamError> {
    let coupling = CrossCoupling::tuned(BANDWIDTHS[1], LIMITS.velocity)?;
    Ok(coupling.above([&x.controller, &y.controller]))
}
