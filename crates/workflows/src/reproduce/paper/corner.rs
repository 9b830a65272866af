//! A corner of two axes, and the deviation from it.

use super::fault::Fault;
use super::stage::{second, settings};
use super::tracking::Fed;
use crate::reproduce::watch::Watch;
use rayon::prelude::*;
use stiction_friction::{LuGre, ParamError};
use stiction_servo::integrator::Ode4;
use stiction_servo::metrics::Contour;
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
    /// What drives the compensation.
    pub fed: Fed,
    /// The whole run.
    pub samples: Vec<PlaneSample>,
    /// About the corner.
    pub contour: Contour,
}

pub(super) fn run(law: &LuGre<f64>, watch: &Watch) -> Result<Vec<Cornered>, Fault> {
    let runs: Result<Vec<Cornered>, ParamError> =
        Fed::ALL.par_iter().map(|fed| one(*fed, law)).collect();
    let runs = runs?;
    watch.done()?;
    Ok(runs)
}

fn one(fed: Fed, law: &LuGre<f64>) -> Result<Cornered, ParamError> {
    let corner = Along::new(Polygon::corner(SIDE)?, LIMITS)?;
    let second = second()?;
    let other = *second.plant.law();
    let axes = [
        fed.compensate(settings()?, law)?,
        fed.compensate(second, &other)?,
    ];
    let plane = TwoAxes {
        axes,
        coupling: None,
    };
    let samples = plane.run_with(&corner, Ode4::new(1)?)?;
    // Both edges are the same.
    let turns = 0.5 * corner.duration();
    let time = |s: &PlaneSample| s.axes[0].time;
    let from = samples.partition_point(|s| time(s) < turns - EVALUATED_ABOUT_CORNER);
    let to = samples.partition_point(|s| time(s) <= turns + EVALUATED_ABOUT_CORNER);
    Ok(Cornered {
        fed,
        contour: Contour::of(&samples[from..to]),
        samples,
    })
}
