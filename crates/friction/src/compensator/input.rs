//! What goes into a compensator at each step.

use crate::Real;

/// What the drive knows in a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// Force that the drive was given in the cycle before, the compensator's part included, N (N m): its last command, or the
    /// force that it measured. Only an
    /// [`Adaptation`](super::Adaptation) looks at it.
    pub drive_force: T,
    /// Whether an adaptation may learn: not while the drive is at its limits, or while something else than friction and
    /// inertia pushes.
    pub learn: bool,
    /// Acceleration of the reference, at the instant of its velocity, m/s^2 (rad/s^2). This and what follows is looked at where
    /// [`Terms`](super::Terms) depend on it; an acceleration that is not finite counts as not enabled.
    pub reference_acceleration: T,
    /// Position of the reference, or the measured one, m (rad). Where this or what follows is not finite, what came in last
    /// counts.
    pub position: T,
    /// Normal load, in the unit of the model.
    pub load: T,
    /// Temperature, K.
    pub temperature: T,
    /// Force (torque) that the transmission passes on to the load, N (N m): positive where the motor has to push towards positive
    /// positions.
    pub transmitted: T,
}

impl<T: Real> Default for Input<T> {
    /// Standstill, not enabled; position, load, temperature and what is transmitted not known.
    fn default() -> Self {
        let unknown = T::from_f64(f64::NAN);
        Input {
            reference_velocity: T::ZERO,
            measured_velocity: T::ZERO,
            tracking_error: T::ZERO,
            enable: false,
            drive_force: T::ZERO,
            learn: false,
            reference_acceleration: T::ZERO,
            position: unknown,
            load: unknown,
            temperature: unknown,
            transmitted: unknown,
        }
    }
}

impl<T: Real> Input<T> {
    pub(super) fn is_finite(&self) -> bool {
        self.reference_velocity.is_finite()
            && self.measured_velocity.is_finite()
            && self.tracking_error.is_finite()
    }
}
