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
//! Nothing is differentiated or filtered, so an encoder of a few counts will do. Position, velocity and
//! bristle deflection at the start of each run are unknowns too. The derivatives are those of the
//! computed step (forward sensitivities through the implicit midpoint step, by the implicit function
//! theorem): exact, whatever the step size.
//!
//! See Ljung 1999, System Identification, section 4.3 (output-error models); Janot, Gautier, Brunot
//! 2019 for the same on the EMPS benchmark.

pub(crate) mod controller;
pub(crate) mod descent;
pub(crate) mod outcome;
pub(crate) mod plant;
pub(crate) mod problem;
pub(crate) mod run;
pub(crate) mod simulate;
pub(crate) mod start;
pub(crate) mod unknowns;

use crate::error::Error;
use crate::estimate::Estimate;
use crate::law::Law;
use crate::law::terms::{Mass, Terms};
use crate::observe::{Counts, Observer, Stage};
use crate::output_error::controller::Controller;
use crate::output_error::descent::{Bounds, Descent, descend};
use crate::output_error::outcome::SimulationFit;
use crate::output_error::plant::Axis;
use crate::output_error::problem::{Point, Problem};
use crate::output_error::run::{Hold, Recording, Run};
use crate::output_error::simulate::{Drive, simulate};
use crate::output_error::start::Scale;
use crate::output_error::unknowns::Layout;
use crate::separable::levenberg::{Status, Watch};

/// How recordings are simulated and fitted.
#[derive(Clone, Debug, Default)]
pub struct Simulation<'a> {
    /// The controller that made the force; `None` where the force is what was applied.
    pub controller: Option<Controller>,
    /// How the logged force stands to the instants of the samples.
    pub hold: Hold,
    /// Open loop: longest stretch that is simulated from one free start, s; `None` for whole runs.
    pub segment: Option<f64>,
    /// One encoder count, m or rad, where known.
    pub quantum: Option<f64>,
    /// A fit of the same axis to start from, such as the separable one; else only the runs themselves.
    pub start: Option<&'a Estimate>,
}

/// Guesses that are followed by a short descent.
const FOLLOWED: usize = 6;
/// Steps of a short descent, and of the last one.
const SHORT: usize = 15;
const LONG: usize = 200;
/// Largest `h sqrt(s0/M)` that a plant step is given at the start.
const STIFFEST: f64 = 0.7;
/// Most plant steps in one control period.
const MOST_SUBSTEPS: usize = 16;
/// Rounds of weighing position against force, and the change of a weight that ends them.
const ROUNDS: usize = 6;
const SETTLED: f64 = 0.02;

/// Fits a law with its mass and terms by simulation.
///
/// # Errors
/// Where a recording cannot be simulated: no position, no reference although a controller is given, no
/// motion, no force, a force without inertia. A search that ends badly is a [`Status`].
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
    let layout = Layout::new(&law, terms);
    let kept: usize = runs
        .iter()
        .map(|r| r.keep.iter().filter(|&&k| k).count())
        .sum();
    let needed = 10 * layout.len() + 4 * runs.len();
    if kept < needed || runs.is_empty() {
        let total = recordings.iter().map(|r| r.samples.time.len()).sum();
        return Err(Error::TooFewSamples {
            found: kept,
            needed,
            dropped: total - kept.min(total),
            total,
        });
    }
    let scale = Scale::of(&runs, simulation.quantum).ok_or_else(|| nothing(&runs))?;
    let mut watch = Watch {
        observer,
        stage: Stage::Scan,
        fraction: 0.0,
        counts: Counts::default(),
        best: f64::INFINITY,
        stopped: false,
    };
    let search = Search {
        runs: &runs,
        layout: &layout,
        simulation,
        scale: &scale,
    };
    let known = simulation
        .start
        .and_then(|found| start::from_estimate(found, &law, terms, &layout, &scale));
    let guesses = match known {
        Some(axis) => search.around(axis),
        None => start::guesses(&law, terms, &layout, &scale),
    };
    let found = search
        .run(guesses, &mut watch)
        .ok_or_else(|| nothing(&runs))?;
    Ok(outcome::describe(&search, found, law, terms, watch.counts))
}

/// Why nothing can be identified from runs without a scale.
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

/// Everything that stays the same during one search.
pub(crate) struct Search<'a> {
    pub runs: &'a [Run],
    pub layout: &'a Layout,
    pub simulation: &'a Simulation<'a>,
    pub scale: &'a Scale,
}

/// What a search found, with what it was found with.
pub(crate) struct Found {
    pub base: Axis,
    pub bounds: Bounds,
    pub substeps: usize,
    pub weights: [f64; 2],
    pub descent: Descent,
}

