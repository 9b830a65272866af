//! Result of a fit to a [`replica`](crate::replica).

use crate::conditioning::record::Record;
use crate::conditioning::{Conditioning, condition};
use crate::estimate::Estimate;
use crate::estimate::uncertainty::{Unknowns, unknowns};
use crate::replica::{Replica, replica};
use crate::separable::descent::descend;
use crate::separable::objective::Objective;
use crate::separable::search_box::SearchBox;
use crate::watch::Watch;
use stiction_search::{Counts, Silent, Stage};

/// Seed of the replica without noise of the force.
const SILENT_SEED: u64 = 999;
/// Step of a logarithm, a factor of e, beyond which a Gauss-Newton step is not trusted (decision 0014).
const LONGEST_STEP: f64 = 1.0;
/// Most trials of a descent.
const MOST_TRIALS: usize = 60;

/// Unknowns and coefficients that a fit of a replica finds, from its true values in `steps` Gauss-Newton
/// steps: the errors are small, so one step is accurate to first order, and two are almost exact. Where
/// two would lead far away, the record hardly determines some unknown, and a full descent is made
/// instead. With `surety` also the uncertainty of that fit.
pub(crate) fn refitted(
    replica: &Replica,
    conditioning: &Conditioning,
    fitted: &Estimate,
    steps: usize,
    surety: bool,
    counts: &mut Counts,
) -> Option<Refit> {
    let record = condition(&replica.logs, conditioning).ok()?;
    let objective = Objective::new(&record, fitted.law, &replica.terms);
    let mut p = replica.p.clone();
    for _ in 0..steps {
        let at = objective.evaluate(&p, true);
        counts.derivatives += 1;
        let step = at.hessian.cholesky()?.solve(&at.descent);
        if steps > 1 && step.iter().any(|d| d.abs() > LONGEST_STEP) {
            p = descended(&objective, &replica.p, counts)?;
            break;
        }
        for (x, d) in p.iter_mut().zip(step.iter()) {
            *x += d.clamp(-LONGEST_STEP, LONGEST_STEP);
        }
    }
    let at = objective.evaluate(&p, surety);
    if surety {
        counts.derivatives += 1;
    } else {
        counts.costs += 1;
    }
    let unknowns = surety.then(|| unknowns(&objective, &at));
    let refit = Refit {
        p,
        square: at.cost / at.residual().len().max(1) as f64,
        c: at.solution.coefficients,
        unknowns,
    };
    let finite = |x: &[f64]| x.iter().all(|x| x.is_finite());
    (finite(&refit.p) && finite(&refit.c) && refit.square.is_finite()).then_some(refit)
}

/// What a fit of a replica finds.
pub(crate) struct Refit {
    /// Nonlinear unknowns.
    pub p: Vec<f64>,
    /// Linear ones.
    pub c: Vec<f64>,
    /// Their uncertainty from the residual, if asked for.
    pub unknowns: Option<Unknowns>,
    /// Mean square of the residual.
    square: f64,
}

/// White noise of the logged force, from the residual of a fit: the part that a replica without force
/// noise does not show. The logged force itself cannot be used for this, because a controller responds to
/// every step of its encoder with a force that really acts on the axis.
pub(crate) fn force_noise(
    record: &Record,
    conditioning: &Conditioning,
    fitted: &Estimate,
    counts: &mut Counts,
) -> Option<f64> {
    let quiet = replica(record, fitted, 0.0, SILENT_SEED)?;
    let refit = refitted(&quiet, conditioning, fitted, 1, false, counts)?;
    let left = (fitted.fit.rmse * fitted.fit.rmse - refit.square).max(0.0);
    Some((left / record.noise_gain()).sqrt())
}

/// Where a descent from `start` ends.
fn descended(objective: &Objective, start: &[f64], counts: &mut Counts) -> Option<Vec<f64>> {
    let record = objective.record();
    let mut bounds = SearchBox::from_record(record, objective.law()).ok()?;
    if start.len() > objective.law().nonlinear() {
        bounds = bounds.with_delay();
    }
    let mut silent = Silent;
    let mut watch = Watch::new(&mut silent, Stage::Calibration);
    let end = descend(objective, &bounds, start, MOST_TRIALS, &mut watch);
    counts.add(&watch.counts);
    Some(end.p)
}
