//! Which law holds on samples that it was not fitted to: blocked cross-validation.
//!
//! Blocks are contiguous stretches of time, because neighbouring samples share their noise and their
//! model error; leaving out single samples would flatter every law.

use crate::conditioning::record::Record;
use crate::estimate::Estimate;
use crate::fit::Fit;
use crate::law::Law;
use crate::observe::Observer;
use crate::separable::levenberg::Status;
use crate::separable::objective::Objective;
use crate::separable::refine;
use crate::separable::search_box::SearchBox;

/// How a law does on held-out blocks.
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
    if total < blocks * 10 * unknowns {
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
        speed.extend(test.gather(|s| &s.speed));
    }
    let held_out = if complete {
        Fit::new(&measured, &residual)
    } else {
        None
    };
    let held_out_low_speed =
        held_out.and_then(|_| Fit::slow(&measured, &residual, &speed, fitted.low_speed_bound));
    LawScore {
        law: fitted.law,
        parameters: unknowns,
        fitted: fitted.fit,
        held_out,
        held_out_low_speed,
    }
}

/// For each sample of the regression its place among the kept ones.
pub(crate) fn kept_order(record: &Record) -> Vec<Option<usize>> {
    let mut next = 0;
    record
        .segments
        .iter()
        .flat_map(|s| &s.keep)
        .map(|&keep| {
            keep.then(|| {
                next += 1;
                next - 1
            })
        })
        .collect()
}
