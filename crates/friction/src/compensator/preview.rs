//! The reference velocity at the instant at which the force will act.

use crate::Real;

/// The velocity `samples` cycles from now, linear between the known samples: `velocity[0]` is that of now,
/// `velocity[1]` that of the next cycle, and so on. Beyond the last known sample its value is held; 0 if
/// none is known.
///
/// A force computed now acts later by the loop's delay and the current loop's lag: preview by that time. (The half
/// cycle of delay of a held force need not be added: the law is already stepped with the velocity at the end of the
/// cycle.) Where the set points of the next cycles are known, or can be delayed on their way to the controller, this
/// removes the delay of the compensation; at 1 kHz it gives the larger part of the improvement that is still
/// possible.
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