impl Search<'_> {
    pub fn drive(&self, substeps: usize) -> Drive<'_> {
        Drive {
            controller: self.simulation.controller.as_ref(),
            hold: self.simulation.hold,
            substeps,
        }
    }

    pub fn problem(&self, base: &Axis, substeps: usize, weights: [f64; 2]) -> Problem<'_> {
        Problem {
            runs: self.runs,
            layout: self.layout.clone(),
            base: base.clone(),
            drive: self.drive(substeps),
            weights,
        }
    }

    fn is_closed(&self) -> bool {
        self.simulation.controller.is_some()
    }

    /// A known axis, and the same with other bristles: those are what an equation error knows least.
    fn around(&self, axis: Axis) -> Vec<Axis> {
        let mut out = vec![axis.clone()];
        if self.layout.place(unknowns::Unknown::Stiffness).is_some() {
            for factor in [0.1, 10.0] {
                let mut other = axis.clone();
                other.stiffness *= factor;
                other.micro_damping *= libm::sqrt(factor);
                out.push(other);
            }
        }
        out
    }

    /// Plant steps in one control period that an axis needs.
    fn substeps(&self, axis: &Axis) -> usize {
        let periods = self
            .simulation
            .controller
            .as_ref()
            .map_or(1, |c| c.periods(self.scale.step).unwrap_or(1));
        let h = self.scale.step / periods as f64;
        let needed = (h * (axis.stiffness / axis.mass).sqrt() / STIFFEST).ceil();
        (needed.max(1.0) as usize).min(MOST_SUBSTEPS)
    }

    /// `None` without a guess to start from.
    fn run(&self, guesses: Vec<Axis>, watch: &mut Watch) -> Option<Found> {
        // Before anything is fitted, a residual of a count and one of a hundredth of the force weigh alike.
        let mut weights = [1.0 / self.scale.count, 100.0 / self.scale.force];
        let starts = start::rest(self.runs, self.is_closed());
        let total = guesses.len() as f64;
        let mut ranked: Vec<(f64, Axis)> = Vec::with_capacity(guesses.len());
        for (i, axis) in guesses.into_iter().enumerate() {
            if watch.stopped && !ranked.is_empty() {
                break;
            }
            let problem = self.problem(&axis, self.substeps(&axis), weights);
            let at = Point {
                q: self.layout.read(&axis),
                starts: starts.clone(),
            };
            let cost = problem.cost(&at);
            watch.counts.cost += 1;
            watch.fraction = (i + 1) as f64 / total;
            watch.report(problem.relative(cost));
            ranked.push((cost, axis));
        }
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        ranked.truncate(FOLLOWED);

        watch.stage = Stage::Coarse;
        let mut best: Option<Found> = None;
        let followed = ranked.len() as f64;
        for (i, (_, base)) in ranked.into_iter().enumerate() {
            if watch.stopped && best.is_some() {
                break;
            }
            watch.fraction = i as f64 / followed;
            let found = self.descend(base, starts.clone(), weights, SHORT, watch);
            if best
                .as_ref()
                .is_none_or(|b| found.descent.cost < b.descent.cost)
            {
                best = Some(found);
            }
        }
        let mut best = best?;
        watch.stage = Stage::Fine;
        let mut iterations = best.descent.iterations;
        for round in 0..ROUNDS {
            if watch.stopped {
                best.descent.status = Status::Interrupted;
                break;
            }
            watch.fraction = round as f64 / ROUNDS as f64;
            let settled = if self.is_closed() {
                let new = self.balance(&best);
                let settled = round > 0
                    && weights
                        .iter()
                        .zip(&new)
                        .all(|(a, b)| (a / b - 1.0).abs() < SETTLED);
                weights = new;
                settled
            } else {
                round > 0
            };
            if settled {
                break;
            }
            let base = self.layout.write(&best.base, &best.descent.at.q);
            best = self.descend(base, best.descent.at.starts, weights, LONG, watch);
            iterations += best.descent.iterations;
        }
        best.descent.iterations = iterations;
        Some(best)
    }

    fn descend(
        &self,
        base: Axis,
        starts: Vec<simulate::Initial>,
        weights: [f64; 2],
        steps: usize,
        watch: &mut Watch,
    ) -> Found {
        let substeps = self.substeps(&base);
        let bounds = start::bounds(self.layout, &base, self.scale);
        let at = Point {
            q: self.layout.read(&base),
            starts,
        };
        let problem = self.problem(&base, substeps, weights);
        let descent = descend(&problem, &bounds, at, steps, watch);
        Found {
            base,
            bounds,
            substeps,
            weights,
            descent,
        }
    }

    /// Weights of position and force by their own residuals; neither is known better than its steps.
    fn balance(&self, found: &Found) -> [f64; 2] {
        let axis = self.layout.write(&found.base, &found.descent.at.q);
        let drive = self.drive(found.substeps);
        let (mut x, mut f, mut n) = (0.0, 0.0, 0.0);
        for (run, initial) in self.runs.iter().zip(&found.descent.at.starts) {
            simulate(&axis, &drive, run, initial, |k, state, force| {
                if run.keep[k] {
                    x += (run.position[k] - state.x) * (run.position[k] - state.x);
                    f += (run.force[k] - force) * (run.force[k] - force);
                    n += 1.0;
                }
            });
        }
        let quantum = self.simulation.quantum.unwrap_or(0.0) / libm::sqrt(12.0);
        [
            1.0 / libm::sqrt(x / n).max(quantum).max(1e-9 * self.scale.stroke),
            1.0 / libm::sqrt(f / n).max(1e-9 * self.scale.force),
        ]
    }
}

#[cfg(test)]
mod tests;
