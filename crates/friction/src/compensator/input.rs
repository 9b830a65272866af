//! What goes into a compensator at each step.

use crate::Real;

/// What the drive knows in a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Input<T> {
    /// Reference velocity, m/s (rad/s); where it is known, that of the instant at which the force will act
    /// ([`ahead`](super::ahead)).
    pub reference_velocity: T,
    /// Measured velocity, m/s (rad/s).
    pub measured_velocity: T,
    /// Reference position less measured position, m (rad).
    pub tracking_error: T,
    /// Whether to compensate.
    pub enable: bool,
}

impl<T: Real> Input<T> {
    pub(super) fn is_finite(&self) -> bool {
        self.reference_velocity.is_finite()
            && self.measured_velocity.is_finite()
            && self.tracking_error.is_finite()
    }
}
