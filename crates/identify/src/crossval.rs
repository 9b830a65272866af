//! How well a law predicts samples that it was not fitted to: blocked cross-validation.
//!
//! What is left out is contiguous stretches of time, because neighbouring samples share their noise and their
//! model error; leaving out single samples would give every law too small an error. Many stretches make up one
//! block, so that what is left still holds every kind of motion: a law that is fitted to fast strokes alone cannot
//! be asked for slow reversals (decision 0048).

use crate::conditioning::blocks::Folds;
use crate::conditioning::record::Record;
use crate::estimate::{Estimate, predict};
use crate::fit::Fit;
use crate::law::Law;
use crate::left_out::Whole;
use crate::separable::objective::Objective;
use crate::separable::optimum::Optimum;
use crate::watch::Watch;
use stiction_search::{Observer, Stage};

/// Most steps of a descent without a block: what five times as many still gain moved no held-out error of the laws on EMPS
/// by more than about 1 %, which counts as equal.
const REFIT_STEPS: usize = 12;

/// How a law predicts held-out blocks.
#[derive(Clone, Debug, PartialEq)]
pub struct LawScore {
    /// The law.
    pub law: Law,
    /// Number of fitted parameters.
    pub parameters: usize,
    /// Fit on the samples it was fitted to.
    pub fitted: Fit,
    /// Fit on held-out samples; `None` where a block could not be fitted or there are too few.
    pub held_out: Option<Fit>,
    /// The same at low speed.
    pub held_out_low_speed: Option<Fit>,
    /// Residual on held-out samples, in their order; empty where there is no such fit.
    pub residual: Vec<f64>,
}

impl LawScore {
    /// How a fitted law predicts other records, with nothing fitted again.
    pub fn on(held_out: &[Record], fitted: &Estimate) -> Self {
        let (mut measured, mut residual, mut speed) = (Vec::new(), Vec::new(), Vec::new());
        for record in held_out {
            let series = predict(record, fitted);
            residual.extend(series.residual());
            measured.extend(series.measured);
            speed.extend(series.velocity);
        }
        Self::of(fitted, &measured, residual, &speed)
    }

    fn of(fitted: &Estimate, measured: &[f64], residual: Vec<f64>, speed: &[f64]) -> Self {
        let held_out = Fit::new(measured, &residual);
        let held_out_low_speed =
            held_out.and_then(|_| Fit::slow(measured, &residual, speed, fitted.low_speed_bound));
        Self {
            law: fitted.law,
            parameters: fitted.parameters.iter().filter(|p| p.identified).count(),
            fitted: fitted.fit,
            held_out,
            held_out_low_speed,
            residual: if held_out.is_some() {
                residual
            } else {
                Vec::new()
            },
        }
    }
}

/// Refits a law with each of `blocks` parts of the record left out, starting from the full fit, and puts together the
/// residuals of the parts, in the order of the samples. `optimum` is what the estimate was made from.
pub fn cross_validate(
    record: &Record,
    fitted: &Estimate,
    optimum: &Optimum,
    blocks: usize,
    observer: &mut dyn Observer,
) -> LawScore {
    let folds = Folds::of(record, blocks);
    if !folds.leave_enough(fitted.fitted_unknowns()) {
        return LawScore::of(fitted, &[], Vec::new(), &[]);
    }
    let objective = Objective::new(record, fitted.law, &fitted.terms);
    let mut watch = Watch::new(observer, Stage::CrossValidation);
    let at = objective.evaluate(fitted.unknowns(), true);
    watch.count(&objective, true);
    let whole = Whole {
        objective: &objective,
        terms: &fitted.terms,
        bounds: &optimum.bounds,
        secant: &optimum.secant,
        p: fitted.unknowns(),
        at: &at,
        steps: REFIT_STEPS,
    };
    match whole.residuals(&folds, &mut watch) {
        Some(residual) => {
            let speed = record.pick(|s| &s.velocity);
            LawScore::of(fitted, objective.force(), residual, &speed)
        }
        None => LawScore::of(fitted, &[], Vec::new(), &[]),
    }
}
