//! Output error: force in, position out. The axis is simulated and its position fitted.
//!
//! Where the force is what was applied (open loop), it drives the simulated axis. Where a controller
//! whose law is known made the force (closed loop), the controller runs on the recorded reference and
//! the *simulated* position, and position and force are both compared with the log: each counts by
//! its own residual, which is maximum likelihood for two channels of unknown noise.
//!
//! ```text
//! Recording --run--> Run --problem--> cost, J^T J --descent--> Point --estimate--> SimulationFit
//! ```
//!
//! Nothing is differentiated or filtered, so an encoder with coarse steps is sufficient. Position, velocity and
//! bristle deflection at the start of each run are unknowns too. The derivatives are those of the
//! computed step (forward sensitivities through the implicit midpoint step, by the implicit function
//! theorem): exact, whatever the step size.
//!
//! See Ljung 1999, System Identification, section 4.3 (output-error models); Janot, Gautier, Brunot
//! 2019 for the same on the EMPS benchmark.

pub(crate) mod bristles;
pub(crate) mod controller;
pub(crate) mod covariance;
pub(crate) mod dead_time;
pub(crate) mod descent;
pub(crate) mod drawn;
pub(crate) mod elements;
pub(crate) mod outcome;
pub(crate) mod physical;
pub(crate) mod places;
pub(crate) mod plant;
pub(crate) mod problem;
pub(crate) mod run;
pub(crate) mod rungs;
pub(crate) mod search;
pub(crate) mod signals;
pub(crate) mod simulate;
pub(crate) mod start;
pub(crate) mod unknowns;
pub(crate) mod unseen;

use crate::conditioning::losses::Losses;
use crate::error::Error;
use crate::estimate::Estimate;
use crate::law::Law;
use crate::law::terms::{Delay, Mass, Terms};
use crate::output_error::controller::Controller;
use crate::output_error::outcome::SimulationFit;
use crate::output_error::run::{Hold, Recording, Run};
use crate::output_error::rungs::Ladder;
use crate::output_error::search::Found;
use crate::output_error::start::Scale;
use crate::output_error::unknowns::{Layout, Unknown};
use crate::watch::Watch;
use stiction_search::{Observer, Stage};

/// How recordings are simulated and fitted.
#[derive(Clone, Debug, Default)]
pub struct Simulation<'a> {
    /// The controller that made the force; `None` where the force is what was applied.
    pub controller: Option<Controller>,
    /// How the logged force relates in time to the instants of the samples.
    pub hold: Hold,
    /// Open loop: longest stretch that is simulated from one free start, s; `None` for whole runs.
    pub segment: Option<f64>,
    /// One encoder count, m or rad, where known.
    pub quantum: Option<f64>,
    /// A fit of the same axis to start from, such as the separable one; `None` starts from the runs alone.
    pub start: Option<&'a Estimate>,
}

/// Fits a law with its mass and terms by simulation.
///
/// # Errors
/// Where a recording cannot be simulated: no position, no reference although a controller is given, no
/// motion, no force, a force without inertia. A search that ends badly is a [`Status`](crate::Status).
pub fn output_error(
    recordings: &[Recording],
    law: Law,
    terms: &Terms,
    simulation: &Simulation,
    observer: &mut dyn Observer,
) -> Result<SimulationFit, Error> {
    if let Some(controller) = &simulation.controller {
        controller.validate()?;
    }
    match terms.mass {
        Mass::Absent => {
            return Err(Error::NotSimulated {
                log: 1,
                found: "mass = \"none\"",
                allowed: "a mass, given or fitted: without one a force moves nothing",
            });
        }
        Mass::Given(mass) if !(mass > 0.0 && mass.is_finite()) => {
            return Err(Error::Setting {
                name: "mass",
                found: mass,
                allowed: "finite and above 0",
            });
        }
        _ => {}
    }
    let runs = run::runs(
        recordings,
        simulation.controller.as_ref(),
        simulation.segment,
    )?;
    let mut terms = terms.clone();
    if simulation.controller.is_some() && simulation.hold == Hold::Centred {
        // What a sensor shows is the force that acts: it says nothing of when that was asked for.
        terms.delay = Delay::NONE;
    }
    let mut law = law;
    if law.kind.has_elements() && law.elements == 0 {
        law.elements = elements_of(simulation.start).unwrap_or(ELEMENTS);
    }
    let kept: usize = runs
        .iter()
        .map(|r| r.keep.iter().filter(|&&k| k).count())
        .sum();
    let mut needed = 10 * Layout::new(&law, &terms).len() + 4 * runs.len();
    if simulation.controller.is_none() {
        let all = runs.iter().map(|r| r.keep.len()).sum();
        needed = needed.max(Losses::needed_to_simulate(all));
    }
    if kept < needed || runs.is_empty() {
        let whole: usize = runs.iter().map(|r| r.keep.len()).sum();
        return Err(Error::TooFewSamples {
            found: kept,
            needed,
            losses: run::losses(recordings, whole, kept),
        });
    }
    let scale = Scale::of(&runs, simulation).ok_or_else(|| nothing(&runs))?;
    let mut watch = Watch::new(observer, Stage::Scan);
    let ladder = Ladder::new(&runs, simulation, &scale);
    let mut found = ladder.climb(&law, &terms, &mut watch);
    // A delay at the end of its range is something else that the law does not explain.
    if found
        .as_ref()
        .is_some_and(|found| is_beyond(found, &law, &terms, &scale))
    {
        terms.delay = Delay::NONE;
        found = ladder.climb(&law, &terms, &mut watch);
    }
    let found = found.ok_or_else(|| nothing(&runs))?;
    let layout = Layout::new(&law, &terms);
    let search = ladder.search(&runs, &layout);
    let mut fit = outcome::describe(&search, found, law, &terms, watch.counts);
    if let Some(controller) = &simulation.controller
        && let Some((log, time)) = fit.signals.diverged()
    {
        return Err(Error::Diverged {
            log,
            time,
            position_gain: controller.position_gain,
            speed_gain: controller.speed_gain,
        });
    }
    fit.judge_horizons(recordings, &mut watch);
    Ok(fit)
}

/// Elements of a Maxwell-slip law whose number nothing says. The fit of the force chooses by blocks that it leaves out; a run
/// that is simulated whole has no such blocks.
const ELEMENTS: usize = 4;

/// Elements that an earlier fit of the same axis has.
fn elements_of(start: Option<&Estimate>) -> Option<usize> {
    let elements = start.map(|found| found.law.elements);
    elements.filter(|&many| many > 0)
}

/// Whether a fitted delay ended at an end of its range that is a choice.
fn is_beyond(found: &Found, law: &Law, terms: &Terms, scale: &Scale) -> bool {
    let delay = Layout::new(law, terms).place(Unknown::Delay);
    let q = &found.descent.at.q;
    delay.is_some_and(|i| found.bounds.at_bound(q, i) && !scale.acts_at_once(q[i]))
}

/// Why nothing can be identified from runs that have no scale.
fn nothing(runs: &[Run]) -> Error {
    let top = runs
        .iter()
        .flat_map(|r| r.force.iter())
        .fold(0.0_f64, |m, f| m.max(f.abs()));
    if top > 0.0 {
        Error::NoMotion {
            bound: 0.0,
            unit: "",
        }
    } else {
        Error::NoForce { value: top }
    }
}

#[cfg(test)]
mod tests;
