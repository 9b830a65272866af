//! How well different numbers of elements predict samples that they were not fitted to.

use super::ladder::Rung;
use super::score::ElementsScore;
use crate::conditioning::blocks::Folds;
use crate::conditioning::record::Record;
use crate::fit::EQUAL_ERROR_RATIO;
use crate::law::terms::Terms;
use crate::left_out::Whole;
use crate::separable::objective::Objective;
use crate::watch::Watch;
use stiction_search::Stage;

/// Parts of the record, each left out in turn.
const HELD_OUT_BLOCKS: usize = 4;
/// Steps of the refit when a block is left out.
const REFIT_STEPS: usize = 3;

/// Computes the scores of every rung (a fit with some number of elements), in the order given.
pub(super) fn scores(
    record: &Record,
    terms: &Terms,
    rungs: &[Rung],
    watch: &mut Watch,
) -> Vec<ElementsScore> {
    let folds = Folds::of(record, HELD_OUT_BLOCKS);
    watch.stage = Stage::CrossValidation;
    let mut out = Vec::with_capacity(rungs.len());
    for (i, rung) in rungs.iter().enumerate() {
        watch.fraction = i as f64 / rungs.len() as f64;
        let full = Objective::new(record, rung.law, terms);
        let held_out = held_out(&full, &folds, rung, terms, watch);
        out.push(ElementsScore {
            elements: rung.law.elements,
            fitted_error_percent: 100.0 * full.relative(rung.cost()),
            held_out_error_percent: held_out.map(|cost| 100.0 * full.relative(cost)),
        });
    }
    out
}

/// The rung with the fewest elements among those with equal held-out error; the one with the fewest where
/// nothing could be held out.
pub(super) fn best(scores: &[ElementsScore]) -> usize {
    let error = |s: &ElementsScore| s.held_out_error_percent;
    let least = scores
        .iter()
        .filter_map(error)
        .fold(f64::INFINITY, f64::min);
    let alike = |s: &ElementsScore| error(s).is_some_and(|e| e <= EQUAL_ERROR_RATIO * least);
    let any = scores.iter().any(alike);
    (0..scores.len())
        .filter(|&i| !any || alike(&scores[i]))
        .min_by_key(|&i| scores[i].elements)
        .unwrap_or(0)
}

/// Sum of squares of the residuals of all blocks, each with the fit to the other blocks.
fn held_out(
    full: &Objective,
    folds: &Folds,
    rung: &Rung,
    terms: &Terms,
    watch: &mut Watch,
) -> Option<f64> {
    let unknowns = rung.law.nonlinear() + full.linear().len();
    if watch.stopped || folds.of.len() < HELD_OUT_BLOCKS * 10 * unknowns {
        return None;
    }
    let whole = Whole {
        objective: full,
        terms,
        bounds: &rung.bounds,
        secant: &rung.descent.secant,
        p: &rung.descent.p,
        at: &rung.descent.evaluation,
        steps: REFIT_STEPS,
    };
    let residual = whole.residuals(folds, watch)?;
    let cost: f64 = residual.iter().map(|r| r * r).sum();
    cost.is_finite().then_some(cost)
}
