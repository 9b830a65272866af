//! Levenberg-Marquardt on the reduced problem, inside a box.
//!
//! Moré's scaling by the diagonal of `J^T J` with the gain-ratio update of Nielsen 1999; unknowns
//! that stand at their bound with the descent pointing outward are frozen for the step.

use crate::observe::{Control, Counts, Observer, Progress, Stage};
use crate::separable::in_lanes::InLanes;
use crate::separable::objective::{Evaluation, Objective};
use crate::separable::reduced::Reduced;
use crate::separable::search_box::SearchBox;
use nalgebra::{DMatrix, DVector};

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Neither cost nor unknowns change any more.
    Converged,
    /// The step budget ran out; the best so far is kept.
    Budget,
    /// No step lowers the cost although the gradient is not small.
    Stalled,
    /// Stopped from outside; the best so far is kept.
    Interrupted,
}

impl Status {
    /// Name as written to files.
    pub fn name(self) -> &'static str {
        match self {
            Status::Converged => "converged",
            Status::Budget => "budget",
            Status::Stalled => "stalled",
            Status::Interrupted => "interrupted",
        }
    }
}

/// Result of one descent.
#[derive(Clone, Debug)]
pub(crate) struct Descent {
    pub p: Vec<f64>,
    pub evaluation: Evaluation,
    pub status: Status,
    pub iterations: usize,
    /// Relative residual after each accepted step, with the number of evaluations until then.
    pub history: Vec<(usize, f64)>,
}

/// Where progress goes while descents run.
pub(crate) struct Watch<'o> {
    pub observer: &'o mut dyn Observer,
    pub stage: Stage,
    pub fraction: f64,
    pub counts: Counts,
    pub best: f64,
    /// Whether the observer has asked to stop.
    pub stopped: bool,
}

impl Watch<'_> {
    pub fn count(&mut self, objective: &Objective, sensitivities: bool) {
        if sensitivities {
            self.counts.sensitivities += 1;
        } else {
            self.counts.cost += 1;
        }
        if objective.record().is_thinned {
            self.counts.thinned += 1;
        }
    }

    pub fn report(&mut self, relative: f64) -> Control {
        self.best = self.best.min(relative);
        let control = self.observer.progress(&Progress {
            stage: self.stage,
            fraction: self.fraction,
            counts: self.counts,
            best: self.best,
        });
        self.stopped |= control == Control::Stop;
        control
    }
}

/// Relative fall of the cost below which a step counts as none.
const FLAT: f64 = 1e-13;
/// Relative fall below which a few steps in a row end the search: along a valley that the data leave
/// this flat, the unknowns move by a small part of their own uncertainty.
const VALLEY: f64 = 1e-9;
/// How many.
const IN_A_ROW: usize = 5;
/// Step in the logarithms below which the unknowns count as settled.
const SETTLED: f64 = 1e-9;
/// Step in the logarithms within which the quadratic model is taken at its word: what it calls no gain is not
/// tried.
const TRUSTED: f64 = 1e-3;
/// Cost relative to the energy of the force that is rounding only.
const EXACT: f64 = 1e-27;
/// Change of a cost from sums of squares, relative to the energy of the force, that may be rounding.
const ROUNDING: f64 = 1e-13;

/// Part of what a step promised that the next may, where costs are too coarse to say whether either was good.
const LESS: f64 = 0.1;

/// Descends from `start` for at most `steps` trials.
///
/// Where the objective can be had from sums alone, they lead as far as their digits go, and the columns
/// only finish.
pub(crate) fn descend(
    objective: &Objective,
    bounds: &SearchBox,
    start: &[f64],
    steps: usize,
    watch: &mut Watch,
) -> Descent {
    let mut history = Vec::new();
    let led = objective
        .sums()
        .and_then(|sums| lead(objective, sums, bounds, start, steps, &mut history, watch));
    let (start, done, interrupted) = led.unwrap_or((bounds.clamp(start), 0, false));
    let mut evaluation = objective.evaluate(&start, true);
    watch.count(objective, true);
    history.push((watch.counts.total(), objective.relative(evaluation.cost)));
    let mut walk = Walk::new(start, evaluation.reduced(), objective.energy());
    walk.iterations = done;
    if interrupted {
        walk.status = Status::Interrupted;
    }
    while let Some(trial) = walk.propose(bounds, steps) {
        let next = objective.evaluate(&trial, true);
        watch.count(objective, true);
        if walk.take(trial, next.reduced()) {
            evaluation = next;
            history.push((watch.counts.total(), objective.relative(evaluation.cost)));
        }
        if watch.report(objective.relative(evaluation.cost)) == Control::Stop {
            walk.status = Status::Interrupted;
        }
    }
    Descent {
        p: walk.p,
        evaluation,
        status: walk.status,
        iterations: walk.iterations,
        history,
    }
}

