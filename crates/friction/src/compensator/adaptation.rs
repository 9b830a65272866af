//! Adaptation of the friction level while running.

use crate::error::require;
use crate::{ParamError, Real};

/// A factor on the law's force that follows the tracking error: `level' = rate e F`, within `1 - range` to `1 + range`.
///
/// An axis that lags behind its reference in the direction of the compensating force is compensated too little, one that
/// runs ahead too much: the sign of `e F` says which. A gradient rule; that one factor on the whole law is enough to follow
/// a level that changes with load and temperature is the idea of Canudas de Wit, Lischinsky 1997 (Adaptive friction
/// compensation with partially known dynamic friction model).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptation<T> {
    /// > 0, 1/(J s) (1/(N m rad s)).
    pub rate: T,
    /// How far from 1 the factor may go, > 0 and < 1.
    pub range: T,
}

impl<T: Real> Adaptation<T> {
    pub(super) fn validate(&self) -> Result<(), ParamError> {
        ParamError::positive("adaptation_rate", self.rate)?;
        require(
            self.range > T::ZERO && self.range < T::ONE,
            "adaptation_range",
            self.range,
            "above 0 and below 1",
        )
    }

    #[inline]
    pub(super) fn step(&self, level: T, h: T, error: T, force: T) -> T {
        let next = level + h * self.rate * error * force;
        // A product that overflows to NaN changes nothing.
        let next = if next.is_finite() { next } else { level };
        next.max(T::ONE - self.range).min(T::ONE + self.range)
    }
}
