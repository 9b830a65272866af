//! What a delay that is hardly known takes along, and what is not known of one that jumps of friction tell.

use crate::conditioning::record::Record;
use crate::estimate::Estimate;
use crate::law::Law;
use crate::law::terms::Delay;
use crate::misfit::reversals;
use crate::replica::{self, HELD_DELAY};
use stiction_parameters::Quantity;

/// Standard deviation of a delay, samples, from which it is hardly known.
const HARDLY_KNOWN: f64 = 0.3;

/// Flags stiffness, micro-damping and mass where a force seems to act later than any drive holds it by a delay that is hardly
/// known. On slow motion alone, what a controller answers to the steps of its encoder looks like such a delay: replicas with
/// that delay are as biased as the fit and show nothing.
pub(super) fn flag_what_an_unknown_delay_takes_along(record: &Record, estimate: &mut Estimate) {
    let delay = estimate.delay_samples();
    let is_sought = estimate.terms.delay == Delay::Fitted && estimate.lag_samples() == 0.0;
    let deviation = replica::deviation(estimate, record.step());
    let hardly_known = deviation.is_none_or(|deviation| deviation >= HARDLY_KNOWN);
    if !is_sought || !hardly_known || delay > HELD_DELAY - HARDLY_KNOWN {
        return;
    }
    let taken = [Quantity::Sigma0, Quantity::Sigma1, Quantity::Mass];
    let parameters = &mut estimate.fitted.parameters;
    let claimed = parameters
        .iter_mut()
        .filter(|p| p.identified && p.identifiable);
    for p in claimed.filter(|p| taken.contains(&p.name.quantity)) {
        p.identifiable = false;
        p.reason = "it moves with the delay of the force, which is hardly known; give [terms] delay if the drive states one".into();
    }
}

/// Variance, s^2, that the delay of a law without bristles has beyond what noise leaves: its friction jumps between two samples,
/// wherever between them the axis turned back.
pub(super) fn of_jumps(record: &Record, law: &Law) -> f64 {
    if law.kind.has_bristle() {
        return 0.0;
    }
    record.step().powi(2) / (12.0 * reversals(record).max(1) as f64)
}