/// The descent on sums, and the steps that are too small for the digits of their costs: where it ends, the trials it took, and whether it was stopped. `None` where a trial
/// is beyond what the sums can do.
fn lead(
    objective: &Objective,
    sums: &InLanes,
    bounds: &SearchBox,
    start: &[f64],
    steps: usize,
    history: &mut Vec<(usize, f64)>,
    watch: &mut Watch,
) -> Option<(Vec<f64>, usize, bool)> {
    let mut walk = Walk::new(
        bounds.clamp(start),
        sums.reduced(&bounds.clamp(start))?,
        objective.energy(),
    );
    walk.rounding = ROUNDING;
    walk.untried = true;
    watch.count(objective, true);
    let mut before = 0.0;
    while let Some(trial) = walk.propose(bounds, steps) {
        before = walk.predicted;
        let next = sums.reduced(&trial)?;
        watch.count(objective, true);
        let cost = next.cost;
        if walk.take(trial, next) {
            history.push((watch.counts.total(), objective.relative(cost)));
        }
        if watch.report(objective.relative(walk.now.cost)) == Control::Stop {
            return Some((walk.p, walk.iterations, true));
        }
    }
    // The last step was not tried. What is left of the gradient there is good to more digits than a cost: it is
    // followed as long as it promises less and less. As much less as a step promises than the one before, the next
    // will promise than this.
    let mut promised = walk.predicted;
    let mut left = promised * (promised / before);
    while walk.status == Status::Converged
        && walk.iterations < steps
        && promised > 0.0
        && left > FLAT * walk.now.cost
    {
        let now = sums.reduced(&walk.p)?;
        watch.count(objective, true);
        walk.iterations += 1;
        let Some(step) = damped_step(&now, &walk.p, bounds, 0.0) else {
            break;
        };
        let moved: Vec<f64> = walk.p.iter().zip(step.iter()).map(|(x, d)| x + d).collect();
        let trial = bounds.clamp(&moved);
        let promises = predicted_gain(&now, &trial, &walk.p);
        let fades = promises < LESS * promised;
        if !fades || largest(&walk.p, &trial) > TRUSTED {
            break;
        }
        walk.p = trial;
        left = promises * (promises / promised);
        promised = promises;
        walk.now = now;
    }
    Some((walk.p, walk.iterations, false))
}

/// One descent, asked for its next trial and told what became of it.
pub(crate) struct Walk {
    pub p: Vec<f64>,
    pub now: Reduced,
    pub status: Status,
    /// Trials so far.
    pub iterations: usize,
    /// Gain, relative to the energy of the force, below which costs cannot be compared: the walk ends there.
    pub rounding: f64,
    /// Where to end: within this step in the logarithms, when it promises to lower the cost by no more than
    /// this part.
    pub near_enough: (f64, f64),
    /// Whether that step is taken all the same, without a trial: [`now`](Self::now) then belongs to the point
    /// before.
    pub untried: bool,
    energy: f64,
    lambda: f64,
    grow: f64,
    slow: usize,
    predicted: f64,
}

impl Walk {
    pub fn new(p: Vec<f64>, now: Reduced, energy: f64) -> Self {
        let status = if p.is_empty() {
            Status::Converged
        } else {
            Status::Budget
        };
        Self {
            p,
            now,
            status,
            iterations: 0,
            rounding: 0.0,
            near_enough: (TRUSTED, FLAT),
            untried: false,
            energy,
            lambda: 1e-3,
            grow: 2.0,
            slow: 0,
            predicted: 0.0,
        }
    }

    /// The next trial; `None` at the end of the walk.
    pub fn propose(&mut self, bounds: &SearchBox, steps: usize) -> Option<Vec<f64>> {
        if self.status != Status::Budget || self.iterations >= steps {
            return None;
        }
        self.iterations += 1;
        let now = &self.now;
        if now.cost <= EXACT * self.energy {
            self.status = Status::Converged;
            return None;
        }
        let Some(step) = damped_step(now, &self.p, bounds, self.lambda) else {
            self.status = Status::Converged;
            return None;
        };
        let moved: Vec<f64> = self.p.iter().zip(step.iter()).map(|(x, d)| x + d).collect();
        let trial = bounds.clamp(&moved);
        let length = largest(&self.p, &trial);
        if length < SETTLED {
            let settled = self.lambda <= 1.0 || flat_at(now, &trial, &self.p);
            self.status = if settled {
                Status::Converged
            } else {
                Status::Stalled
            };
            return None;
        }
        self.predicted = predicted_gain(now, &trial, &self.p);
        let (short, little) = self.near_enough;
        let nothing = (little * now.cost).max(self.rounding * self.energy);
        if length < short && self.lambda <= 1.0 && self.predicted.abs() <= nothing {
            if self.untried {
                self.p = trial;
            }
            self.status = Status::Converged;
            return None;
        }
        Some(trial)
    }

