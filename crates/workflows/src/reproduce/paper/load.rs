//! A load taken up while running, and the mass found by recursive least squares: Z25 Fig. 14.

use super::fault::Fault;
use super::stage::{Control, RATE, Stage};
use crate::reproduce::watch::Watch;
use stiction_friction::LuGre;
use stiction_servo::axis::{Axis, Correction};
use stiction_servo::integrator::Ode4;
use stiction_servo::load::{LoadEstimator, LoadSettings};
use stiction_servo::motion::Sine;
use stiction_servo::trajectory::{Lookahead, Trajectory};

/// The mass after the change, kg.
pub(super) const HEAVIER: f64 = 6.9;
/// When the change comes, s.
pub(super) const CHANGE_AT: f64 = 2.0;
/// m, Hz, and cycles of the motion.
const SINE: (f64, f64, f64) = (15e-3, 1.5, 6.0);

/// The course of the estimate.
#[derive(Clone, Debug)]
pub struct LoadFound {
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

pub(super) fn run(stage: &Stage, law: &LuGre<f64>, watch: &Watch) -> Result<LoadFound, Fault> {
    let settings = stage.settings(Control::Fuzzy)?;
    let before = stage.truth.mass;
    let defaults = LoadSettings::default();
    let mut estimator = LoadEstimator::new(*law, before, settings.drive, RATE, defaults)?;
    let mut axis = Axis::new(settings, Ode4::new(1)?)?;
    let (amplitude, frequency, cycles) = SINE;
    let sine = Sine::new(amplitude, frequency, cycles)?;
    let mut reference = Lookahead::new(&sine, RATE, 0.0);
    let mut found = LoadFound {
        time: Vec::new(),
        mass: [Vec::new(), Vec::new()],
        level: Vec::new(),
    };
    let change = (CHANGE_AT * RATE) as usize;
    for k in 0..(sine.duration() * RATE) as usize {
        if k == change {
            axis.set_mass(HEAVIER)?;
        }
        let (now, ahead) = reference.sample();
        let sample = axis.step(now, ahead, Correction::default());
        let load = estimator.sample(sample.measured, sample.command);
        found.time.push(sample.time);
        found.mass[0].push(if k < change { before } else { HEAVIER });
        found.mass[1].push(load.mass);
        found.level.push(load.level);
    }
    watch.done()?;
    Ok(found)
}
