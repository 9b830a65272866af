//! sigma0 and sigma1 from control force and acceleration, Z25 eqs. (35)-(38), the static parameters held; and all six at
//! once from the same record, by each of the three searches.

use super::budget::Budget;
use super::fault::Fault;
use super::search::{METHODS, Searched, bounds, each_seed, search, search_box};
use super::stage::{Control, RATE, Stage};
use crate::reproduce::watch::Watch;
use stiction_friction::{Direction, ParamError};
use stiction_identify::candidates::{Dynamic, Named, Scheme, SixParameters};
use stiction_identify::{
    Conditioning, Cutoff, Delay, Law, LawKind, Mass, Record, Samples, Source, Terms, condition,
};
use stiction_servo::motion::Sine;

/// Amplitude of the motion, m: through presliding six times, up to twice the Stribeck velocity.
pub(super) const AMPLITUDE: f64 = 0.5e-3;
/// Hz.
pub(super) const FREQUENCY: f64 = 2.0;
/// Whole cycles.
const CYCLES: f64 = 3.0;
/// Every n-th sample is fitted, n: 5 kHz of 10 kHz.
const FITTED_SAMPLE: usize = 2;

/// Both identifications, each with one search for each method and seed, in that order.
#[derive(Clone, Debug)]
pub struct Dynamics {
    /// sigma0 and sigma1 with the static parameters held.
    pub two: Vec<Searched>,
    /// All six at once.
    pub six: Vec<Searched>,
}

pub(super) fn run(
    stage: &Stage,
    statics: &Named,
    budget: Budget,
    watch: &Watch,
) -> Result<Dynamics, Fault> {
    let record = record(stage)?;
    watch.done()?;
    let cost = || cost(stage, &record, Mass::Absent);
    let (held, all) = (Dynamic::new(cost()?, &curve(statics))?, cost()?);
    let two = each_seed(&METHODS, budget, |method, seed| {
        search(&held, method, budget, seed, watch)
    })?;
    let six = each_seed(&METHODS, budget, |method, seed| {
        search(&all, method, budget, seed, watch)
    })?;
    Ok(Dynamics { two, six })
}

/// Friction `Ke u - M a` over the velocity. Force and acceleration are taken at the instant of the velocity: the mean
/// of the forces held before and after it, and the central difference.
fn record(stage: &Stage) -> Result<Record, Fault> {
    let mass = stage.truth.mass;
    let samples = stage.along(&stage.settings(Control::Fuzzy)?, &sine(stage)?)?;
    let mut log = Samples::default();
    let mut velocity = Vec::new();
    for three in samples.windows(3).step_by(FITTED_SAMPLE) {
        let [before, now, after] = three else {
            continue;
        };
        let acceleration = 0.5 * RATE * (after.velocity - before.velocity);
        let force = 0.5 * (before.command + now.command);
        log.time.push(now.time);
        velocity.push(now.velocity);
        log.force.push(force - mass * acceleration);
    }
    log.velocity = Some(velocity);
    let as_it_is = Conditioning {
        source: Some(Source::Velocity),
        source_cutoff: Cutoff::Off,
        common_cutoff: Cutoff::Off,
        ..Conditioning::default()
    };
    Ok(condition(&[log], &as_it_is)?)
}

/// The motion of the dynamic test.
pub(super) fn sine(stage: &Stage) -> Result<Sine, ParamError> {
    Sine::new(stage.stroke(AMPLITUDE), FREQUENCY, CYCLES)
}

/// The law alone, beside a mass.
pub(super) fn terms(mass: Mass) -> Terms {
    Terms {
        mass,
        offset: false,
        delay: Delay::NONE,
        ..Terms::default()
    }
}

/// The cost of all six parameters on a record.
pub(super) fn cost(stage: &Stage, record: &Record, mass: Mass) -> Result<SixParameters, Fault> {
    let terms = terms(mass);
    let law = Law::new(LawKind::LuGre);
    let [low, high] = search_box(stage);
    let bounds = bounds(&low, &high)?;
    Ok(SixParameters::new(
        record,
        law,
        &terms,
        bounds,
        Scheme::Explin,
    )?)
}

/// The steady curve that was found.
pub(super) fn curve(statics: &Named) -> Direction<f64> {
    let value = |name: &str| {
        let found = statics.iter().find(|(n, _)| n == name);
        found.map_or(f64::NAN, |(_, x)| *x)
    };
    Direction {
        coulomb: value("coulomb"),
        static_friction: value("static"),
        stribeck_velocity: value("stribeck_velocity"),
        viscous: value("sigma2"),
    }
}
