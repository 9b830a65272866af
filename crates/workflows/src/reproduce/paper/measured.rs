//! The same steps from what a drive records, beside those from exact values: positions of an encoder with noise, from which
//! velocity and acceleration follow by filtering, and a force with noise.

use super::budget::Budget;
use super::dynamics::{cost, curve, sine, terms};
use super::fault::Fault;
use super::search::{Searched, search};
use super::stage::{Control as StageControl, RATE, Stage};
use super::statics::{self, MEAN, Statics};
use crate::reproduce::watch::Watch;
use rayon::prelude::*;
use stiction_identify::candidates::Dynamic;
use stiction_identify::{
    Conditioning, Law, LawKind, Mass, Samples, Settings, Source, condition, tune,
};
use stiction_search::{Control, Progress};
use stiction_servo::axis::AxisSettings;
use stiction_servo::noise::Noise;

/// Deviation of the noise of the force, in parts of the static level, dimensionless.
const FORCE_NOISE: f64 = 0.01;
/// Deviation of the noise of the position before the encoder, in its steps, dimensionless.
const POSITION_NOISE: f64 = 0.5;

/// Every n-th sample is logged, n: 5 kHz of 10 kHz.
const LOGGED_SAMPLE: usize = 2;
/// Generations of a round and rounds of its searches, at the most: least squares follow, and an evaluation takes longer than
/// with exact values, since all passes the filters.
const GENERATIONS: usize = 20;
const ROUNDS: usize = 2;

/// What one draw of the noise leads to.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Static parameters.
    pub statics: Searched,
    /// sigma0 and sigma1 with those held.
    pub two: Searched,
    /// All six at once.
    pub six: Searched,
}

/// One draw for each seed of the budget.
pub(super) fn run(
    stage: &Stage,
    exact: &Statics,
    budget: Budget,
    watch: &Watch,
) -> Result<Vec<Measured>, Fault> {
    let seeds: Vec<u64> = (1..=budget.seeds).collect();
    let budget = Budget {
        generations: budget.generations.min(GENERATIONS),
        rounds: budget.rounds.min(ROUNDS),
        ..budget
    };
    let Some(first) = seeds.first() else {
        return Ok(Vec::new());
    };
    let conditioning = conditioning(&record(stage, *first)?, stage, watch)?;
    let drawn = seeds.par_iter();
    drawn
        .map(|seed| one(stage, exact, &conditioning, budget, *seed, watch))
        .collect()
}

/// The filters, with cut-offs that suit the record of an axis: as for the log of any drive.
fn conditioning(record: &Samples, stage: &Stage, watch: &Watch) -> Result<Conditioning, Fault> {
    let wanted = Conditioning {
        source: Some(Source::Position),
        ..Conditioning::default()
    };
    let terms = terms(Mass::Given(stage.truth.mass));
    let law = Law::new(LawKind::LuGre);
    let mut watched = |_: &Progress| match watch.stopped() {
        true => Control::Stop,
        false => Control::Continue,
    };
    let records = std::slice::from_ref(record);
    let tuned = tune(
        records,
        &wanted,
        law,
        &terms,
        &Settings::default(),
        &mut watched,
    )?;
    match tuned.interrupted {
        true => Err(Fault::Stopped),
        false => Ok(tuned.conditioning),
    }
}

fn one(
    stage: &Stage,
    exact: &Statics,
    conditioning: &Conditioning,
    budget: Budget,
    seed: u64,
    watch: &Watch,
) -> Result<Measured, Fault> {
    let mut noise = Noise::new(seed);
    let averaged = deviation(stage) / libm::sqrt(MEAN * RATE);
    let force = exact.force.iter();
    let force = force.map(|f| f + averaged * noise.normal()).collect();
    let statics = statics::identify(stage, (exact.speed.clone(), force), budget, seed, watch)?;
    let record = condition(&[record(stage, seed)?], conditioning)?;
    let mass = Mass::Given(stage.truth.mass);
    let held = Dynamic::new(cost(stage, &record, mass)?, &curve(&statics.found))?;
    let two = search(&held, "annealing-ga", budget, seed, watch)?;
    let cost = cost(stage, &record, mass)?;
    let six = search(&cost, "annealing-ga", budget, seed, watch)?;
    Ok(Measured { statics, two, six })
}

/// Deviation of the noise of the force, N (N m).
fn deviation(stage: &Stage) -> f64 {
    FORCE_NOISE * stage.truth.law.curve().largest_static_level()
}

/// The motion of the dynamic test as the encoder shows it, under a force with noise.
fn record(stage: &Stage, seed: u64) -> Result<Samples, Fault> {
    let settings = AxisSettings {
        position_noise: POSITION_NOISE * stage.encoder.resolution(),
        seed,
        ..stage.settings(StageControl::Fuzzy)?
    };
    let samples = stage.along(&settings, &sine(stage)?)?;
    // Another stream than that of the constant velocities and of the encoder.
    let mut noise = Noise::new(!seed);
    let deviation = deviation(stage);
    let mut log = Samples::default();
    let mut position = Vec::new();
    for pair in samples.windows(2).step_by(LOGGED_SAMPLE) {
        let [before, now] = pair else {
            continue;
        };
        log.time.push(now.time);
        position.push(now.measured);
        // The mean of the forces held before and after the instant.
        let force = 0.5 * (before.command + now.command);
        log.force.push(force + deviation * noise.normal());
    }
    log.position = Some(position);
    Ok(log)
}
