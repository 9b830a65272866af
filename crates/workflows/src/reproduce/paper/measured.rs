//! The same steps from what a drive records, beside those from exact values: positions of an encoder with noise, from which
//! velocity and acceleration follow by filtering, and a force with noise.

use super::budget::Budget;
use super::dynamics::{cost, curve, sine, terms};
use super::fault::Fault;
use super::search::{Searched, search};
use super::stage::{Control as StageControl, RATE, Stage};
use super::statics::{self, Statics};
use crate::reproduce::watch::Watch;
use rayon::prelude::*;
use stiction_identify::candidates::{Candidates, Curve, Dynamic, Named, SixParameters};
use stiction_identify::{
    Conditioning, Law, LawKind, Mass, Samples, Settings, Source, condition, tune,
};
use stiction_policy::comparison;
use stiction_search::descent::{Region, damped_step};
use stiction_search::{Control, Derivatives, Fidelity, Points, Progress};
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
/// Most draws of the noise that are searched, n.
const DRAWS: u64 = 5;
/// Draws from which it is computed how far off encoder and noise allow a parameter to be, n.
const ALLOWED_DRAWS: u64 = 20;
/// Gauss-Newton steps from the true parameters, their damping, and the longest one in logarithms.
const STEPS: usize = 6;
const DAMPING: f64 = 1e-9;
const LONGEST: f64 = 1.0;

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

/// The searches of every draw, and how far off encoder and noise allow each parameter to be, as a part of its value.
pub(super) type Draws = (Vec<Measured>, Named);

/// How many draws are searched.
pub(super) fn draws(budget: Budget) -> u64 {
    budget.seeds.min(DRAWS)
}

/// One draw for each seed of the budget, up to some.
pub(super) fn run(
    stage: &Stage,
    exact: &Statics,
    budget: Budget,
    watch: &Watch,
) -> Result<Draws, Fault> {
    let budget = Budget {
        generations: budget.generations.min(GENERATIONS),
        rounds: budget.rounds.min(ROUNDS),
        seeds: draws(budget),
    };
    let conditioning = conditioning(&record(stage, 1)?, stage, watch)?;
    let test = Test {
        stage,
        exact,
        conditioning: &conditioning,
    };
    let drawn = (1..=budget.seeds).into_par_iter();
    let drawn: Result<Vec<Measured>, Fault> =
        drawn.map(|seed| test.search(budget, seed, watch)).collect();
    // Other draws than those that are searched.
    let others = (0..ALLOWED_DRAWS).into_par_iter();
    let found: Result<Vec<Named>, Fault> = others
        .map(|k| test.near_the_truth(budget.seeds + 1 + k))
        .collect();
    watch.done()?;
    Ok((drawn?, allowed(stage, &found?)))
}

/// Mean and deviation of what least squares find over draws make how far off a parameter may be: its bias and some
/// deviations, as a part of its true value.
fn allowed(stage: &Stage, draws: &[Named]) -> Named {
    let Some(first) = draws.first() else {
        return Named::new();
    };
    let n = draws.len() as f64;
    let names = first.iter().enumerate();
    names
        .map(|(i, (name, _))| {
            let truth = stage.true_value(&name.to_string());
            let off = draws.iter().map(|draw| draw[i].1 / truth - 1.0);
            let bias = off.clone().sum::<f64>() / n;
            let variance = off.map(|x| (x - bias) * (x - bias)).sum::<f64>() / n;
            (
                *name,
                bias.abs() + comparison::MAX_PAPER_DEVIATIONS * libm::sqrt(variance),
            )
        })
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

/// What a drive records of the tests of an axis.
struct Test<'a> {
    stage: &'a Stage,
    exact: &'a Statics,
    conditioning: &'a Conditioning,
}

impl Test<'_> {
    /// The map with the noise that is left of an averaged force.
    fn curve(&self, seed: u64) -> Result<Curve, Fault> {
        let mut noise = Noise::new(seed);
        let deviation = deviation(self.stage);
        let mut points = self.exact.points.clone();
        for point in &mut points {
            let averaged = (point.time.1 - point.time.0) * RATE;
            point.force += deviation / libm::sqrt(averaged) * noise.normal();
        }
        statics::curve(self.stage, &points)
    }

    /// The cost of all six on the record, conditioned as a log is.
    fn six(&self, seed: u64) -> Result<SixParameters, Fault> {
        let record = condition(&[record(self.stage, seed)?], self.conditioning)?;
        cost(self.stage, &record, Mass::Given(self.stage.truth.mass))
    }

    fn search(&self, budget: Budget, seed: u64, watch: &Watch) -> Result<Measured, Fault> {
        let statics = search(&self.curve(seed)?, "annealing-ga", budget, seed, watch)?;
        let held = Dynamic::new(self.six(seed)?, &curve(&statics.found))?;
        let two = search(&held, "annealing-ga", budget, seed, watch)?;
        let six = search(&self.six(seed)?, "annealing-ga", budget, seed, watch)?;
        Ok(Measured { statics, two, six })
    }

    /// What least squares from the true parameters find in both steps: as near as the record allows.
    fn near_the_truth(&self, seed: u64) -> Result<Named, Fault> {
        let truth = self.stage.point();
        let statics = least_squares(&self.curve(seed)?, &truth[2..]);
        let held = Dynamic::new(self.six(seed)?, &curve(&statics))?;
        let two = least_squares(&held, &truth[..2]).into_iter().take(2);
        Ok(two.chain(statics).collect())
    }
}

/// Parameters after a few Gauss-Newton steps from a point.
fn least_squares(problem: &impl Candidates, from: &[f64]) -> Named {
    let bounds = problem.bounds();
    let region = Region {
        low: bounds.low(),
        high: bounds.high(),
    };
    let mut point = from.to_vec();
    for _ in 0..STEPS {
        let mut points = Points::new(point.len());
        points.push(&point);
        let mut at = [Derivatives::zeros(point.len())];
        let known = problem.derivatives(&points, Fidelity::Full, &mut at);
        let step = damped_step(&at[0], None, &point, region, DAMPING, LONGEST);
        match step.filter(|_| known.is_ok()) {
            Some(step) => point = region.moved(&point, &step),
            None => break,
        }
    }
    problem.parameters(&point)
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
