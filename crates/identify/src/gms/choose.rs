//! How well different numbers of elements predict samples that they were not fitted to.

use super::ladder::Rung;
use super::score::ElementsScore;
use crate::conditioning::blocks::Folds;
use crate::conditioning::record::Record;
use crate::law::terms::Terms;
use crate::left_out::Whole;
use crate::separable::objective::Objective;
use crate::watch::Watch;
use stiction_policy::choice;
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

/// The fewest elements among those with equal held-out error; those with the least BIC where something could not be held out
/// for all of them, as for laws ([`choose`](crate::choice::choose())). `rungs` has the fits behind the scores.
pub(super) fn best(scores: &[ElementsScore], rungs: &[Rung], record: &Record) -> usize {
    let held_out: Option<Vec<f64>> = scores.iter().map(|s| s.held_out_error_percent).collect();
    let Some(errors) = held_out else {
        let n = record.kept() as f64;
        let bic = |i: usize| {
            let unknowns = rungs[i].law.nonlinear() + rungs[i].law.elements;
            2.0 * n * libm::log(scores[i].fitted_error_percent) + unknowns as f64 * libm::log(n)
        };
        let all = 0..scores.len();
        return all.min_by(|&a, &b| bic(a).total_cmp(&bic(b))).unwrap_or(0);
    };
    let least = errors.iter().copied().fold(f64::INFINITY, f64::min);
    (0..scores.len())
        .filter(|&i| errors[i] <= choice::MAX_EQUAL_ERROR * least)
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
    if watch.stopped || !folds.leave_enough(unknowns) {
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
