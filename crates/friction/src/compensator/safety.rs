//! From the law's force to the force that is applied.

use super::Settings;
use super::Terms;
use super::state::State;
use crate::Real;

impl<T: Real> Settings<T> {
    /// Applies the ramped gain, adds what is fed forward beside friction, saturation and slew limit; the result is finite and
    /// within the limit. What is fed forward comes with whether the compensator is enabled.
    #[inline]
    pub(super) fn limit(
        &self,
        state: &mut State<T>,
        h: T,
        on: bool,
        wanted: T,
        fed: Option<(&Terms<T>, bool)>,
    ) -> T {
        let gain = if on { self.gain } else { T::ZERO };
        state.share = self.ramped(state.share, h, gain);
        let mut force = state.share * wanted;
        if let Some((terms, enabled)) = fed {
            force = terms.feed(&mut state.beside, self, h, (on, enabled), force);
        }
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
        if fed.is_some() {
            let weight = state.beside.parts.gravity;
            let weight = weight.max(-self.limit).min(self.limit);
            state.beside.added = (state.output - weight).abs();
        }
        state.output
    }

    /// The share after `h` seconds of its ramp towards `end`.
    #[inline]
    pub(super) fn ramped(&self, share: T, h: T, end: T) -> T {
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
