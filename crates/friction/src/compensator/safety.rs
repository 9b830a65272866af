//! From the law's force to the force that is applied.

use super::Settings;
use super::state::State;
use crate::Real;

impl<T: Real> Settings<T> {
    /// Applies the ramped gain, saturation and slew limit; the result is finite and within the limit.
    #[inline]
    pub(super) fn limit(&self, state: &mut State<T>, h: T, on: bool, wanted: T) -> T {
        state.share = self.ramped(state.share, h, on);
        let force = state.share * wanted;
        let force = force.max(-self.limit).min(self.limit);
        // h times the slew limit may be infinite: then there is no limit.
        let most = h * self.slew;
        let change = force - state.output;
        let next = if change.abs() <= most {
            force
        } else if change > T::ZERO {
            state.output + most
        } else {
            state.output - most
        };
        // A limit that was lowered acts at once.
        state.output = next.max(-self.limit).min(self.limit);
        state.output
    }

    /// The share after `h` seconds of its ramp towards the gain (`on`) or towards 0.
    fn ramped(&self, share: T, h: T, on: bool) -> T {
        let end = if on { self.gain } else { T::ZERO };
        if share == end {
            return end;
        }
        let change = if h < self.ramp { h / self.ramp } else { T::ONE };
        if share < end {
            (share + change).min(end)
        } else {
            (share - change).max(end)
        }
    }
}
