//! A load taken up while running, and the mass found by recursive least squares: Z25 Fig. 14.

use super::fault::Fault;
use super::stage::{Control, RATE, Stage};
use crate::reproduce::watch::Watch;
use rayon::prelude::*;
use stiction_friction::{LuGre, ParamError};
use stiction_servo::axis::{Axis, Correction};
use stiction_servo::integrator::Ode4;
use stiction_servo::load::{LoadEstimator, LoadSettings};
use stiction_servo::motion::Sine;
use stiction_servo::trajectory::{Lookahead, Trajectory};

/// Masses after the change over that before, dimensionless.
pub(super) const HEAVIER: [f64; 3] = [1.25, 1.5, 2.0];
/// When the change comes, s.
pub(super) const CHANGE_AT: f64 = 1.0;
/// m, Hz, and cycles of the motion on our stage: 3 s.
const SINE: (f64, f64, f64) = (15e-3, 1.5, 4.5);
/// Mass, kg, and Coulomb friction, N, of our stage, for which the stroke is chosen: there inertia is half of friction.
const OURS: (f64, f64) = (4.6, 12.0);

/// The course of the estimate.
#[derive(Clone, Debug)]
pub struct LoadFound {
    /// The mass after the change, kg (kg m^2).
    pub heavier: f64,
    /// s
    pub time: Vec<f64>,
    /// True and found mass, kg.
    pub mass: [Vec<f64>; 2],
    /// Estimated level of friction as a multiple of the identified one, dimensionless.
    pub level: Vec<f64>,
}

impl LoadFound {
    /// The mass believed at the end, kg.
    pub fn last(&self) -> f64 {
        self.mass[1].last().copied().unwrap_or(f64::NAN)
    }
}

/// One run for each load.
pub(super) fn run(stage: &Stage, law: &LuGre<f64>, watch: &Watch) -> Result<Vec<LoadFound>, Fault> {
    let loads: Result<Vec<LoadFound>, ParamError> = HEAVIER
        .par_iter()
        .map(|part| one(stage, *part, law))
        .collect();
    let loads = loads?;
    watch.done()?;
    Ok(loads)
}

fn one(stage: &Stage, part: f64, law: &LuGre<f64>) -> Result<LoadFound, ParamError> {
    let settings = stage.settings(Control::Fuzzy)?;
    let before = stage.truth.mass;
    let heavier = part * before;
    // As much inertia beside friction as on our stage.
    let (mass, coulomb) = OURS;
    let scale = (stage.truth.law.curve().positive().coulomb / coulomb) / (before / mass);
    let ours = LoadSettings::default();
    let learning = LoadSettings {
        least_acceleration: scale * ours.least_acceleration,
        ..ours
    };
    let mut estimator = LoadEstimator::new(*law, before, settings.drive, RATE, learning)?;
    let mut axis = Axis::new(settings, Ode4::new(stage.steps)?)?;
    let (amplitude, frequency, cycles) = SINE;
    let sine = Sine::new(scale * amplitude, frequency, cycles)?;
    let mut reference = Lookahead::new(&sine, RATE, 0.0);
    let mut found = LoadFound {
        heavier,
        time: Vec::new(),
        mass: [Vec::new(), Vec::new()],
        level: Vec::new(),
    };
    let change = (CHANGE_AT * RATE) as usize;
    for k in 0..(sine.duration() * RATE) as usize {
        if k == change {
            axis.set_mass(heavier)?;
        }
        let (now, ahead) = reference.sample();
        let sample = axis.step(now, ahead, Correction::default());
        let load = estimator.sample(sample.measured, sample.command);
        found.time.push(sample.time);
        found.mass[0].push(if k < change { before } else { heavier });
        found.mass[1].push(load.mass);
        found.level.push(load.level);
    }
    Ok(found)
}
