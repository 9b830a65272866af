//! What to do where a descent stalls.
//!
//! The force is continuous in every unknown, its derivative is not: an element that just begins to slip
//! before a reversal has one derivative, one that just does not has another. At such a kink a step that
//! uses the derivatives of one side may fail to lower the cost although the point is no minimum, or the
//! point is a minimum although the gradient is not small.

use crate::separable::objective::Objective;
use crate::separable::search_box::SearchBox;
use crate::watch::Watch;

/// Steps that are tried, in logarithms: a step either passes a kink or does not, so a choice by decades
/// is fine enough.
const STEPS_TRIED: [f64; 3] = [1e-4, 1e-3, 1e-2];
/// Relative fall of the cost below which a step counts as no gain; well above the 1e-9 of the descents,
/// so that another descent is worth its cost.
const LEAST_GAIN: f64 = 1e-7;

/// The best point that lowers the cost by moving one unknown alone, either way; `None` if there is
/// none and the point is a minimum as far as such steps can tell.
pub(super) fn way_out(
    objective: &Objective,
    bounds: &SearchBox,
    p: &[f64],
    cost: f64,
    watch: &mut Watch,
) -> Option<Vec<f64>> {
    let mut least = (1.0 - LEAST_GAIN) * cost;
    let mut best = None;
    for i in 0..p.len() {
        for step in STEPS_TRIED.into_iter().flat_map(|s| [s, -s]) {
            let mut trial = p.to_vec();
            trial[i] += step;
            let trial = bounds.clamp(&trial);
            let found = objective.evaluate(&trial, false).cost;
            watch.count(objective, false);
            if found < least {
                least = found;
                best = Some(trial);
            }
        }
        watch.report(objective.relative(least));
        if watch.stopped {
            break;
        }
    }
    best
}
