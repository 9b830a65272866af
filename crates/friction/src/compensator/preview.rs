//! The reference velocity at the instant at which the force will act.

use crate::Real;

/// The velocity `samples` cycles from now, linear between the samples known: `velocity[0]` is that of now,
/// `velocity[1]` that of the next cycle, and so on. Beyond the last one the last one; 0 if none is known.
///
/// A force computed now acts later by the loop's delay and the current loop's lag; that is the preview to take. (Of the
/// half cycle by which a held force is late, nothing is left: the law is stepped with the velocity at the cycle's end.)
/// Where the set points of the next cycles are known, or can be delayed on their way to the controller, this brings the
/// compensation back in time; at 1 kHz it is the larger part of what is left to gain.
///
/// ```
/// use stiction_friction::compensator::ahead;
/// assert_eq!(ahead(&[1.0, 2.0, 4.0], 1.5), 3.0);
/// assert_eq!(ahead(&[1.0, 2.0, 4.0], 7.0), 4.0);
/// ```
pub fn ahead<T: Real>(velocity: &[T], samples: T) -> T {
    let mut left = samples.max(T::ZERO);
    for ends in velocity.windows(2) {
        if left <= T::ONE {
            return ends[0] + left * (ends[1] - ends[0]);
        }
        left = left - T::ONE;
    }
    velocity.last().copied().unwrap_or(T::ZERO)
}
