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
use crate::law::terms::{Mass, Terms};
use crate::law::{Law, LawKind};
use crate::output_error::controller::Controller;
use crate::output_error::descent::{Descent, descend};
use crate::output_error::outcome::SimulationFit;
use crate::output_error::plant::Axis;
use crate::output_error::problem::{Point, Problem};
use crate::output_error::run::{Hold, Recording, Run};
use crate::output_error::simulate::{Drive, simulate};
use crate::output_error::start::Scale;
use crate::output_error::unknowns::Layout;
use crate::separable::search_box::SearchBox;
use crate::watch::Watch;
use stiction_search::{Observer, Stage, Status};

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

/// Guesses that are followed by a short descent.
const MOST_FOLLOWED: usize = 6;
/// Length, in samples, of the pieces of an open-loop run on which starting points are looked for.
const PIECE_SAMPLES: usize = 250;
/// Steps of a short descent, from a guess.
const SHORT_STEPS: usize = 15;
/// Steps of a descent on pieces whose result is the starting point for whole runs.
const PIECE_STEPS: usize = 60;
/// Steps of a last descent.
const LAST_STEPS: usize = 200;
/// Largest `h sqrt(s0/M)`, the phase (rad) of the mass on its bristles in one plant step of `h` seconds,
/// at the start.
const MOST_STEP_PHASE: f64 = 0.7;
/// Most plant steps in one control period.
const MOST_SUBSTEPS: usize = 16;
/// Most rounds of weighing position against force.
const MOST_WEIGHINGS: usize = 10;
/// Relative change of a weight at which the rounds end: it moves the parameters by far less than their
/// standard deviations.
const SETTLED_WEIGHT: f64 = 0.02;

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
        let whole: usize = runs.iter().map(|r| r.keep.len()).sum();
        return Err(Error::TooFewSamples {
            found: kept,
            needed,
            losses: run::losses(recordings, whole, kept),
        });
    }
    let scale = Scale::of(&runs, simulation.quantum).ok_or_else(|| nothing(&runs))?;
    let mut watch = Watch::new(observer, Stage::Scan);
    let search = Search {
        runs: &runs,
        layout: &layout,
        simulation,
        scale: &scale,
    };
    let known = simulation
        .start
        .and_then(|found| start::from_estimate(found, &law, terms, &layout, &scale));
    let pieces: Vec<Run> = match simulation.controller {
        Some(_) => Vec::new(),
        None => runs
            .iter()
            .flat_map(|run| run.clone().cut(PIECE_SAMPLES))
            .collect(),
    };
    let pieces = if pieces.len() > runs.len() {
        pieces
    } else {
        Vec::new()
    };
    let guesses = match known {
        Some(axis) => search.around(axis),
        None => {
            let mut guesses = start::guesses(&law, terms, &layout, &scale);
            if law.kind != LawKind::CoulombViscous {
                let short = if pieces.is_empty() { &runs } else { &pieces };
                guesses.extend(search.by_ladder(&law, terms, short, &mut watch));
            }
            guesses
        }
    };
    let found = search
        .run(guesses, &pieces, &mut watch)
        .ok_or_else(|| nothing(&runs))?;
    Ok(outcome::describe(&search, found, law, terms, watch.counts))
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
    pub bounds: SearchBox,
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

    /// A known axis, and the same with other bristle parameters: those are the ones that an
    /// equation-error fit determines worst.
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

    /// The same axis with other Stribeck curves; none for a law without one.
    fn other_curves(&self, axis: &Axis) -> Vec<Axis> {
        let falls = |u: &unknowns::Unknown| matches!(u, unknowns::Unknown::Velocity(_));
        if !self.layout.unknowns.iter().any(falls) {
            return Vec::new();
        }
        let mut out = Vec::new();
        for part in [0.003, 0.01, 0.03, 0.1] {
            for excess in [0.1, 0.5] {
                // Where the curve fell over the whole speed range, its Coulomb level was never reached;
                // then most of its static level is used instead.
                for share in [0.0, 0.7] {
                    let mut other = axis.clone();
                    for side in &mut other.sides {
                        side.coulomb = side.coulomb.max(share * side.fixed.min(self.scale.force));
                        side.fixed = (1.0 + excess) * side.coulomb;
                        side.velocity = part * self.scale.speed;
                    }
                    out.push(other);
                }
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
        let needed = (h * (axis.stiffness / axis.mass).sqrt() / MOST_STEP_PHASE).ceil();
        (needed.max(1.0) as usize).min(MOST_SUBSTEPS)
    }

    /// The same search on other runs or for another law.
    fn on<'b>(&'b self, runs: &'b [Run], layout: &'b Layout) -> Search<'b> {
        Search {
            runs,
            layout,
            simulation: self.simulation,
            scale: self.scale,
        }
    }

    /// Guesses built on a fitted Coulomb level, mass and offset: those are found from almost any start,
    /// the bristle parameters are not.
    fn by_ladder(&self, law: &Law, terms: &Terms, pieces: &[Run], watch: &mut Watch) -> Vec<Axis> {
        let plain = Law::new(LawKind::CoulombViscous);
        let layout = Layout::new(&plain, terms);
        let below = self.on(pieces, &layout);
        let guesses = start::guesses(&plain, terms, &layout, self.scale);
        let found = below.best(guesses, 2, watch).into_iter().next();
        found.map_or_else(Vec::new, |found| {
            let axis = layout.write(&found.base, &found.descent.at.q);
            start::with_bristles(&axis, law, self.scale)
        })
    }

    /// The lowest end points of short descents from the most promising guesses, best first.
    fn best(&self, guesses: Vec<Axis>, keep: usize, watch: &mut Watch) -> Vec<Found> {
        let weights = self.first_weights();
        let starts = start::rest(self.runs, self.simulation.controller.as_ref());
        watch.stage = Stage::Scan;
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
            watch.counts.costs += 1;
            watch.fraction = (i + 1) as f64 / total;
            watch.report(problem.relative(cost));
            ranked.push((cost, axis));
        }
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        ranked.truncate(MOST_FOLLOWED);

        watch.stage = Stage::Coarse;
        let mut out: Vec<Found> = Vec::new();
        let followed = ranked.len() as f64;
        for (i, (_, base)) in ranked.into_iter().enumerate() {
            if watch.stopped && !out.is_empty() {
                break;
            }
            watch.fraction = i as f64 / followed;
            let n = self.substeps(&base);
            out.push(self.descend(base, starts.clone(), n, weights, SHORT_STEPS, watch));
        }
        out.sort_by(|a, b| a.descent.cost.total_cmp(&b.descent.cost));
        out.truncate(keep);
        out
    }

    /// Before anything is fitted, one count of position and a hundredth of the force have the same weight.
    fn first_weights(&self) -> [f64; 2] {
        [1.0 / self.scale.count, 100.0 / self.scale.force]
    }

    /// `None` without a guess to start from.
    fn run(&self, guesses: Vec<Axis>, pieces: &[Run], watch: &mut Watch) -> Option<Found> {
        // The simulation of a long run drifts away for any rough guess; on short pieces it does not.
        // Presliding of a few counts is only seen in the long run.
        let mut finalists = Vec::new();
        if !pieces.is_empty() {
            let short = self.on(pieces, self.layout);
            for found in short.best(guesses.clone(), 2, watch) {
                finalists.push(self.layout.write(&found.base, &found.descent.at.q));
            }
        }
        for found in self.best(guesses, 2, watch) {
            finalists.push(self.layout.write(&found.base, &found.descent.at.q));
        }
        let mut best = self.best(finalists, 1, watch).into_iter().next()?;
        // A curve that falls over the whole range of speeds looks like less viscous friction, and a
        // search that began near it does not leave it.
        let here = self.layout.write(&best.base, &best.descent.at.q);
        let mut curves = self.other_curves(&here);
        if !curves.is_empty() && !watch.stopped {
            if !pieces.is_empty() {
                let short = self.on(pieces, self.layout);
                let found = short.best(curves, 3, watch);
                curves = found
                    .into_iter()
                    .map(|f| {
                        let base = self.layout.write(&f.base, &f.descent.at.q);
                        let starts = f.descent.at.starts;
                        let f =
                            short.descend(base, starts, f.substeps, f.weights, PIECE_STEPS, watch);
                        self.layout.write(&f.base, &f.descent.at.q)
                    })
                    .collect();
            }
            curves.push(here);
            best = self.best(curves, 1, watch).into_iter().next()?;
        }
        watch.stage = Stage::Fine;
        let mut weights = best.weights;
        let mut substeps = best.substeps;
        let mut iterations = best.descent.iterations;
        for round in 0..MOST_WEIGHINGS {
            if watch.stopped {
                best.descent.status = Status::Interrupted;
                break;
            }
            watch.fraction = round as f64 / MOST_WEIGHINGS as f64;
            let new = if self.is_closed() {
                self.balance(&best)
            } else {
                weights
            };
            let balanced = weights
                .iter()
                .zip(&new)
                .all(|(a, b)| (a / b - 1.0).abs() < SETTLED_WEIGHT);
            let fine = round > 0 && (substeps >= MOST_SUBSTEPS || self.is_fine_enough(&best));
            if round > 0 && balanced && fine {
                break;
            }
            weights = new;
            if round > 0 && !fine {
                substeps = (2 * substeps).min(MOST_SUBSTEPS);
            }
            let base = self.layout.write(&best.base, &best.descent.at.q);
            best = self.descend(
                base,
                best.descent.at.starts,
                substeps,
                weights,
                LAST_STEPS,
                watch,
            );
            iterations += best.descent.iterations;
        }
        best.descent.iterations = iterations;
        Some(best)
    }

    /// Whether halving the plant steps would change the position by less than a hundredth of the residual:
    /// an error of the step is the same in every sample, and does not average out as noise does.
    fn is_fine_enough(&self, found: &Found) -> bool {
        let axis = self.layout.write(&found.base, &found.descent.at.q);
        let positions = |substeps: usize| {
            let drive = self.drive(substeps);
            let mut out = Vec::new();
            for (run, initial) in self.runs.iter().zip(&found.descent.at.starts) {
                simulate(&axis, &drive, run, initial, |k, state, _| {
                    if run.keep[k] {
                        out.push((run.position[k], state.x));
                    }
                });
            }
            out
        };
        let (now, finer) = (positions(found.substeps), positions(2 * found.substeps));
        let (mut change, mut residual) = (0.0, 0.0);
        for ((measured, a), (_, b)) in now.iter().zip(&finer) {
            change += (a - b) * (a - b);
            residual += (measured - a) * (measured - a);
        }
        change <= 1e-4 * residual
    }

    fn descend(
        &self,
        base: Axis,
        starts: Vec<simulate::Initial>,
        substeps: usize,
        weights: [f64; 2],
        steps: usize,
        watch: &mut Watch,
    ) -> Found {
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

    /// Weights of position and force from their own residuals; no channel counts as better known than its
    /// resolution.
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
