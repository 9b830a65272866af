//! Levenberg-Marquardt on the shared unknowns and those of every run, inside a box.
//!
//! As `separable::levenberg`, with the starts of the runs eliminated from each step (Schur
//! complement), so that many short runs cost no more than one long one.

use crate::observe::Control;
use crate::output_error::problem::{Equations, Point, Problem};
use crate::output_error::simulate::{Initial, LOCALS};
use crate::separable::levenberg::{Status, Watch};
use nalgebra::{DMatrix, DVector};

/// Bounds of the shared unknowns, and of each run's bristle deflection over `Fc/s0`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub low: Vec<f64>,
    pub high: Vec<f64>,
}

/// A deflection that a bristle could not have come to by itself is not started from.
const MOST_DEFLECTION: f64 = 4.0;

impl Bounds {
    fn clamp(&self, i: usize, x: f64) -> f64 {
        x.max(self.low[i]).min(self.high[i])
    }

    /// Whether an unknown stands at a bound.
    pub fn is_at(&self, i: usize, x: f64) -> bool {
        let close = 1e-6 * (self.high[i] - self.low[i]);
        x - self.low[i] <= close || self.high[i] - x <= close
    }
}

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

/// Relative fall of the cost below which a step counts as none.
const FLAT: f64 = 1e-13;
/// Relative fall below which a few steps in a row end the search.
const VALLEY: f64 = 1e-7;
/// How many.
const IN_A_ROW: usize = 4;
/// Cost relative to the energy of what was measured that is rounding only.
const EXACT: f64 = 1e-26;
/// Damping above which no step is left that could lower the cost.
const STUCK: f64 = 1e12;

/// Descends from `start` for at most `steps` trials.
pub(crate) fn descend(
    problem: &Problem,
    bounds: &Bounds,
    start: Point,
    steps: usize,
    watch: &mut Watch,
) -> Descent {
    let mut at = start;
    for (i, x) in at.q.iter_mut().enumerate() {
        *x = bounds.clamp(i, *x);
    }
    let energy = problem.energy();
    let relative = |cost: f64| {
        if energy > 0.0 {
            (cost / energy).sqrt()
        } else {
            f64::INFINITY
        }
    };
    let mut now = problem.equations(&at);
    watch.counts.sensitivities += 1;
    let mut history = vec![(watch.counts.total(), relative(now.cost))];
    let mut lambda = 1e-3;
    let mut grow = 2.0;
    let mut slow = 0;
    let mut status = Status::Budget;
    let mut iterations = 0;
    while status == Status::Budget && iterations < steps {
        iterations += 1;
        if now.cost <= EXACT * energy {
            status = Status::Converged;
            break;
        }
        let trial = step(&now, &at, bounds, lambda);
        let cost = match &trial {
            Some(trial) => {
                watch.counts.cost += 1;
                problem.cost(trial)
            }
            None => f64::INFINITY,
        };
        if let Some(trial) = trial.filter(|_| cost < now.cost) {
            let gained = now.cost - cost;
            slow = if gained <= VALLEY * now.cost {
                slow + 1
            } else {
                0
            };
            let settled = gained <= FLAT * now.cost || slow >= IN_A_ROW;
            at = trial;
            now = problem.equations(&at);
            watch.counts.sensitivities += 1;
            history.push((watch.counts.total(), relative(now.cost)));
            lambda = (lambda / 3.0).max(1e-14);
            grow = 2.0;
            if settled {
                status = Status::Converged;
            }
        } else {
            lambda *= grow;
            grow *= 2.0;
            // A step that changes nothing but the last digits: this is the bottom.
            if (cost - now.cost).abs() <= FLAT * now.cost {
                status = Status::Converged;
            }
            if lambda > STUCK {
                // At the bottom every step is too long by rounding alone.
                let (_, descent) = now.reduced(0.0);
                status = if is_flat(&now, &descent, &at, bounds) {
                    Status::Converged
                } else {
                    Status::Stalled
                };
            }
        }
        if watch.report(relative(now.cost)) == Control::Stop {
            status = Status::Interrupted;
        }
    }
    Descent {
        cost: now.cost,
        at,
        status,
        iterations,
        history,
    }
}

/// Whether no free unknown could lower the cost by more than a millionth of it.
fn is_flat(now: &Equations, descent: &DVector<f64>, at: &Point, bounds: &Bounds) -> bool {
    (0..at.q.len())
        .filter(|&i| !pushes_out(descent[i], at.q[i], bounds, i))
        .all(|i| descent[i] * descent[i] <= 1e-6 * now.cost * now.shared[(i, i)])
}

fn pushes_out(descent: f64, x: f64, bounds: &Bounds, i: usize) -> bool {
    (descent > 0.0 && x >= bounds.high[i]) || (descent < 0.0 && x <= bounds.low[i])
}

/// The damped step inside the box; `None` where the equations cannot be solved.
fn step(now: &Equations, at: &Point, bounds: &Bounds, lambda: f64) -> Option<Point> {
    let (matrix, rhs) = now.reduced(lambda);
    let n = at.q.len();
    let mut free: Vec<usize> = (0..n)
        .filter(|&i| now.shared[(i, i)] > 0.0 && !pushes_out(rhs[i], at.q[i], bounds, i))
        .collect();
    let mut taken = DVector::zeros(n);
    while !free.is_empty() {
        let solved = solve_free(now, &matrix, &rhs, &free, &taken, lambda)?;
        let before = free.len();
        let mut kept = Vec::new();
        for (&i, &d) in free.iter().zip(&solved) {
            let to = bounds.clamp(i, at.q[i] + d);
            if to == at.q[i] + d {
                kept.push((i, d));
            } else {
                taken[i] = to - at.q[i];
            }
        }
        if kept.len() == before {
            for (i, d) in kept {
                taken[i] = d;
            }
            break;
        }
        free = kept.into_iter().map(|(i, _)| i).collect();
    }
    let own = now.own_steps(&taken, lambda);
    let moved = |initial: &Initial, d: &[f64; LOCALS]| {
        let mut out = *initial;
        out.0.iter_mut().zip(d).for_each(|(x, d)| *x += d);
        out.0[2] = out.0[2].clamp(-MOST_DEFLECTION, MOST_DEFLECTION);
        out
    };
    let next = Point {
        q: at.q.iter().zip(taken.iter()).map(|(x, d)| x + d).collect(),
        starts: at
            .starts
            .iter()
            .zip(&own)
            .map(|(s, d)| moved(s, d))
            .collect(),
    };
    let numbers = next.q.iter().chain(next.starts.iter().flat_map(|s| &s.0));
    numbers.clone().all(|x| x.is_finite()).then_some(next)
}

/// Steps of the free unknowns when the others take the given ones.
fn solve_free(
    now: &Equations,
    matrix: &DMatrix<f64>,
    rhs: &DVector<f64>,
    free: &[usize],
    others: &DVector<f64>,
    lambda: f64,
) -> Option<Vec<f64>> {
    let pulled = matrix * others;
    let scale: Vec<f64> = free
        .iter()
        .map(|&i| 1.0 / now.shared[(i, i)].sqrt())
        .collect();
    let m = DMatrix::from_fn(free.len(), free.len(), |a, b| {
        let damping = if a == b { lambda } else { 0.0 };
        matrix[(free[a], free[b])] * scale[a] * scale[b] + damping
    });
    let b = DVector::from_fn(free.len(), |a, _| {
        (rhs[free[a]] - pulled[free[a]]) * scale[a]
    });
    let solved = m.cholesky()?.solve(&b);
    Some(solved.iter().zip(&scale).map(|(x, s)| x * s).collect())
}
