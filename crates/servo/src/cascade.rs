//! The drive's controller: P in position around PI in speed.

use crate::path::Reference;
use stiction_friction::ParamError;

/// Settings of the cascade, immutable while it runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cascade {
    /// Position gain Kv, >= 0, 1/s.
    pub position_gain: f64,
    /// Speed gain, >= 0, N s/m (N m s/rad).
    pub speed_gain: f64,
    /// Integral gain of the speed loop, >= 0, N/m (N m/rad).
    pub integral_gain: f64,
    /// Acceleration feedforward, >= 0, kg (kg m^2): the axis' mass, or 0.
    pub mass_feedforward: f64,
    /// Largest force either way, > 0, N (N m).
    pub force_limit: f64,
}

/// The state of the controller.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CascadeState {
    last_position: Option<f64>,
    integral: f64,
}

impl Cascade {
    /// Gains for an axis of `mass` (kg, kg m^2), a speed loop of `bandwidth` (Hz) and a force limit (N, N m).
    ///
    /// Speed gain 2 pi bandwidth M, so that the open speed loop of a free mass crosses 1 there; position gain a quarter
    /// and integral corner a fifth of the bandwidth, which leaves a phase margin of some 60 degrees; full acceleration feedforward.
    pub fn tuned(mass: f64, bandwidth: f64, force_limit: f64) -> Result<Self, ParamError> {
        ParamError::positive("mass", mass)?;
        ParamError::positive("bandwidth", bandwidth)?;
        let omega = 2.0 * std::f64::consts::PI * bandwidth;
        let cascade = Cascade {
            position_gain: 0.25 * omega,
            speed_gain: omega * mass,
            integral_gain: 0.2 * omega * omega * mass,
            mass_feedforward: mass,
            force_limit,
        };
        cascade.validate()?;
        Ok(cascade)
    }

    /// Refuses settings out of range.
    pub fn validate(&self) -> Result<(), ParamError> {
        ParamError::not_negative("position_gain", self.position_gain)?;
        ParamError::not_negative("speed_gain", self.speed_gain)?;
        ParamError::not_negative("integral_gain", self.integral_gain)?;
        ParamError::not_negative("mass_feedforward", self.mass_feedforward)?;
        ParamError::positive("force_limit", self.force_limit)
    }

    /// The force, N (N m), to hold for the next `h` seconds, from the reference and the measured position (m, rad) at
    /// this instant. The speed is the difference of positions over the last sample.
    ///
    /// Anti-windup: while the force is at its limit the integral does not move further that way.
    pub fn force(
        &self,
        state: &mut CascadeState,
        h: f64,
        reference: Reference,
        position: f64,
    ) -> f64 {
        self.force_with(state, h, reference, position, 0.0)
    }

    /// [`force`](Self::force) with a further force, N (N m), that is fed forward: limit and anti-windup take it into
    /// account.
    #[inline]
    pub fn force_with(
        &self,
        state: &mut CascadeState,
        h: f64,
        reference: Reference,
        position: f64,
        feedforward: f64,
    ) -> f64 {
        let speed = (position - state.last_position.unwrap_or(position)) / h;
        state.last_position = Some(position);
        let wanted = reference.velocity + self.position_gain * (reference.position - position);
        let error = wanted - speed;
        let integral = state.integral + self.integral_gain * h * error;
        let force = self.mass_feedforward * reference.acceleration
            + self.speed_gain * error
            + integral
            + feedforward;
        let limited = force.clamp(-self.force_limit, self.force_limit);
        let winds_up = (force - limited) * error > 0.0;
        if !winds_up {
            state.integral = integral;
        }
        limited
    }
}
