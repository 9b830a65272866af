//! Levenberg-Marquardt inside a box, the only one of the workspace.
//!
//! It minimises a sum of squares from what a [`LeastSquares`] problem returns at a point: the cost, `J^T r`
//! and `J^T J` ([`Derivatives`]), reduced to the unknowns that the descent moves. Steps are scaled by the
//! diagonal of `J^T J` (Moré 1978, doi 10.1007/BFb0067700); the damping follows the ratio of the gain to
//! that which the quadratic model predicted (Nielsen 1999, IMM-REP-1999-05, section 2). An unknown at a
//! bound with the descent pointing outward is frozen for the step; one whose step would leave the box goes
//! to its bound, and the others are solved again for that.
//!
//! [`descend`] runs one descent to its end. [`Descent`] is the same as a state machine, which is asked for
//! its next trial and told the cost of it, for callers that evaluate the trials of many descents together.

mod follow;
mod settings;
mod step;

pub use follow::{LeastSquares, descend};
pub use settings::Settings;
pub use step::{Region, damped_step, difference, largest, predicted_gain};

use crate::bits;
use crate::problem::Derivatives;
use crate::status::Status;
use serde::{Deserialize, Serialize};

/// Damping up to which a short step is short because the minimum is near, not because it was damped.
const UNDAMPED: f64 = 1.0;
/// Least part of the damping that is left after a good step (Nielsen 1999).
const LEAST_SHRINK: f64 = 1.0 / 3.0;
/// Growth of the damping after a first failed step; it doubles with each further one (Nielsen 1999).
const FIRST_GROWTH: f64 = 2.0;

/// What is known at the current point of a descent.
#[derive(Clone, Copy, Debug)]
pub struct Sums<'a> {
    /// Cost and derivatives, reduced to the unknowns of the descent.
    pub derivatives: &'a Derivatives,
    /// What the damping of each unknown is relative to; `None` for the diagonal of `J^T J`.
    pub scale: Option<&'a [f64]>,
    /// Fall of the cost that is predicted for a step of only those unknowns that the problem has eliminated,
    /// at the damping of the coming step. Where it is not zero, small steps of the other unknowns are tried
    /// nevertheless.
    pub beside: f64,
}

impl<'a> From<&'a Derivatives> for Sums<'a> {
    fn from(derivatives: &'a Derivatives) -> Self {
        Self {
            derivatives,
            scale: None,
            beside: 0.0,
        }
    }
}

/// A descent: where it stands, how it steps, how it ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Descent {
    #[serde(with = "bits")]
    point: Vec<f64>,
    /// Cost at the current point, as of the last proposal.
    #[serde(with = "bits")]
    cost: f64,
    #[serde(with = "bits")]
    damping: f64,
    #[serde(with = "bits")]
    growth: f64,
    /// Steps in a row that gained little.
    slow: usize,
    trials: usize,
    /// Fall of the cost that was predicted for the last proposal.
    #[serde(with = "bits")]
    promised: f64,
    status: Option<Status>,
}

impl Descent {
    /// A descent from a point of the box.
    pub fn new(point: Vec<f64>, settings: &Settings) -> Self {
        Self {
            point,
            cost: f64::INFINITY,
            damping: settings.first_damping,
            growth: FIRST_GROWTH,
            slow: 0,
            trials: 0,
            promised: 0.0,
            status: None,
        }
    }

    /// The same, with the trials counted that were spent to find its start.
    #[must_use]
    pub fn after(mut self, trials: usize) -> Self {
        self.trials = trials;
        self
    }

    /// How it ended; `None` while it goes on.
    pub fn status(&self) -> Option<Status> {
        self.status
    }

    /// Where it stands: the best so far.
    pub fn point(&self) -> &[f64] {
        &self.point
    }

    /// The same point, by value.
    pub fn into_point(self) -> Vec<f64> {
        self.point
    }

