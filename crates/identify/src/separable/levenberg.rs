//! Levenberg-Marquardt on the reduced problem, inside a box.
//!
//! Moré's scaling by the diagonal of `J^T J` with the gain-ratio update of Nielsen 1999; unknowns
//! that stand at their bound with the descent pointing outward are frozen for the step.

use crate::observe::{Control, Counts, Observer, Progress, Stage};
use crate::separable::objective::{Evaluation, Objective};
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
/// Cost relative to the energy of the force that is rounding only.
const EXACT: f64 = 1e-27;

/// Descends from `start` for at most `steps` trials.
pub(crate) fn descend(
    objective: &Objective,
    bounds: &SearchBox,
    start: &[f64],
    steps: usize,
    watch: &mut Watch,
) -> Descent {
    let mut p = bounds.clamp(start);
    let mut now = objective.evaluate(&p, true);
    watch.count(objective, true);
    let mut history = vec![(watch.counts.total(), objective.relative(now.cost))];
    let mut lambda = 1e-3;
    let mut grow = 2.0;
    let mut status = Status::Budget;
    let mut iterations = 0;
    let mut slow = 0;
    if p.is_empty() {
        status = Status::Converged;
    }
    while status == Status::Budget && iterations < steps {
        iterations += 1;
        if now.cost <= EXACT * objective.energy() {
            status = Status::Converged;
            break;
        }
        let Some(step) = damped_step(&now, &p, bounds, lambda) else {
            status = Status::Converged;
            break;
        };
        let trial = bounds.clamp(
            &p.iter()
                .zip(step.iter())
                .map(|(x, d)| x + d)
                .collect::<Vec<_>>(),
        );
        let length = p
            .iter()
            .zip(&trial)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        if length < SETTLED {
            status = if lambda <= 1.0 || flat_at(&now, &trial, &p) {
                Status::Converged
            } else {
                Status::Stalled
            };
            break;
        }
        let next = objective.evaluate(&trial, true);
        watch.count(objective, true);
        let predicted = predicted_gain(&now, &trial, &p);
        let gained = now.cost - next.cost;
        if next.cost.is_finite() && gained > 0.0 {
            let ratio = if predicted > 0.0 {
                gained / predicted
            } else {
                1.0
            };
            slow = if gained <= VALLEY * now.cost {
                slow + 1
            } else {
                0
            };
            let flat = gained <= FLAT * now.cost || slow >= IN_A_ROW;
            p = trial;
            now = next;
            let relative = objective.relative(now.cost);
            history.push((watch.counts.total(), relative));
            lambda = (lambda * (1.0 - (2.0 * ratio - 1.0).powi(3)).max(1.0 / 3.0)).max(1e-14);
            grow = 2.0;
            if watch.report(relative) == Control::Stop {
                status = Status::Interrupted;
            } else if flat {
                status = Status::Converged;
            }
        } else {
            // A step that a bound cut short may promise a rise: a shorter one follows the gradient.
            if predicted.abs() <= FLAT * now.cost {
                status = Status::Converged;
            } else if lambda > 1e12 {
                status = Status::Stalled;
            }
            lambda *= grow;
            grow *= 2.0;
            if watch.report(objective.relative(now.cost)) == Control::Stop {
                status = Status::Interrupted;
            }
        }
    }
    Descent {
        p,
        evaluation: now,
        status,
        iterations,
        history,
    }
}

/// Fall of the cost that the quadratic model promises for a step.
fn predicted_gain(now: &Evaluation, to: &[f64], from: &[f64]) -> f64 {
    let taken = DVector::from_iterator(to.len(), to.iter().zip(from).map(|(b, a)| b - a));
    2.0 * now.descent.dot(&taken) - (&now.hessian * &taken).dot(&taken)
}

/// Whether the gradient is so small that a step of one in the logarithms would promise nothing.
fn flat_at(now: &Evaluation, to: &[f64], from: &[f64]) -> bool {
    let length = to
        .iter()
        .zip(from)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    length == 0.0 || predicted_gain(now, to, from) / length <= 1e-9 * now.cost
}

/// The damped Gauss-Newton step inside the box; `None` if no unknown is free or the descent
/// vanishes.
///
/// Unknowns that stand at a bound and push outward are frozen. An unknown whose step would leave the
/// box goes to its bound, and the others are solved again for that: cutting a step short without
/// this can turn it uphill.
fn damped_step(
    now: &Evaluation,
    p: &[f64],
    bounds: &SearchBox,
    lambda: f64,
) -> Option<DVector<f64>> {
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
    now: &Evaluation,
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
