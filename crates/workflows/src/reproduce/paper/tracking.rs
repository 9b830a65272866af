//! A sine tracked under each controller with each compensation.

use super::compensation::Compensation;
use super::fault::Fault;
use super::stage::{Control, RATE, Stage};
use crate::reproduce::watch::Watch;
use rayon::prelude::*;
use stiction_friction::{LuGre, ParamError};
use stiction_servo::axis::Sample;
use stiction_servo::metrics::{Feed, Tracking, reversals};
use stiction_servo::motion::Sine;

/// m: 3.8 m/min at the most.
pub(super) const AMPLITUDE: f64 = 20e-3;
/// Hz.
pub(super) const FREQUENCY: f64 = 0.5;
/// Cycles: 3 s, as long as the paper simulates.
const CYCLES: f64 = 1.5;
/// What counts begins in the middle of the first stroke, s: two reversals.
pub(super) const COUNTS_FROM: f64 = 0.5;

/// One run: the part that counts.
#[derive(Clone, Debug)]
pub struct Tracked {
    /// The controller.
    pub control: Control,
    /// What compensates.
    pub compensation: Compensation,
    /// The samples that count.
    pub samples: Vec<Sample>,
    /// Friction force along the motion, N: of the law of the axis and of the identified one.
    pub friction: [Vec<f64>; 2],
    /// The last reversal of the reference, s.
    pub reversal: f64,
    /// Tracking of the position.
    pub position: Tracking,
    /// Error of the velocity.
    pub feed: Option<Feed>,
}

impl Tracked {
    /// Whether it stands in the pictures.
    pub fn is_drawn(&self) -> bool {
        self.control == Control::Fuzzy && self.compensation.is_drawn()
    }
}

/// Every compensation under one controller, then under the other.
pub(super) fn pairs() -> impl Iterator<Item = (Control, Compensation)> {
    Control::ALL
        .into_iter()
        .flat_map(|control| Compensation::ALL.map(|compensation| (control, compensation)))
}

pub(super) fn run(stage: &Stage, law: &LuGre<f64>, watch: &Watch) -> Result<Vec<Tracked>, Fault> {
    let pairs: Vec<(Control, Compensation)> = pairs().collect();
    let runs: Result<Vec<Tracked>, ParamError> = pairs
        .par_iter()
        .map(|pair| one(stage, *pair, law))
        .collect();
    let runs = runs?;
    watch.done()?;
    Ok(runs)
}

fn one(
    stage: &Stage,
    (control, compensation): (Control, Compensation),
    law: &LuGre<f64>,
) -> Result<Tracked, ParamError> {
    let settings = compensation.compensate(stage.settings(control)?, law)?;
    let all = stage.along(&settings, &sine(stage)?)?;
    let laws = [settings.plant.law(), law];
    let from = counts_from(&all);
    let samples = all[from..].to_vec();
    Ok(Tracked {
        control,
        compensation,
        reversal: reversals(&samples).last().copied().unwrap_or(f64::NAN),
        position: Tracking::of(&samples),
        feed: Feed::of(&samples),
        friction: laws.map(|law| friction(law, &all).split_off(from)),
        samples,
    })
}

/// The reference.
pub(super) fn sine(stage: &Stage) -> Result<Sine, ParamError> {
    Sine::new(stage.stroke(AMPLITUDE), FREQUENCY, CYCLES)
}

/// The first sample that counts.
pub(super) fn counts_from(samples: &[Sample]) -> usize {
    samples.partition_point(|s| s.time < COUNTS_FROM)
}

/// The force that a law gives along a motion from rest, N.
pub(super) fn friction(law: &LuGre<f64>, motion: &[Sample]) -> Vec<f64> {
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
