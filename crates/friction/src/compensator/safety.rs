//! From the law's force to the one that is let through.

use super::{Settings, State};
use crate::Real;

impl<T: Real> Settings<T> {
    /// Ramp, gain, saturation and slew limit; the result is finite and within the limit.
    #[inline]
    pub(super) fn limit(&self, state: &mut State<T>, h: T, on: bool, wanted: T) -> T {
        state.share = self.ramped(state.share, h, on);
        let force = state.share * self.gain * wanted;
        let force = force.max(-self.limit).min(self.limit);
        // h times the slew limit may be infinite: then there is none.
        let most = h * self.slew;
        let change = force - state.output;
        state.output = if change.abs() <= most {
            force
        } else if change > T::ZERO {
            state.output + most
        } else {
            state.output - most
        };
        state.output
    }

    fn ramped(&self, share: T, h: T, on: bool) -> T {
        let end = if on { T::ONE } else { T::ZERO };
        if share == end {
            return end;
        }
        let change = if h < self.ramp { h / self.ramp } else { T::ONE };
        if on {
            (share + change).min(T::ONE)
        } else {
            (share - change).max(T::ZERO)
        }
    }
}
