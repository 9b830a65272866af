//! What is not known of a delay that jumps of friction tell.

use crate::conditioning::record::Record;
use crate::law::Law;
use crate::scatter::strokes::Strokes;

/// Variance, s^2, that the delay of a law without bristles has beyond what noise leaves: its friction jumps between two samples,
/// wherever between them the axis turned back.
pub(super) fn of_jumps(record: &Record, law: &Law) -> f64 {
    if law.kind.has_bristle() {
        return 0.0;
    }
    let turns = Strokes::of(record).length.len().saturating_sub(1);
    record.step().powi(2) / (12.0 * turns.max(1) as f64)
}
