//! Result of a fit to a [`replica`](crate::replica).

use crate::agreement::Told;
use crate::conditioning::record::Record;
use crate::conditioning::{Conditioning, condition_as};
use crate::effects::{self, Found};
use crate::estimate::Estimate;
use crate::estimate::uncertainty::unknowns;
use crate::replica::{Axis, Replica};
use crate::scatter::Scatter;
use crate::separable::descent::descend;
use crate::separable::logs::Logs;
use crate::separable::objective::{Evaluation, Objective};
use crate::separable::search_box::SearchBox;
use crate::watch::Watch;
use nalgebra::DMatrix;
use stiction_search::{Counts, Silent, Stage};

/// Seed of the replica without noise of the force.
const SILENT_SEED: u64 = 999;
/// Step of a logarithm, a factor of e, beyond which a Gauss-Newton step is not trusted (decision 0014).
const LONGEST_STEP: f64 = 1.0;
/// Most trials of a descent.
const MOST_TRIALS: usize = 60;

/// What is asked of a fit of a replica.
#[derive(Clone, Copy)]
pub(crate) enum Asked<'a> {
    /// The unknowns, to first order.
    Unknowns,
    /// Also how sure they are.
    Scatter,
    /// Also what the logs tell where there are several, and what the residual shows where that is asked for.
    All(Option<&'a Logs>, bool),
}

/// Unknowns and coefficients that a fit of a replica finds, from its true values in Gauss-Newton steps: the errors are small, so
/// one step is accurate to first order, and two, where all is asked, are almost exact. Where two would lead far away, the record
/// hardly determines some unknown, and a full descent is made instead.
pub(crate) fn refitted(
    replica: &Replica,
    conditioning: &Conditioning,
    fitted: &Estimate,
    asked: Asked,
    counts: &mut Counts,
) -> Option<Refit> {
    // The noise of the position is asked of a log that replicas are made of, not of a replica that is fitted.
    let record = condition_as(&replica.logs, conditioning, 0.0).ok()?;
    let objective = Objective::new(&record, fitted.law, &replica.terms);
    let evaluated = |p: &[f64], counts: &mut Counts| {
        counts.derivatives += 1;
        objective.evaluate(p, true)
    };
    let mut at = evaluated(&replica.p, counts);
    let mut last = stepped(&objective, &replica.p, &at)?;
    let first = (last.longest <= LONGEST_STEP).then(|| First {
        p: last.p.clone(),
        c: last.c.clone(),
    });
    if !matches!(asked, Asked::Unknowns) {
        if last.longest > LONGEST_STEP {
            let p = descended(&objective, &replica.p, counts)?;
            at = evaluated(&p, counts);
            last = Stepped {
                c: at.solution.coefficients.clone(),
                p,
                longest: 0.0,
                fall: 0.0,
            };
        } else {
            at = evaluated(&last.p, counts);
            last = stepped(&objective, &last.p, &at)?;
        }
    }
    let scatter = matches!(asked, Asked::Scatter).then(|| unknowns(&objective, &at));
    let (told, effects) = match asked {
        Asked::Unknowns | Asked::Scatter => (None, Vec::new()),
        Asked::All(logs, effects) => {
            let told = logs.and_then(|logs| logs.told(&objective, &last.p, &at));
            let within = logs.and_then(|logs| logs.within(&at));
            let left = within.as_deref().unwrap_or(at.residual());
            let shows = || effects::sought(&objective, &replica.terms, (&at, &last.p), left);
            (told, if effects { shows() } else { Vec::new() })
        }
    };
    let refit = Refit {
        p: last.p,
        square: (at.cost - last.fall).max(0.0) / at.residual().len().max(1) as f64,
        c: last.c,
        first,
        scatter,
        told,
        effects,
    };
    let finite = |x: &[f64]| x.iter().all(|x| x.is_finite());
    (finite(&refit.p) && finite(&refit.c) && refit.square.is_finite()).then_some(refit)
}

/// The unknowns after a Gauss-Newton step from an evaluation.
struct Stepped {
    p: Vec<f64>,
    /// The coefficients there, to first order.
    c: Vec<f64>,
    /// Largest change of a logarithm that the step asked for.
    longest: f64,
    /// By how much it lowers the cost, to second order.
    fall: f64,
}

/// One step, in which no logarithm moves further than [`LONGEST_STEP`]; `None` where the equations have no solution.
fn stepped(objective: &Objective, from: &[f64], at: &Evaluation) -> Option<Stepped> {
    let wanted = at.hessian.clone().cholesky()?.solve(&at.descent);
    let step = wanted.map(|d| d.clamp(-LONGEST_STEP, LONGEST_STEP));
    let views: Vec<&[f64]> = at.columns.iter().map(|c| c.as_slice()).collect();
    let turned = at.solution.turned(&views, &at.slopes);
    let mut c = at.solution.coefficients.clone();
    for (j, (c, bounded)) in c.iter_mut().zip(objective.nonnegative()).enumerate() {
        *c += step.iter().zip(&turned).map(|(d, t)| d * t[j]).sum::<f64>();
        *c = if *bounded { c.max(0.0) } else { *c };
    }
    Some(Stepped {
        p: from.iter().zip(&step).map(|(x, d)| x + d).collect(),
        c,
        longest: wanted.amax(),
        fall: 2.0 * step.dot(&at.descent) - step.dot(&(&at.hessian * &step)),
    })
}

