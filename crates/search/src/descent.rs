//! One Levenberg-Marquardt descent in the unit cube, as a state machine.
//!
//! Scaled by the diagonal of `J^T J` (More 1978, doi 10.1007/BFb0067700), damping by the gain ratio
//! (Nielsen 1999, IMM-REP-1999-05, sec. 2). Unknowns at a bound with the descent pointing outward are frozen
//! for the step; one whose step would leave the cube goes to its bound and the others are solved
//! again for that.

use crate::bits;
use crate::linear::cholesky_solve;
use crate::problem::Derivatives;
use crate::search::Status;
use serde::{Deserialize, Serialize};

/// Relative fall of the cost below which a step counts as none.
const FLAT: f64 = 1e-13;
/// Relative fall below which a few steps in a row end the descent.
const VALLEY: f64 = 1e-9;
/// How many.
const IN_A_ROW: usize = 5;
/// Step, in widths of the box, below which the unknowns count as settled.
const SETTLED: f64 = 1e-9;
/// Longest step of one unknown, in widths of the box: the quadratic model means little further off.
const REACH: f64 = 0.5;

/// A descent: where it is, what it wants to try, how it ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Descent {
    #[serde(with = "bits")]
    point: Vec<f64>,
    now: Option<Derivatives>,
    /// What is asked for; empty once it has ended.
    #[serde(with = "bits")]
    trial: Vec<f64>,
    #[serde(with = "bits")]
    damping: f64,
    #[serde(with = "bits")]
    grow: f64,
    slow: usize,
    steps: usize,
    most: usize,
    status: Option<Status>,
}

impl Descent {
    /// From a point of the unit cube, for at most so many steps.
    pub fn new(start: &[f64], most: usize) -> Self {
        let point: Vec<f64> = start.iter().map(|x| x.clamp(0.0, 1.0)).collect();
        Self {
            trial: point.clone(),
            point,
            now: None,
            damping: 1e-3,
            grow: 2.0,
            slow: 0,
            steps: 0,
            most,
            status: None,
        }
    }

    pub fn status(&self) -> Option<Status> {
        self.status
    }

    /// Where to evaluate next.
    pub fn ask(&self) -> Option<&[f64]> {
        self.status.is_none().then_some(&self.trial)
    }

    /// The best so far.
    pub fn point(&self) -> &[f64] {
        &self.point
    }

    pub fn cost(&self) -> f64 {
        self.now.as_ref().map_or(f64::INFINITY, |d| d.cost)
    }

    pub fn tell(&mut self, next: &Derivatives) {
        match self.now.take() {
            None if next.cost.is_finite() => self.now = Some(next.clone()),
            None => self.status = Some(Status::Stalled),
            Some(now) => self.judge(now, next),
        }
        if self.status.is_none() {
            self.propose();
        }
    }

    /// Accepts or rejects the trial.
    fn judge(&mut self, now: Derivatives, next: &Derivatives) {
        let step: Vec<f64> = difference(&self.trial, &self.point);
        let predicted = predicted_gain(&now, &step);
        let gained = now.cost - next.cost;
        if gained > 0.0 {
            let ratio = if predicted > 0.0 {
                gained / predicted
            } else {
                1.0
            };
            let valley = gained <= VALLEY * now.cost;
            self.slow = if valley { self.slow + 1 } else { 0 };
            let t = 2.0 * ratio - 1.0;
            self.damping = (self.damping * (1.0 - t * t * t).max(1.0 / 3.0)).max(1e-14);
            self.grow = 2.0;
            self.point.clone_from(&self.trial);
            if gained <= FLAT * now.cost || self.slow >= IN_A_ROW || next.cost == 0.0 {
                self.status = Some(Status::Converged);
            }
            self.now = Some(next.clone());
        } else {
            if predicted.abs() <= FLAT * now.cost {
                self.status = Some(Status::Converged);
            } else if self.damping > 1e12 {
                self.status = Some(Status::Stalled);
            }
            self.damping *= self.grow;
            self.grow *= 2.0;
            self.now = Some(now);
        }
    }

