//! A sine tracked without compensation, with the law fed by the reference velocity, and with the law fed by the measured
//! one, as the paper draws it.

use super::fault::Fault;
use super::stage::{RATE, along, settings};
use crate::reproduce::watch::Watch;
use rayon::prelude::*;
use stiction_friction::compensator::{Compensator, Friction, Settings, Source};
use stiction_friction::{LuGre, ParamError};
use stiction_servo::axis::{AxisSettings, Sample};
use stiction_servo::feedforward::Feedforward;
use stiction_servo::metrics::Tracking;
use stiction_servo::motion::Sine;

/// m: 3.8 m/min at the most.
const AMPLITUDE: f64 = 20e-3;
/// Hz.
const FREQUENCY: f64 = 0.5;
/// Whole cycles, of which the last counts.
const CYCLES: f64 = 2.0;

/// Part of the force that is applied where the measured velocity drives the law, dimensionless: below 1, since this
/// compensation is a positive feedback of friction.
const MEASURED_GAIN: f64 = 0.9;

/// What drives the compensation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fed {
    /// Nothing: there is none.
    Nothing,
    /// The reference velocity.
    Reference,
    /// The measured velocity.
    Measured,
}

impl Fed {
    /// All of them, without compensation first.
    pub const ALL: [Fed; 3] = [Fed::Nothing, Fed::Reference, Fed::Measured];

    /// Name for tables.
    pub fn name(self) -> &'static str {
        match self {
            Fed::Nothing => "without",
            Fed::Reference => "reference velocity",
            Fed::Measured => "measured velocity",
        }
    }

    /// An axis with that compensation of an identified law.
    pub(super) fn compensate(
        self,
        settings: AxisSettings,
        law: &LuGre<f64>,
    ) -> Result<AxisSettings, ParamError> {
        let period = 1.0 / settings.rate;
        let whole = Settings::bare(period, settings.drive.peak_force());
        let (source, limits) = match self {
            Fed::Nothing => return Ok(settings),
            Fed::Reference => (Source::Reference, whole),
            Fed::Measured => {
                let gain = MEASURED_GAIN;
                (Source::Measured, Settings { gain, ..whole })
            }
        };
        let preview = match self {
            Fed::Reference => settings.drive.preview(period),
            _ => 0.0,
        };
        let compensator = Compensator::new(Friction::LuGre(*law), source, limits)?;
        Ok(AxisSettings {
            feedforward: Feedforward::compensator(compensator, preview),
            ..settings
        })
    }
}

/// One run: the second cycle, which counts.
#[derive(Clone, Debug)]
pub struct Tracked {
    /// What drives the compensation.
    pub fed: Fed,
    /// The cycle that counts.
    pub samples: Vec<Sample>,
    /// Friction force along the motion, N: of the law of the axis and of the identified one.
    pub friction: [Vec<f64>; 2],
    /// Tracking of the position.
    pub position: Tracking,
    /// Largest error of the velocity, m/s.
    pub speed_peak: f64,
    /// Rms error of the velocity, m/s.
    pub speed_rms: f64,
}

pub(super) fn run(law: &LuGre<f64>, watch: &Watch) -> Result<Vec<Tracked>, Fault> {
    let runs: Result<Vec<Tracked>, ParamError> =
        Fed::ALL.par_iter().map(|fed| one(*fed, law)).collect();
    let runs = runs?;
    watch.done()?;
    Ok(runs)
}

fn one(fed: Fed, law: &LuGre<f64>) -> Result<Tracked, ParamError> {
    let settings = fed.compensate(settings()?, law)?;
    let sine = Sine::new(AMPLITUDE, FREQUENCY, CYCLES)?;
    let all = along(&settings, &sine)?;
    let laws = [settings.plant.law(), law];
    let from = all.len() / 2;
    let samples = all[from..].to_vec();
    let off = |s: &Sample| s.reference.velocity - s.velocity;
    let squares: f64 = samples.iter().map(|s| off(s) * off(s)).sum();
    Ok(Tracked {
        fed,
        position: Tracking::of(&samples),
        speed_peak: samples.iter().fold(0.0, |m, s| m.max(off(s).abs())),
        speed_rms: libm::sqrt(squares / samples.len() as f64),
        friction: laws.map(|law| friction(law, &all).split_off(from)),
        samples,
    })
}

/// The force that a law gives along a motion from rest, N.
fn friction(law: &LuGre<f64>, motion: &[Sample]) -> Vec<f64> {
    let mut z = 0.0;
    let mut force = Vec::with_capacity(motion.len());
    for (i, sample) in motion.iter().enumerate() {
        force.push(law.force(z, sample.velocity));
        if let Some(next) = motion.get(i + 1) {
            z = law.step_record(z, 1.0 / RATE, sample.velocity, next.velocity);
        }
    }
    force
}
