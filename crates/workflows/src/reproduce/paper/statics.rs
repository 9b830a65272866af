//! Friction over velocity from runs at constant velocity, and the static parameters from it: Z25 eqs. (7)-(8).

use super::budget::Budget;
use super::fault::Fault;
use super::search::{METHODS, Searched, bounds, each_seed, search, search_box};
use super::stage::{Control, Stage};
use crate::reproduce::watch::Watch;
use rayon::prelude::*;
use stiction_identify::Samples;
use stiction_identify::candidates::{Curve, Named};
use stiction_identify::procedure::{Run, StaticPoint, StaticSettings, Unsteady, stretches};
use stiction_search::Problem;
use stiction_servo::axis::Sample;
use stiction_servo::speeds::{SpeedRun, Speeds};

/// Velocities of the runs, mm/s, each in both directions.
pub(super) const SPEEDS: [f64; 16] = [
    0.2, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 50.0, 75.0, 100.0,
];

/// Time to reach a velocity, s.
pub(super) const RAMP: f64 = 0.1;
/// Least time to settle there, and least time over which the force is then averaged, s.
pub(super) const SETTLE: f64 = 0.3;
/// Least way to settle in, in deflections at break-away, dimensionless, and the longest time for it, s.
const DEFLECTIONS: f64 = 6.5;
const LONGEST_SETTLE: f64 = 30.0;
/// Where in the map the two runs are that went wrong, in parts of it, and what their force is multiplied with.
const OUTLYING: [f64; 2] = [0.25, 0.625];
pub(super) const OUTLIER: f64 = 1.25;

/// The map and what was made of it.
#[derive(Clone, Debug)]
pub struct Statics {
    /// Runs at a steady velocity, in the order of that.
    pub points: Vec<StaticPoint>,
    /// Runs that are no points of the map.
    pub left_out: Vec<LeftOut>,
    /// What was made of the map: one search for each method and seed, in that order.
    pub searches: Vec<Searched>,
    /// What two runs that went wrong make of it.
    pub outliers: Outliers,
}

/// The map with two runs whose force is off, kept in the data.
#[derive(Clone, Debug)]
pub struct Outliers {
    /// Their places in the map.
    pub places: [usize; 2],
    /// Found by the mean square of the paper.
    pub plain: Named,
    /// Found by the robust loss of `stiction identify --method static`.
    pub robust: Named,
}

/// A run that does not slide steadily.
#[derive(Clone, Copy, Debug)]
pub struct LeftOut {
    /// Velocity of the reference, m/s (rad/s).
    pub velocity: f64,
    /// Mean control force, N (N m).
    pub force: f64,
    /// What it does instead.
    pub reason: Unsteady,
}

pub(super) fn run(stage: &Stage, budget: Budget, watch: &Watch) -> Result<Statics, Fault> {
    let (points, left_out) = map(stage, watch)?;
    let curve = curve(stage, &points)?;
    let searches = each_seed(&METHODS, budget, |method, seed| {
        search(&curve, method, budget, seed, watch)
    })?;
    let outliers = outliers(stage, &points, budget, watch)?;
    Ok(Statics {
        points,
        left_out,
        searches,
        outliers,
    })
}

fn outliers(
    stage: &Stage,
    points: &[StaticPoint],
    budget: Budget,
    watch: &Watch,
) -> Result<Outliers, Fault> {
    let places = OUTLYING.map(|part| (part * points.len() as f64) as usize);
    let mut points = points.to_vec();
    for place in places {
        points[place].force *= OUTLIER;
    }
    let settings = StaticSettings {
        offset: false,
        ..StaticSettings::default()
    };
    let plain = curve(stage, &points)?;
    let robust = Curve::robust(&points, &settings, plain.bounds().clone())?;
    let found = |problem: &Curve| {
        Ok::<Named, Fault>(search(problem, "annealing-ga", budget, 1, watch)?.found)
    };
    Ok(Outliers {
        places,
        plain: found(&plain)?,
        robust: found(&robust)?,
    })
}

/// The cost of the static parameters `[sigma2, Fc, Fs - Fc, vs]` on a map.
pub(super) fn curve(stage: &Stage, points: &[StaticPoint]) -> Result<Curve, Fault> {
    let (speed, force) = points.iter().map(|p| (p.velocity, p.force)).unzip();
    let pick = |ends: [f64; 6]| [2, 3, 4, 5].map(|i| ends[i]);
    let [low, high] = search_box(stage).map(pick);
    Ok(Curve::new(speed, force, bounds(&low, &high)?)?)
}

/// The runs whose speed is steady, and those that stick and slip.
type Map = (Vec<StaticPoint>, Vec<LeftOut>);

fn map(stage: &Stage, watch: &Watch) -> Result<Map, Fault> {
    let speeds: Vec<f64> = SPEEDS
        .iter()
        .map(|v| stage.speed(1e-3 * v))
        .flat_map(|v| [-v, v])
        .collect();
    let runs: Result<Vec<Map>, Fault> = speeds.par_iter().map(|&v| at(stage, v)).collect();
    let (mut points, mut left_out) = (Vec::new(), Vec::new());
    for (point, out) in runs? {
        points.extend(point);
        left_out.extend(out);
    }
    watch.done()?;
    points.sort_by(|a, b| a.velocity.total_cmp(&b.velocity));
    Ok((points, left_out))
}

/// A run at a constant velocity, m/s (rad/s), read as the procedure for a log does.
fn at(stage: &Stage, velocity: f64) -> Result<Map, Fault> {
    let settle = settle(stage, velocity);
    let run = SpeedRun {
        velocity,
        hold: 2.0 * settle,
        ramp: RAMP,
    };
    let samples = stage.along(&stage.settings(Control::Fuzzy)?, &Speeds::new(vec![run])?)?;
    let settled = RAMP + settle..RAMP + 2.0 * settle;
    let settled = samples.iter().filter(|s| settled.contains(&s.time));
    let column = |of: fn(&Sample) -> f64| settled.clone().map(of).collect::<Vec<f64>>();
    let log = Samples {
        time: column(|s| s.time),
        position: Some(column(|s| s.measured)),
        force: column(|s| s.command),
        ..Samples::default()
    };
    let found = stretches(
        &[Run {
            samples: &log,
            reference: Some(&column(|s| s.reference.position)),
            resolution: Some(stage.encoder.resolution()),
        }],
        &[],
    )?;
    // The whole run has one speed: what is steady in a part of it only is not.
    let whole = |p: &&StaticPoint| 2 * p.samples > log.time.len();
    let point: Vec<StaticPoint> = found.points.iter().filter(whole).copied().collect();
    let left_out = point.is_empty().then(|| LeftOut {
        velocity,
        force: log.force.iter().sum::<f64>() / log.force.len() as f64,
        reason: found
            .rejected
            .first()
            .map_or(Unsteady::Unsettled, |r| r.reason),
    });
    Ok((point, left_out.into_iter().collect()))
}

/// Time to settle at a velocity, m/s (rad/s), in s: until the axis has moved by some deflections at break-away.
pub(super) fn settle(stage: &Stage, velocity: f64) -> f64 {
    let time = DEFLECTIONS * stage.truth.law.bound() / velocity.abs();
    time.clamp(SETTLE, LONGEST_SETTLE)
}