/// What a fit of a replica without force noise finds to first order, and what white noise of the force, of a standard
/// deviation of 1 in the log, would add.
pub(crate) struct FirstOrder {
    /// Nonlinear unknowns.
    pub p: Vec<f64>,
    /// Linear ones.
    pub c: Vec<f64>,
    /// Covariance of all of them.
    pub covariance: DMatrix<f64>,
    /// Number of samples of the fit.
    pub kept: usize,
}

/// The same fit as [`refitted`] in one step of all unknowns, at one evaluation.
pub(crate) fn first_order(
    replica: &Replica,
    conditioning: &Conditioning,
    fitted: &Estimate,
    counts: &mut Counts,
) -> Option<FirstOrder> {
    let record = condition_as(&replica.logs, conditioning, 0.0).ok()?;
    let objective = Objective::new(&record, fitted.law, &replica.terms);
    let at = objective.evaluate(&replica.p, true);
    counts.derivatives += 1;
    let (k, m) = (at.slopes.len(), at.columns.len());
    let factor = at.hessian.clone().cholesky()?;
    let Stepped { p, c, .. } = stepped(&objective, &replica.p, &at)?;
    let views: Vec<&[f64]> = at.columns.iter().map(|c| c.as_slice()).collect();
    let turned = at.solution.turned(&views, &at.slopes);
    let inner = factor.inverse();
    let gram = at.solution.inverse();
    let part = |i: usize, j: usize| -> f64 { (0..k).map(|l| inner[(i, l)] * turned[l][j]).sum() };
    let gain = record.noise_gain();
    let covariance = DMatrix::from_fn(k + m, k + m, |a, b| {
        gain * match (a.checked_sub(k), b.checked_sub(k)) {
            (None, None) => inner[(a, b)],
            (None, Some(j)) => part(a, j),
            (Some(i), None) => part(b, i),
            (Some(i), Some(j)) => {
                gram[i][j] + (0..k).map(|l| turned[l][i] * part(l, j)).sum::<f64>()
            }
        }
    });
    let finite = p.iter().chain(&c).chain(&covariance).all(|x| x.is_finite());
    let kept = record.kept();
    finite.then_some(FirstOrder {
        p,
        c,
        covariance,
        kept,
    })
}

/// What a fit of a replica finds.
pub(crate) struct Refit {
    /// Nonlinear unknowns.
    pub p: Vec<f64>,
    /// Linear ones.
    pub c: Vec<f64>,
    /// What the first step found; `None` where it is not to be trusted.
    pub first: Option<First>,
    /// How sure they are, where that was asked for.
    pub scatter: Option<Scatter>,
    /// What its logs tell, where that was asked for.
    pub told: Option<Told>,
    /// What its residual shows, where that was asked for.
    pub effects: Vec<Found>,
    /// Mean square of the residual.
    square: f64,
}

/// What the first step of a fit finds.
pub(crate) struct First {
    /// Nonlinear unknowns.
    pub p: Vec<f64>,
    /// Linear ones.
    pub c: Vec<f64>,
}

/// What a fit of a replica without noise of the force finds to first order.
pub(crate) struct Quiet {
    /// Nonlinear unknowns.
    pub p: Vec<f64>,
    /// Linear ones.
    pub c: Vec<f64>,
}

/// One step from the true values.
pub(crate) fn without_noise(
    quiet: &Replica,
    conditioning: &Conditioning,
    fitted: &Estimate,
    counts: &mut Counts,
) -> Option<Quiet> {
    let record = condition_as(&quiet.logs, conditioning, 0.0).ok()?;
    let objective = Objective::new(&record, fitted.law, &quiet.terms);
    let at = objective.evaluate(&quiet.p, true);
    counts.derivatives += 1;
    let Stepped { p, c, .. } = stepped(&objective, &quiet.p, &at)?;
    let finite = p.iter().chain(&c).all(|x| x.is_finite());
    finite.then_some(Quiet { p, c })
}

/// White noise of the logged force, from the residual of a fit: the part that a replica without force
/// noise does not show. The logged force itself cannot be used for this, because a controller responds to
/// every step of its encoder with a force that really acts on the axis.
pub(crate) fn force_noise(
    record: &Record,
    axis: &Axis,
    conditioning: &Conditioning,
    fitted: &Estimate,
    counts: &mut Counts,
) -> Option<f64> {
    let quiet = axis.replica(0.0, SILENT_SEED)?;
    let refit = refitted(&quiet, conditioning, fitted, Asked::Unknowns, counts)?;
    let left = (fitted.within * fitted.within - refit.square).max(0.0);
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