    /// What a trial came to; whether it is where the walk now stands.
    pub fn take(&mut self, trial: Vec<f64>, next: Reduced) -> bool {
        let now = &self.now;
        let gained = now.cost - next.cost;
        if next.cost.is_finite() && gained > 0.0 {
            let ratio = if self.predicted > 0.0 {
                gained / self.predicted
            } else {
                1.0
            };
            self.slow = if gained <= VALLEY * now.cost {
                self.slow + 1
            } else {
                0
            };
            if gained <= FLAT * now.cost || self.slow >= IN_A_ROW {
                self.status = Status::Converged;
            }
            self.p = trial;
            self.now = next;
            let shrink = (1.0 - (2.0 * ratio - 1.0).powi(3)).max(1.0 / 3.0);
            self.lambda = (self.lambda * shrink).max(1e-14);
            self.grow = 2.0;
            return true;
        }
        // A step that a bound cut short may promise a rise: a shorter one follows the gradient.
        if self.predicted.abs() <= (FLAT * now.cost).max(self.rounding * self.energy) {
            self.status = Status::Converged;
        } else if self.lambda > 1e12 {
            self.status = Status::Stalled;
        }
        self.lambda *= self.grow;
        self.grow *= 2.0;
        false
    }
}

/// Largest distance in any unknown.
fn largest(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

/// Fall of the cost that the quadratic model promises for a step.
fn predicted_gain(now: &Reduced, to: &[f64], from: &[f64]) -> f64 {
    let taken = DVector::from_iterator(to.len(), to.iter().zip(from).map(|(b, a)| b - a));
    2.0 * now.descent.dot(&taken) - (&now.hessian * &taken).dot(&taken)
}

/// Whether the gradient is so small that a step of one in the logarithms would promise nothing.
fn flat_at(now: &Reduced, to: &[f64], from: &[f64]) -> bool {
    let length = largest(to, from);
    length == 0.0 || predicted_gain(now, to, from) / length <= 1e-9 * now.cost
}

/// The damped Gauss-Newton step inside the box; `None` if no unknown is free or the descent
/// vanishes.
///
/// Unknowns that stand at a bound and push outward are frozen. An unknown whose step would leave the
/// box goes to its bound, and the others are solved again for that: cutting a step short without
/// this can turn it uphill.
fn damped_step(now: &Reduced, p: &[f64], bounds: &SearchBox, lambda: f64) -> Option<DVector<f64>> {
    let mut free: Vec<usize> = (0..p.len())
        .filter(|&i| {
            let d = now.descent[i];
            let pushes = (d > 0.0 && p[i] >= bounds.high(i)) || (d < 0.0 && p[i] <= bounds.low(i));
            !pushes && now.hessian[(i, i)] > 0.0 && d.is_finite()
        })
        .collect();
    let mut step = DVector::zeros(p.len());
    while !free.is_empty() {
        let solved = solve_free(now, &free, &step, lambda)?;
        let leaves = |i: usize, d: f64| {
            let to = p[i] + d;
            if to > bounds.high(i) {
                Some(bounds.high(i) - p[i])
            } else if to < bounds.low(i) {
                Some(bounds.low(i) - p[i])
            } else {
                None
            }
        };
        let before = free.len();
        let mut kept = Vec::new();
        for (&i, &d) in free.iter().zip(&solved) {
            match leaves(i, d) {
                Some(cut) => step[i] = cut,
                None => kept.push((i, d)),
            }
        }
        if kept.len() == before {
            for (i, d) in kept {
                step[i] = d;
            }
            return Some(step);
        }
        free = kept.into_iter().map(|(i, _)| i).collect();
    }
    step.iter().any(|d| *d != 0.0).then_some(step)
}

/// Steps of the free unknowns when the others take the given steps.
fn solve_free(
    now: &Reduced,
    free: &[usize],
    others: &DVector<f64>,
    lambda: f64,
) -> Option<Vec<f64>> {
    let n = free.len();
    // Scaled to a unit diagonal: the unknowns differ in size by many decades.
    let scale: Vec<f64> = free
        .iter()
        .map(|&i| 1.0 / (now.hessian[(i, i)] * (1.0 + lambda)).sqrt())
        .collect();
    let mut matrix = DMatrix::zeros(n, n);
    let mut rhs = DVector::zeros(n);
    let pulled = &now.hessian * others;
    for (a, &i) in free.iter().enumerate() {
        for (b, &j) in free.iter().enumerate() {
            matrix[(a, b)] = now.hessian[(i, j)] * scale[a] * scale[b];
        }
        matrix[(a, a)] = 1.0;
        rhs[a] = (now.descent[i] - pulled[i]) * scale[a];
    }
    let solved = matrix.cholesky()?.solve(&rhs);
    // A step of more than e^3 in one go leaves the region where the model means anything.
    Some(
        solved
            .iter()
            .zip(&scale)
            .map(|(x, s)| (x * s).clamp(-3.0, 3.0))
            .collect(),
    )
}