    /// The next trial, or the end.
    fn propose(&mut self) {
        let Some(now) = &self.now else { return };
        if self.steps >= self.most {
            self.status = Some(Status::Exhausted);
            return;
        }
        self.steps += 1;
        let Some(step) = damped_step(now, &self.point, self.damping) else {
            self.status = Some(Status::Converged);
            return;
        };
        for ((t, x), d) in self.trial.iter_mut().zip(&self.point).zip(&step) {
            *t = (x + d).clamp(0.0, 1.0);
        }
        let taken = difference(&self.trial, &self.point);
        let length = taken.iter().fold(0.0f64, |a, d| a.max(d.abs()));
        if length < SETTLED {
            let flat = length == 0.0 || predicted_gain(now, &taken) <= 1e-9 * length * now.cost;
            self.status = Some(if self.damping <= 1.0 || flat {
                Status::Converged
            } else {
                Status::Stalled
            });
        }
    }
}

fn difference(to: &[f64], from: &[f64]) -> Vec<f64> {
    to.iter().zip(from).map(|(a, b)| a - b).collect()
}

/// Fall of the cost that the quadratic model promises for a step.
fn predicted_gain(now: &Derivatives, step: &[f64]) -> f64 {
    let n = step.len();
    let mut gain = 0.0;
    for i in 0..n {
        let row = &now.normal[i * n..(i + 1) * n];
        let pulled: f64 = row.iter().zip(step).map(|(a, d)| a * d).sum();
        gain -= step[i] * (2.0 * now.gradient[i] + pulled);
    }
    gain
}

/// The damped Gauss-Newton step inside the cube; `None` if nothing is free to move.
fn damped_step(now: &Derivatives, point: &[f64], damping: f64) -> Option<Vec<f64>> {
    let n = point.len();
    let mut free: Vec<usize> = (0..n)
        .filter(|&i| {
            let down = -now.gradient[i];
            let pushes = (down > 0.0 && point[i] >= 1.0) || (down < 0.0 && point[i] <= 0.0);
            !pushes && now.normal[i * n + i] > 0.0
        })
        .collect();
    let mut step = vec![0.0; n];
    while !free.is_empty() {
        let solved = solve_free(now, &free, &step, damping)?;
        let before = free.len();
        let mut kept = Vec::new();
        for (&i, &d) in free.iter().zip(&solved) {
            if point[i] + d > 1.0 {
                step[i] = 1.0 - point[i];
            } else if point[i] + d < 0.0 {
                step[i] = -point[i];
            } else {
                kept.push((i, d));
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
fn solve_free(now: &Derivatives, free: &[usize], others: &[f64], damping: f64) -> Option<Vec<f64>> {
    let (n, m) = (others.len(), free.len());
    // To a unit diagonal: the unknowns differ in effect by many decades.
    let scale: Vec<f64> = free
        .iter()
        .map(|&i| 1.0 / (now.normal[i * n + i] * (1.0 + damping)).sqrt())
        .collect();
    let mut matrix = vec![0.0; m * m];
    let mut rhs = vec![0.0; m];
    for (a, &i) in free.iter().enumerate() {
        let row = &now.normal[i * n..(i + 1) * n];
        for (b, &j) in free.iter().enumerate() {
            matrix[a * m + b] = row[j] * scale[a] * scale[b];
        }
        matrix[a * m + a] = 1.0;
        let pulled: f64 = row.iter().zip(others).map(|(a, d)| a * d).sum();
        rhs[a] = (-now.gradient[i] - pulled) * scale[a];
    }
    let solved = cholesky_solve(matrix, rhs)?;
    let steps = solved.iter().zip(&scale);
    Some(steps.map(|(x, s)| (x * s).clamp(-REACH, REACH)).collect())
}
