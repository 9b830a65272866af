//! One descent on the shared unknowns and those of every run, inside a box.
//!
//! The starts of the runs are eliminated from each step (Schur complement), so that many short runs cost no
//! more than one long one.

use crate::output_error::problem::{Equations, Point, Problem};
use crate::output_error::simulate::Initial;
use crate::output_error::unknowns::LOCALS;
use crate::separable::search_box::SearchBox;
use crate::watch::Watch;
use stiction_search::descent::{self, LeastSquares, Settings, Sums};
use stiction_search::{Control, Derivatives, Status};

/// Largest bristle deflection, in units of `Fc/s0`, at the start of a run: steady sliding itself gives at
/// most `Fs/Fc`.
const MOST_DEFLECTION: f64 = 4.0;
/// Cost, relative to the energy (sum of squares) of the measured signals, that is only rounding error.
const EXACT_COST: f64 = 1e-26;

/// Relative fall of the cost that counts as small: where the law differs from the axis, a descent can go
/// on for hundreds of steps with smaller gains (Coulomb and viscous friction on a LuGre axis: 676 steps
/// for 2 % of the residual).
const SMALL_GAIN: f64 = 1e-7;
/// Small gains in a row that end a descent.
const SMALL_GAINS: usize = 4;

/// Where a descent ended.
#[derive(Clone, Debug)]
pub(crate) struct Descent {
    pub at: Point,
    pub cost: f64,
    pub status: Status,
    pub iterations: usize,
    /// Evaluations and relative residual after each accepted step.
    pub history: Vec<(usize, f64)>,
}

/// Settings of a descent of at most `most_trials` trials. The unknowns are partly logarithms and partly
/// in SI units, so the step length has no limit.
///
/// Each accepted step divides the damping by three, however much of the predicted gain it reached, and
/// the damping is relative to the diagonal before the starts of the runs are eliminated. With both rules
/// all of nine noisy logs of a known axis converge to its parameters, with the first rule alone eight,
/// with the second alone seven, with neither six (2026-11-22).
fn settings(energy: f64, most_trials: usize) -> Settings {
    Settings {
        most_trials,
        longest_step: f64::INFINITY,
        settled_step: 0.0,
        damping_by_gain: false,
        small_gain: SMALL_GAIN,
        small_gains: SMALL_GAINS,
        trusted_step: 0.0,
        exact_cost: EXACT_COST * energy,
        ..Settings::default()
    }
}

/// Descends from `start` for at most `steps` trials.
pub(crate) fn descend(
    problem: &Problem,
    bounds: &SearchBox,
    start: Point,
    steps: usize,
    watch: &mut Watch,
) -> Descent {
    let mut at = start;
    at.q = bounds.clamp(&at.q);
    let settings = settings(problem.energy(), steps);
    let walk = descent::Descent::new(at.q.clone(), &settings);
    let now = problem.equations(&at, watch);
    watch.counts.derivatives += 1;
    let mut simulated = Simulated {
        problem,
        motion: problem.motion(),
        at,
        now,
        sums: Derivatives::zeros(0),
        scale: Vec::new(),
        tried: None,
        history: Vec::new(),
        watch,
    };
    simulated.note();
    let walk = descent::descend(&mut simulated, walk, bounds.region(), &settings);
    Descent {
        cost: simulated.now.cost,
        at: simulated.at,
        status: walk.status().unwrap_or(Status::Budget),
        iterations: walk.trials(),
        history: simulated.history,
    }
}

/// A problem and the current point of its descent.
struct Simulated<'a, 'w, 'o> {
    problem: &'a Problem<'a>,
    motion: f64,
    at: Point,
    now: Equations,
    sums: Derivatives,
    scale: Vec<f64>,
    tried: Option<Point>,
    history: Vec<(usize, f64)>,
    watch: &'w mut Watch<'o>,
}

impl Simulated<'_, '_, '_> {
    fn relative(&self) -> f64 {
        if self.motion > 0.0 {
            (self.now.cost / self.motion).sqrt()
        } else {
            f64::INFINITY
        }
    }

    fn note(&mut self) {
        let total = self.watch.counts.total();
        self.history.push((total, self.relative()));
    }

    /// The point that a trial of the shared unknowns leads to; `None` where it has values that are not finite.
    fn moved(&self, trial: &[f64], damping: f64) -> Option<Point> {
        let own = self
            .now
            .own_steps(&descent::difference(trial, &self.at.q), damping);
        let moved = |initial: &Initial, d: &[f64; LOCALS]| {
            let mut out = *initial;
            out.0.iter_mut().zip(d).for_each(|(x, d)| *x += d);
            out.0[2] = out.0[2].clamp(-MOST_DEFLECTION, MOST_DEFLECTION);
            out
        };
        let starts = self.at.starts.iter().zip(&own);
        let next = Point {
            q: trial.to_vec(),
            starts: starts.map(|(s, d)| moved(s, d)).collect(),
        };
        let mut numbers = next.q.iter().chain(next.starts.iter().flat_map(|s| &s.0));
        numbers.all(|x| x.is_finite()).then_some(next)
    }
}

impl LeastSquares for Simulated<'_, '_, '_> {
    fn sums(&mut self, damping: f64) -> Option<Sums<'_>> {
        let (sums, beside) = self.now.reduced(damping);
        self.sums = sums;
        self.scale = (0..self.at.q.len())
            .map(|i| self.now.shared[(i, i)])
            .collect();
        Some(Sums {
            derivatives: &self.sums,
            scale: Some(&self.scale),
            beside,
        })
    }

    fn cost(&mut self, trial: &[f64], damping: f64) -> f64 {
        self.tried = self.moved(trial, damping);
        match &self.tried {
            Some(next) => {
                self.watch.counts.costs += 1;
                self.problem.cost(next, self.watch)
            }
            None => f64::INFINITY,
        }
    }

    fn accept(&mut self) {
        if let Some(next) = self.tried.take() {
            let now = self.problem.equations(&next, self.watch);
            self.watch.counts.derivatives += 1;
            // Stopped on the way: the point before has all that is needed.
            if now.cost.is_finite() {
                self.now = now;
                self.at = next;
                self.note();
            }
        }
    }

    fn after_trial(&mut self) -> Control {
        self.watch.report(self.relative())
    }
}
