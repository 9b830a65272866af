//! One descent from its start to its end.

use super::{Descent, Region, Settings, Sums};
use crate::observe::Control;
use crate::status::Status;

/// A sum of squares as a descent needs it. The problem stores the current point of the descent. It may have
/// further unknowns that the descent does not see: it eliminates them from the sums and moves them itself.
pub trait LeastSquares {
    /// Cost and derivatives at the current point. `damping` is that of the coming step, for unknowns that the
    /// problem eliminates; `None` where there are no derivatives, which ends the descent as stalled.
    fn sums(&mut self, damping: f64) -> Option<Sums<'_>>;

    /// Cost of a trial, with the damping of the step that led there; not finite where the trial has no cost.
    fn cost(&mut self, trial: &[f64], damping: f64) -> f64;

    /// The last trial is accepted: it is now the current point.
    fn accept(&mut self);

    /// Called after every trial; whether to go on.
    fn after_trial(&mut self) -> Control {
        Control::Continue
    }
}

/// Descends until it converges, stalls, is stopped or has used up its trials.
pub fn descend(
    problem: &mut impl LeastSquares,
    mut descent: Descent,
    region: Region,
    settings: &Settings,
) -> Descent {
    while descent.status().is_none() {
        let damping = descent.damping();
        let Some(now) = problem.sums(damping) else {
            descent.end(Status::Stalled);
            break;
        };
        let Some(trial) = descent.propose(settings, region, now) else {
            break;
        };
        let cost = problem.cost(&trial, damping);
        if descent.take(settings, trial, cost) {
            problem.accept();
        }
        if problem.after_trial() == Control::Stop {
            descent.end(Status::Interrupted);
        }
    }
    descent
}