    /// Trials so far.
    pub fn trials(&self) -> usize {
        self.trials
    }

    /// Damping of the next step, relative to the diagonal of `J^T J`.
    pub fn damping(&self) -> f64 {
        self.damping
    }

    /// Fall of the cost that was predicted for the last proposal.
    pub fn promised(&self) -> f64 {
        self.promised
    }

    /// Ends it from outside.
    pub fn end(&mut self, status: Status) {
        self.status = Some(status);
    }

    /// The next trial, from what is known at the current point; `None` once the descent has ended.
    /// Without unknowns it has converged.
    pub fn propose(&mut self, settings: &Settings, region: Region, now: Sums) -> Option<Vec<f64>> {
        if self.status.is_some() {
            return None;
        }
        let Sums {
            derivatives: now,
            scale,
            beside,
        } = now;
        if self.point.is_empty() && beside == 0.0 {
            self.status = Some(Status::Converged);
            return None;
        }
        if self.trials >= settings.most_trials {
            self.status = Some(Status::Budget);
            return None;
        }
        self.trials += 1;
        self.cost = now.cost;
        if now.cost <= settings.exact_cost {
            self.status = Some(Status::Converged);
            return None;
        }
        let longest = settings.longest_step;
        let solved = damped_step(now, scale, &self.point, region, self.damping, longest);
        let step = match solved {
            Some(step) => step,
            None if beside > 0.0 => vec![0.0; self.point.len()],
            None => {
                self.status = Some(Status::Converged);
                return None;
            }
        };
        let trial = region.moved(&self.point, &step);
        let length = largest(&trial, &self.point);
        if length < settings.settled_step && beside == 0.0 {
            let flat = length == 0.0
                || predicted_gain(now, &difference(&trial, &self.point)) / length
                    <= settings.flat_slope * now.cost;
            self.status = Some(if self.damping <= UNDAMPED || flat {
                Status::Converged
            } else {
                Status::Stalled
            });
            return None;
        }
        self.promised = beside + predicted_gain(now, &difference(&trial, &self.point));
        let nothing = (settings.trusted_gain * now.cost).max(settings.cost_rounding);
        let trusted = length < settings.trusted_step && self.damping <= UNDAMPED && beside == 0.0;
        if trusted && self.promised.abs() <= nothing {
            if settings.take_untried {
                self.point = trial;
            }
            self.status = Some(Status::Converged);
            return None;
        }
        Some(trial)
    }

    /// Takes the cost of the last proposed trial; true if the descent moves to it.
    pub fn take(&mut self, settings: &Settings, trial: Vec<f64>, cost: f64) -> bool {
        let gained = self.cost - cost;
        if cost.is_finite() && gained > 0.0 {
            let ratio = if self.promised > 0.0 {
                gained / self.promised
            } else {
                1.0
            };
            let slow = gained <= settings.small_gain * self.cost;
            self.slow = if slow { self.slow + 1 } else { 0 };
            if gained <= settings.no_gain * self.cost || self.slow >= settings.small_gains {
                self.status = Some(Status::Converged);
            }
            self.point = trial;
            self.cost = cost;
            let shrink = match settings.damping_by_gain {
                true => (1.0 - (2.0 * ratio - 1.0).powi(3)).max(LEAST_SHRINK),
                false => LEAST_SHRINK,
            };
            self.damping = (self.damping * shrink).max(settings.least_damping);
            self.growth = FIRST_GROWTH;
            return true;
        }
        // For a step shortened by a bound a rise of the cost may be predicted: a shorter step follows the gradient.
        let nothing = (settings.no_gain * self.cost).max(settings.cost_rounding);
        if self.promised.abs() <= nothing {
            self.status = Some(Status::Converged);
        } else if self.damping > settings.most_damping {
            self.status = Some(Status::Stalled);
        }
        self.damping *= self.growth;
        self.growth *= 2.0;
        false
    }
}
