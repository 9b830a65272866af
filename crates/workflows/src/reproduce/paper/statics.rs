//! Friction over velocity from runs at constant velocity, and the static parameters from it: Z25 eqs. (7)-(8).

use super::budget::Budget;
use super::fault::Fault;
use super::search::{Searched, bounds, search, search_box};
use super::stage::{Control, Stage};
use crate::reproduce::watch::Watch;
use rayon::prelude::*;
use stiction_friction::ParamError;
use stiction_identify::candidates::Curve;
use stiction_servo::speeds::{SpeedRun, Speeds};

/// Velocities of the runs, mm/s, each in both directions.
pub(super) const SPEEDS: [f64; 16] = [
    0.2, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 50.0, 75.0, 100.0,
];

/// Time to reach a velocity, s.
const RAMP: f64 = 0.1;
/// Least time to settle there, s.
pub(super) const SETTLE: f64 = 0.3;
/// Least way to settle in, in deflections at break-away, dimensionless, and the longest time for it, s.
const DEFLECTIONS: f64 = 6.5;
const LONGEST_SETTLE: f64 = 30.0;
/// Time over which the force is averaged, s.
pub(super) const MEAN: f64 = 0.3;

/// The map and what was made of it.
#[derive(Clone, Debug)]
pub struct Statics {
    /// m/s
    pub speed: Vec<f64>,
    /// Mean control force, N.
    pub force: Vec<f64>,
    /// What was made of them.
    pub search: Searched,
}

pub(super) fn run(stage: &Stage, budget: Budget, watch: &Watch) -> Result<Statics, Fault> {
    let (speed, force) = map(stage, watch)?;
    let search = identify(stage, (speed.clone(), force.clone()), budget, 1, watch)?;
    Ok(Statics {
        speed,
        force,
        search,
    })
}

/// The static parameters of a map of speeds and forces.
pub(super) fn identify(
    stage: &Stage,
    (speed, force): (Vec<f64>, Vec<f64>),
    budget: Budget,
    seed: u64,
    watch: &Watch,
) -> Result<Searched, Fault> {
    // sigma2, Fc, Fs - Fc, vs.
    let pick = |ends: [f64; 6]| [2, 3, 4, 5].map(|i| ends[i]);
    let [low, high] = search_box(stage).map(pick);
    let curve = Curve::new(speed, force, bounds(&low, &high)?)?;
    search(&curve, "annealing-ga", budget, seed, watch)
}

fn map(stage: &Stage, watch: &Watch) -> Result<(Vec<f64>, Vec<f64>), Fault> {
    let speeds: Vec<f64> = SPEEDS
        .iter()
        .map(|v| stage.speed(1e-3 * v))
        .flat_map(|v| [-v, v])
        .collect();
    let points: Result<Vec<(f64, f64)>, ParamError> =
        speeds.par_iter().map(|&v| Ok((v, at(stage, v)?))).collect();
    let mut points = points?;
    watch.done()?;
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(points.into_iter().unzip())
}

/// Mean control force, N, at a constant velocity, m/s.
fn at(stage: &Stage, velocity: f64) -> Result<f64, ParamError> {
    let settle = settle(stage, velocity);
    let run = SpeedRun {
        velocity,
        hold: settle + MEAN,
        ramp: RAMP,
    };
    let samples = stage.along(&stage.settings(Control::Fuzzy)?, &Speeds::new(vec![run])?)?;
    let settled = RAMP + settle..RAMP + settle + MEAN;
    let forces = samples.iter().filter(|s| settled.contains(&s.time));
    let (sum, n) = forces.fold((0.0, 0.0), |(sum, n), s| (sum + s.command, n + 1.0));
    Ok(sum / n)
}

/// Time to settle at a velocity, m/s (rad/s), in s: until the axis has moved by some deflections at break-away.
fn settle(stage: &Stage, velocity: f64) -> f64 {
    let time = DEFLECTIONS * stage.truth.law.bound() / velocity.abs();
    time.clamp(SETTLE, LONGEST_SETTLE)
}
