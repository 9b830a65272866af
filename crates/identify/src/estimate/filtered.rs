//! What a velocity that the drive has filtered does not show.

use crate::conditioning::record::Record;
use crate::estimate::Estimate;
use stiction_parameters::Quantity;
use stiction_policy::delay;

/// Flags what depends on fast motion where the motion is a logged velocity that comes late: drives filter it, and the fitted delay
/// takes the phase of the filter but not its gain.
pub(super) fn flag_what_a_filter_hides(record: &Record, estimate: &mut Estimate) {
    let is_logged = record.segments.iter().all(|s| s.reading.is_empty());
    let late = -estimate.delay_samples();
    if !is_logged || late < delay::MIN_VELOCITY_LAG {
        return;
    }
    let of_fast_motion = [
        Quantity::Sigma0,
        Quantity::Sigma1,
        Quantity::Static,
        Quantity::StribeckVelocity,
        Quantity::StribeckExponent,
    ];
    let parameters = &mut estimate.fitted.parameters;
    for p in parameters
        .iter_mut()
        .filter(|p| p.identified && p.identifiable)
    {
        if of_fast_motion.contains(&p.name.quantity) {
            p.identifiable = false;
            p.reason = format!(
                "the velocity is logged {late:.1} samples after its force, as behind a filter, which fast motion does not pass \
                 unchanged; log the position"
            );
        }
    }
}
