//! A step of the voltage below break-away: Z25 eqs. (26)-(34).

use super::fault::Fault;
use super::law::law;
use super::stage::{Control, RATE, Stage};
use crate::reproduce::watch::Watch;
use stiction_friction::Direction;
use stiction_identify::candidates::Named;
use stiction_identify::procedure::{
    Inversion, Run, StepResponse, StepSeries, StepSettings, fit_steps,
};
use stiction_identify::{Samples, Silent};
use stiction_servo::integrator::{Integrator, Ode4};
use stiction_servo::plant::{Load, Motion};

/// Height of the step over the static level, dimensionless: 20 mV on our stage.
pub(super) const HEIGHT: f64 = 0.192;
/// When the step comes, s.
const STEP_AT: f64 = 0.01;
/// Least length of the record after it, s, and in parts of sqrt(M/sigma0), dimensionless: some nine periods of the swing on
/// the bristles.
const LEAST_RECORD: f64 = 0.09;
const SWINGS: f64 = 59.0;

/// The response, and the parameters that two methods find from it.
#[derive(Clone, Debug)]
pub struct Presliding {
    /// N
    pub height: f64,
    /// Parameters from displacement at rest and overshoot by second-order theory, as published.
    pub inverted: Inversion,
    /// Overshoot as a part of the displacement at rest.
    pub overshoot: Option<f64>,
    /// Displacement at rest, m.
    pub settled: f64,
    /// sigma0 (N/m) and sigma1 (N s/m) of a simulation fitted to the response.
    pub fitted: [f64; 2],
    /// Time, measured and fitted displacement.
    pub series: StepSeries,
    /// Time from the first sample shown, at which the force steps, s.
    pub onset: f64,
}

pub(super) fn run(stage: &Stage, identified: &Named, watch: &Watch) -> Result<Presliding, Fault> {
    let settings = stage.settings(Control::Fuzzy)?;
    let height = HEIGHT * stage.truth.law.curve().largest_static_level();
    let mut ode4 = Ode4::new(stage.steps)?;
    let mut log = Samples::default();
    let (mut motion, mut position) = (Motion::default(), Vec::new());
    let swing = libm::sqrt(stage.truth.mass / stage.truth.law.stiffness());
    let end = STEP_AT + LEAST_RECORD.max(SWINGS * swing);
    for k in 0..=(end * RATE).round() as usize {
        let time = k as f64 / RATE;
        let force = if time < STEP_AT { 0.0 } else { height };
        log.time.push(time);
        log.force.push(force);
        position.push(motion.position);
        motion = ode4.advance(&settings.plant, motion, 1.0 / RATE, Load::force(force), 0.0);
    }
    log.position = Some(position);
    let run = Run {
        samples: &log,
        reference: None,
        resolution: None,
    };
    let response = StepResponse::read(&run, 0)?;
    let found = law(identified)?;
    let side: Direction<f64> = *found.curve().positive();
    let mass = settings.plant.mass();
    let fit = fit_steps(
        &[(run, response.clone())],
        &StepSettings {
            mass: Some(mass),
            curve: Some(side),
            exponent: 2.0,
            offset: 0.0,
            given: [[0.0; 7]; 7],
        },
        &mut Silent,
    )?;
    watch.done()?;
    let value = |name: &str| fit.value(name).unwrap_or(f64::NAN);
    let series = fit.series.first().cloned();
    let series = series.unwrap_or(StepSeries {
        time: Vec::new(),
        measured: Vec::new(),
        model: Vec::new(),
    });
    // The series and the response end together.
    let until = log.time[response.range.end - 1] - log.time[response.onset];
    let last = series.time.last().copied().unwrap_or(0.0);
    Ok(Presliding {
        height,
        inverted: response.invert(Some(mass), side.viscous),
        overshoot: response.overshoot.map(|(_, part)| part),
        settled: response.settled,
        fitted: [value("sigma0"), value("sigma1")],
        series,
        onset: last - until,
    })
}
