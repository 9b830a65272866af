//! Descents on one law: from guesses to the most promising, and from there to the end.

use crate::output_error::Simulation;
use crate::output_error::descent::{Descent, descend};
use crate::output_error::plant::Axis;
use crate::output_error::problem::{Looks, Point, Problem};
use crate::output_error::run::Run;
use crate::output_error::simulate::{self, Drive, simulate};
use crate::output_error::start::{self, Scale};
use crate::output_error::unknowns::Layout;
use crate::separable::search_box::SearchBox;
use crate::watch::Watch;
use stiction_search::{Stage, Status};

/// Steps of a short descent, from a guess.
const SHORT_STEPS: usize = 15;
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

    pub fn is_closed(&self) -> bool {
        self.simulation.controller.is_some()
    }

    /// Plant steps in one control period that an axis needs.
    pub fn substeps(&self, axis: &Axis) -> usize {
        let periods = self
            .simulation
            .controller
            .as_ref()
            .map_or(1, |c| c.periods(self.scale.step).unwrap_or(1));
        let h = self.scale.step / periods as f64;
        let needed = (h * (axis.stiffness / axis.mass).sqrt() / MOST_STEP_PHASE).ceil();
        (needed.max(1.0) as usize).min(MOST_SUBSTEPS)
    }

    /// The `keep` lowest end points of `follow` short descents, best first: from the best guess of every group, since each
    /// group knows something of its own, and from the most promising of the rest.
    pub fn best(
        &self,
        groups: &[Vec<Axis>],
        [follow, keep]: [usize; 2],
        watch: &mut Watch,
    ) -> Vec<Found> {
        let weights = self.first_weights();
        let starts = start::rest(self.runs, self.simulation.controller.as_ref());
        watch.stage = Stage::Scan;
        let total: usize = groups.iter().map(Vec::len).sum();
        let mut ranked: Vec<(f64, usize, &Axis)> = Vec::with_capacity(total);
        for (group, axis) in groups
            .iter()
            .enumerate()
            .flat_map(|(group, axes)| axes.iter().map(move |axis| (group, axis)))
        {
            if watch.stopped && !ranked.is_empty() {
                break;
            }
            let problem = self.problem(axis, self.substeps(axis), weights);
            let at = Point {
                q: self.layout.read(axis),
                starts: starts.clone(),
            };
            let cost = problem.cost(&at, watch);
            watch.counts.costs += 1;
            watch.fraction = (ranked.len() + 1) as f64 / total as f64;
            watch.report((cost / problem.motion()).sqrt());
            ranked.push((cost, group, axis));
        }
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        let is_first = |i: usize| !ranked[..i].iter().any(|other| other.1 == ranked[i].1);
        let (first, rest): (Vec<usize>, Vec<usize>) = (0..ranked.len()).partition(|&i| is_first(i));
        let others = follow.saturating_sub(first.len());
        let followed: Vec<usize> = first
            .into_iter()
            .chain(rest.into_iter().take(others))
            .collect();

        watch.stage = Stage::Coarse;
        let mut out: Vec<Found> = Vec::new();
        for (i, &k) in followed.iter().enumerate() {
            if watch.stopped && !out.is_empty() {
                break;
            }
            watch.fraction = i as f64 / followed.len() as f64;
            let base = ranked[k].2.clone();
            let n = self.substeps(&base);
            out.push(self.descend(base, starts.clone(), n, weights, SHORT_STEPS, watch));
        }
        out.sort_by(|a, b| a.descent.cost.total_cmp(&b.descent.cost));
        out.truncate(keep);
        out
    }

    /// An axis where nothing is searched any more.
    pub fn start(&self, axis: Axis, watch: &mut Watch) -> Found {
        let starts = start::rest(self.runs, self.simulation.controller.as_ref());
        let substeps = self.substeps(&axis);
        self.descend(axis, starts, substeps, self.first_weights(), 0, watch)
    }

    /// The axis that a descent ended at.
    pub fn axis(&self, found: &Found) -> Axis {
        self.layout.write(&found.base, &found.descent.at.q)
    }

    /// Goes on from where a descent ended.
    pub fn go_on(&self, found: Found, steps: usize, watch: &mut Watch) -> Found {
        let base = self.axis(&found);
        let Found {
            substeps,
            weights,
            descent,
            ..
        } = found;
        self.descend(base, descent.at.starts, substeps, weights, steps, watch)
    }

    /// Descends to the end, in rounds until the weights of position and force have settled and the plant steps are fine
    /// enough.
    pub fn settle(&self, mut best: Found, watch: &mut Watch) -> Found {
        watch.stage = Stage::Fine;
        let mut weights = best.weights;
        let mut substeps = best.substeps;
        let mut iterations = best.descent.iterations;
        for round in 0..MOST_WEIGHINGS {
            if watch.stopped {
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
            let fine =
                round > 0 && (substeps >= MOST_SUBSTEPS || self.is_fine_enough(&best, watch));
            if round > 0 && balanced && fine {
                break;
            }
            weights = new;
            if round > 0 && !fine {
                substeps = (2 * substeps).min(MOST_SUBSTEPS);
            }
            let base = self.axis(&best);
            let starts = best.descent.at.starts;
            best = self.descend(base, starts, substeps, weights, LAST_STEPS, watch);
            iterations += best.descent.iterations;
        }
        best.descent.iterations = iterations;
        if watch.stopped {
            best.descent.status = Status::Interrupted;
        }
        best
    }

    /// Before anything is fitted, one count of position and a hundredth of the force have the same weight.
    pub fn first_weights(&self) -> [f64; 2] {
        [1.0 / self.scale.count, 100.0 / self.scale.force]
    }

    /// Whether halving the plant steps would change the position by less than a hundredth of the residual:
    /// an error of the step is the same in every sample, and does not average out as noise does.
    fn is_fine_enough(&self, found: &Found, watch: &mut Watch) -> bool {
        let axis = self.axis(found);
        let mut looks = Looks::new(watch);
        let mut positions = |substeps: usize| {
            let drive = self.drive(substeps);
            let mut out = Vec::new();
            for (run, initial) in self.runs.iter().zip(&found.descent.at.starts) {
                simulate(&axis, &drive, run, initial, |k, state, _| {
                    if run.keep[k] {
                        out.push((run.position[k], state.x));
                    }
                    looks.go_on(substeps * simulate::periods(run))
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

    pub fn descend(
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
        let axis = self.axis(found);
        let drive = self.drive(found.substeps);
        let (mut x, mut f, mut n) = (0.0, 0.0, 0.0);
        for (run, initial) in self.runs.iter().zip(&found.descent.at.starts) {
            simulate(&axis, &drive, run, initial, |k, state, force| {
                if run.keep[k] {
                    x += (run.position[k] - state.x) * (run.position[k] - state.x);
                    f += (run.force[k] - force) * (run.force[k] - force);
                    n += 1.0;
                }
                true
            });
        }
        let quantum = self.simulation.quantum.unwrap_or(0.0) / libm::sqrt(12.0);
        [
            1.0 / libm::sqrt(x / n).max(quantum).max(1e-9 * self.scale.stroke),
            1.0 / libm::sqrt(f / n).max(1e-9 * self.scale.force),
        ]
    }
}
