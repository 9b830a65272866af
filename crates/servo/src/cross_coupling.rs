//! Cross-coupled control: what matters for a part is the contour error, not the error of either axis.

use crate::controller::Controller;
use crate::plane::Deviation;
use stiction_friction::ParamError;

/// A PID on the deviation from the contour, whose output is shared between the axes by the direction cosines with which
/// the deviation was found, and added to the velocities that the position loops ask for (Koren 1980, Cross-coupled biaxial
/// computer control for manufacturing systems; Koren, Lo 1991, Variable-gain cross-coupling controller for contouring).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrossCoupling {
    /// >= 0, 1/s.
    pub proportional: f64,
    /// >= 0, 1/s^2.
    pub integral: f64,
    /// >= 0, dimensionless: on the rate of the deviation.
    pub derivative: f64,
    /// Largest velocity either way, > 0, m/s.
    pub limit: f64,
}

/// Its state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CouplingState {
    integral: f64,
    last: Option<f64>,
    rate: f64,
}

impl CrossCoupling {
    /// Gains beside two speed loops of which the slower has `bandwidth` Hz, w = 2 pi bandwidth: proportional 2.5 w, integral
    /// 2.5 w^2, derivative 2.
    ///
    /// Across the contour the loop is then three times as fast as that of an axis alone. With loops of 45 and 60 Hz that
    /// leaves phase margins of 36 and 30 degrees where all delays from measurement to force, half samples included, come to .66 ms; with a
    /// delay of more than .03 of the bandwidth's period, take a lower bandwidth here.
    pub fn tuned(bandwidth: f64, limit: f64) -> Result<Self, ParamError> {
        ParamError::positive("bandwidth", bandwidth)?;
        let omega = 2.0 * std::f64::consts::PI * bandwidth;
        let coupling = CrossCoupling {
            proportional: 2.5 * omega,
            integral: 2.5 * omega * omega,
            derivative: 2.0,
            limit,
        };
        coupling.validate()?;
        Ok(coupling)
    }

    /// The same for axes with these controllers. A PID integrates the position error itself, and two integrators of
    /// nearly the same error drift against each other until one is at its limit: above a PID the coupling has no integral.
    pub fn above(self, axes: [&Controller; 2]) -> Self {
        let integrates = |c: &&Controller| matches!(c, Controller::Pid(_) | Controller::Fuzzy(_));
        if axes.iter().any(integrates) {
            CrossCoupling {
                integral: 0.0,
                ..self
            }
        } else {
            self
        }
    }

    /// Refuses settings out of range.
    pub fn validate(&self) -> Result<(), ParamError> {
        ParamError::not_negative("coupling_proportional", self.proportional)?;
        ParamError::not_negative("coupling_integral", self.integral)?;
        ParamError::not_negative("coupling_derivative", self.derivative)?;
        ParamError::positive("coupling_limit", self.limit)
    }

    /// Velocities to add to both axes, m/s, from the deviation now, `h` seconds after the last. At the limit the integral
    /// is frozen.
    pub fn correction(&self, state: &mut CouplingState, h: f64, deviation: Deviation) -> [f64; 2] {
        let error = deviation.distance;
        let rate = (error - state.last.unwrap_or(error)) / h;
        state.last = Some(error);
        // Over two samples, for the steps of the encoders.
        state.rate += 0.5 * (rate - state.rate);
        let integral = state.integral + self.integral * h * error;
        let wanted = self.proportional * error + integral + self.derivative * state.rate;
        let velocity = wanted.clamp(-self.limit, self.limit);
        if velocity == wanted {
            state.integral = integral;
        }
        deviation.left.map(|cosine| cosine * velocity)
    }
}
