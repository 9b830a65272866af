//! How well a law predicts samples that it was not fitted to: blocked cross-validation.
//!
//! Blocks are contiguous stretches of time, because neighbouring samples share their noise and their
//! model error; leaving out single samples would give every law too small an error.

use crate::conditioning::blocks::kept_order;
use crate::conditioning::record::Record;
use crate::estimate::{Estimate, predict};
use crate::fit::Fit;
use crate::law::Law;
use crate::separable::objective::Objective;
use crate::separable::refine;
use crate::separable::search_box::SearchBox;
use stiction_search::{Observer, Status};

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

/// Refits a law with each of `blocks` contiguous blocks left out, starting from the full fit, and
/// pools the residuals of the blocks.
pub fn cross_validate(
    record: &Record,
    fitted: &Estimate,
    bounds: &SearchBox,
    blocks: usize,
    observer: &mut dyn Observer,
) -> LawScore {
    let mut measured = Vec::new();
    let mut residual = Vec::new();
    let mut speed = Vec::new();
    let mut complete = blocks >= 2;
    let order = kept_order(record);
    let total = record.kept();
    let unknowns = fitted.fitted_unknowns();
    // What is left of the record must still be enough for a fit.
    if total - total / blocks.max(1) < 10 * unknowns {
        complete = false;
    }
    for block in 0..if complete { blocks } else { 0 } {
        let inside = |i: usize| order[i].is_some_and(|k| k * blocks / total == block);
        let train = record.masked(|i| !inside(i));
        let test = record.masked(inside);
        let (p, c, status) = refine(
            &train,
            fitted.law,
            &fitted.terms,
            bounds,
            fitted.unknowns(),
            observer,
        );
        if status == Status::Interrupted {
            complete = false;
            break;
        }
        let objective = Objective::new(&test, fitted.law, &fitted.terms);
        let model = objective.model(&p, &c);
        residual.extend(objective.force().iter().zip(&model).map(|(u, y)| u - y));
        measured.extend_from_slice(objective.force());
        speed.extend(test.pick(|s| &s.velocity));
    }
    if !complete {
        residual.clear();
        measured.clear();
    }
    LawScore::of(fitted, &measured, residual, &speed)
}
