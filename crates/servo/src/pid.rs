//! PID in position with feedforward.

use crate::path::Reference;
use stiction_friction::ParamError;

/// Settings of a PID, immutable while it runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pid {
    /// >= 0, N/m (N m/rad).
    pub proportional: f64,
    /// >= 0, N/(m s) (N m/(rad s)).
    pub integral: f64,
    /// >= 0, N s/m (N m s/rad), on the reference velocity less the measured one.
    pub derivative: f64,
    /// Time constant of the derivative's filter, >= 0, s.
    pub filter: f64,
    /// Acceleration feedforward, >= 0, kg (kg m^2): the axis' mass, or 0.
    pub mass_feedforward: f64,
    /// Largest force either way, > 0, N (N m).
    pub force_limit: f64,
}

/// The state of a PID.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PidState {
    last_position: Option<f64>,
    rate: f64,
    integral: f64,
}

/// Factors on the gains of a PID; 1 leaves a gain as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scale {
    pub proportional: f64,
    pub integral: f64,
    pub derivative: f64,
}

pub(crate) const WHOLE: Scale = Scale {
    proportional: 1.0,
    integral: 1.0,
    derivative: 1.0,
};

impl Pid {
    /// Gains for an axis of `mass` (kg, kg m^2), a bandwidth (Hz) and a force limit (N, N m).
    ///
    /// With w = 2 pi bandwidth: Kd = w M, so that the loop of a free mass crosses 1 near it, Kp = .45 w^2 M,
    /// Ki = .05 w^3 M: the same loop, and the same stiffness against friction, as [`Cascade::tuned`] with that bandwidth.
    /// The derivative's filter is at ten times the bandwidth; full acceleration feedforward.
    ///
    /// [`Cascade::tuned`]: crate::cascade::Cascade::tuned
    pub fn tuned(mass: f64, bandwidth: f64, force_limit: f64) -> Result<Self, ParamError> {
        ParamError::positive("mass", mass)?;
        ParamError::positive("bandwidth", bandwidth)?;
        let omega = 2.0 * std::f64::consts::PI * bandwidth;
        let pid = Pid {
            proportional: 0.45 * omega * omega * mass,
            integral: 0.05 * omega * omega * omega * mass,
            derivative: omega * mass,
            filter: 0.1 / omega,
            mass_feedforward: mass,
            force_limit,
        };
        pid.validate()?;
        Ok(pid)
    }

    /// Refuses settings out of range.
    pub fn validate(&self) -> Result<(), ParamError> {
        ParamError::not_negative("proportional", self.proportional)?;
        ParamError::not_negative("integral", self.integral)?;
        ParamError::not_negative("derivative", self.derivative)?;
        ParamError::not_negative("filter", self.filter)?;
        ParamError::not_negative("mass_feedforward", self.mass_feedforward)?;
        ParamError::positive("force_limit", self.force_limit)
    }

    /// The force, N (N m), to hold for the next `h` seconds, from the reference and the measured position (m, rad) at
    /// this instant and a further force (N, N m) fed forward. Anti-windup as in the cascade.
    pub fn force(
        &self,
        state: &mut PidState,
        h: f64,
        reference: Reference,
        position: f64,
        feedforward: f64,
    ) -> f64 {
        let (error, rate) = self.errors(state, h, reference, position);
        self.scaled(state, h, (error, rate), WHOLE, reference, feedforward)
    }

    /// Error (m, rad) and its filtered rate (m/s, rad/s) at this instant.
    pub(crate) fn errors(
        &self,
        state: &mut PidState,
        h: f64,
        reference: Reference,
        position: f64,
    ) -> (f64, f64) {
        let speed = (position - state.last_position.unwrap_or(position)) / h;
        state.last_position = Some(position);
        // The lag of first order by the implicit Euler rule: stable whatever h is.
        state.rate += h / (h + self.filter) * (reference.velocity - speed - state.rate);
        (reference.position - position, state.rate)
    }

    pub(crate) fn scaled(
        &self,
        state: &mut PidState,
        h: f64,
        (error, rate): (f64, f64),
        scale: Scale,
        reference: Reference,
        feedforward: f64,
    ) -> f64 {
        let integral = state.integral + scale.integral * self.integral * h * error;
        let force = scale.proportional * self.proportional * error
            + integral
            + scale.derivative * self.derivative * rate
            + self.mass_feedforward * reference.acceleration
            + feedforward;
        let limited = force.clamp(-self.force_limit, self.force_limit);
        let winds_up = (force - limited) * error > 0.0;
        if !winds_up {
            state.integral = integral;
        }
        limited
    }
}
