//! A known controller, run on the recorded reference and the simulated position.

use crate::error::Error;

/// A sampled P or PI speed controller inside a P position controller, as drives have them.
///
/// With reference r, position x and control period h, at each control instant:
///
/// ```text
/// speed = (x_k - x_{k-1}) / h
/// e     = Kp (r - x) + c r' - speed
/// I    += Ki h e                                   (not further into saturation)
/// u     = Kv e + I + Ma r''                        within +-limit, held until the next instant
/// ```
///
/// r' and r'' are central differences of the recorded reference. With `Ki = 0` and no feedforward this
/// is the published law of the EMPS benchmark (Janot, Gautier, Brunot 2019), sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controller {
    /// Position gain Kp, > 0, 1/s.
    pub position_gain: f64,
    /// Speed gain Kv, > 0, in units of the force: N s/m (N m s/rad).
    pub speed_gain: f64,
    /// Integral gain Ki of the speed loop, >= 0, N/m (N m/rad).
    pub integral_gain: f64,
    /// Share c of the reference speed that is fed forward, 0 to 1.
    pub velocity_feedforward: f64,
    /// Mass Ma of the acceleration feedforward, >= 0, kg (kg m^2).
    pub mass_feedforward: f64,
    /// Largest force either way, > 0, N (N m); infinite for none.
    pub force_limit: f64,
    /// Control rate, Hz: the sample rate of the log or a multiple of it; `None` for the sample rate.
    pub rate: Option<f64>,
}

impl Controller {
    pub(crate) fn validate(&self) -> Result<(), Error> {
        let above = |name, found: f64| match found > 0.0 && found.is_finite() {
            true => Ok(()),
            false => Err(Error::Setting {
                name,
                found,
                allowed: "finite and above 0",
            }),
        };
        let not_negative = |name, found: f64| match found >= 0.0 && found.is_finite() {
            true => Ok(()),
            false => Err(Error::Setting {
                name,
                found,
                allowed: "finite, not negative",
            }),
        };
        above("controller.position_gain", self.position_gain)?;
        above("controller.speed_gain", self.speed_gain)?;
        not_negative("controller.integral_gain", self.integral_gain)?;
        not_negative("controller.mass_feedforward", self.mass_feedforward)?;
        if !(0.0..=1.0).contains(&self.velocity_feedforward) {
            return Err(Error::Setting {
                name: "controller.velocity_feedforward",
                found: self.velocity_feedforward,
                allowed: "a number from 0 to 1",
            });
        }
        if self.force_limit.is_nan() || self.force_limit <= 0.0 {
            return Err(Error::Setting {
                name: "controller.force_limit",
                found: self.force_limit,
                allowed: "above 0",
            });
        }
        self.rate
            .map_or(Ok(()), |rate| above("controller.rate", rate))
    }

    /// Control periods in one sample of `step` seconds.
    pub(crate) fn periods(&self, step: f64) -> Result<usize, Error> {
        let Some(rate) = self.rate else {
            return Ok(1);
        };
        let ratio = rate * step;
        let whole = libm::round(ratio);
        if (1.0..=MOST_PERIODS).contains(&whole) && (ratio - whole).abs() <= 1e-3 * whole {
            return Ok(whole as usize);
        }
        Err(Error::Setting {
            name: "controller.rate",
            found: rate,
            allowed: "the sample rate of the log, or 2 to 64 times that",
        })
    }

    /// Whether the integral is one more unknown of each run.
    pub(crate) fn has_integral(&self) -> bool {
        self.integral_gain > 0.0
    }

    /// The force to hold for `h` seconds, and whether it is limited and the integral stopped, which its
    /// derivatives need.
    pub(crate) fn force(&self, memory: &mut Memory, h: f64, wanted: Wanted, x: f64) -> Command {
        let speed = (x - memory.last) / h;
        memory.last = x;
        let error = self.position_gain * (wanted.position - x)
            + self.velocity_feedforward * wanted.velocity
            - speed;
        let integral = memory.integral + self.integral_gain * h * error;
        let force =
            self.speed_gain * error + integral + self.mass_feedforward * wanted.acceleration;
        let limited = force.max(-self.force_limit).min(self.force_limit);
        let winds_up = (force - limited) * error > 0.0;
        if !winds_up {
            memory.integral = integral;
        }
        Command {
            force: limited,
            is_limited: limited != force,
            winds_up,
        }
    }

    /// Derivative of the force for one unknown, given that of the position; updates the derivative memory.
    #[inline]
    pub(crate) fn slope(&self, memory: &mut Memory, h: f64, command: &Command, dx: f64) -> f64 {
        let error = -self.position_gain * dx - (dx - memory.last) / h;
        memory.last = dx;
        let integral = memory.integral + self.integral_gain * h * error;
        if !command.winds_up {
            memory.integral = integral;
        }
        if command.is_limited {
            0.0
        } else {
            self.speed_gain * error + integral
        }
    }
}

/// Most control periods in one sample.
const MOST_PERIODS: f64 = 64.0;

/// What the controller is asked for at one instant: m, m/s, m/s^2 (rad, ...).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Wanted {
    pub position: f64,
    pub velocity: f64,
    pub acceleration: f64,
}

/// What the controller remembers; for each unknown also the derivatives of the same.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Memory {
    /// Position at the last control instant.
    pub last: f64,
    /// Integral part of the force.
    pub integral: f64,
}

/// A force that the controller asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Command {
    pub force: f64,
    pub is_limited: bool,
    pub winds_up: bool,
}
