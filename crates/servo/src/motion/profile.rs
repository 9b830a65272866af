//! The jerk-limited motion profile: seven phases of constant jerk.

use crate::path::Reference;
use stiction_friction::ParamError;

/// Limits of a move; all > 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// m/s (rad/s)
    pub velocity: f64,
    /// m/s^2 (rad/s^2)
    pub acceleration: f64,
    /// m/s^3 (rad/s^3)
    pub jerk: f64,
}

impl Limits {
    /// Refuses limits that are not finite and > 0.
    pub fn validate(&self) -> Result<(), ParamError> {
        ParamError::positive("velocity", self.velocity)?;
        ParamError::positive("acceleration", self.acceleration)?;
        ParamError::positive("jerk", self.jerk)
    }
}

/// The fastest symmetric move from rest to rest over a distance within [`Limits`]
/// (Biagiotti, Melchiorri 2008, Trajectory Planning for Automatic Machines and Robots, section 3.4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    distance: f64,
    jerk: f64,
    /// Time at constant jerk at either end of a ramp, s.
    rounding: f64,
    /// Time of a ramp, s.
    ramp: f64,
    /// Time at constant velocity, s.
    cruise: f64,
}

impl Profile {
    /// `distance` in m (rad), of either sign, any finite value.
    pub fn new(distance: f64, limits: Limits) -> Result<Self, ParamError> {
        ParamError::finite("distance", distance)?;
        limits.validate()?;
        let Limits {
            velocity,
            acceleration,
            jerk,
        } = limits;
        let length = distance.abs();
        // The ramp to full velocity, with or without a part at full acceleration.
        let full = acceleration / jerk;
        let (mut rounding, mut ramp) = if velocity * jerk >= acceleration * acceleration {
            (full, full + velocity / acceleration)
        } else {
            let rounding = libm::sqrt(velocity / jerk);
            (rounding, 2.0 * rounding)
        };
        let mut cruise = length / velocity - ramp;
        if cruise < 0.0 {
            cruise = 0.0;
            if length >= 2.0 * acceleration * full * full {
                rounding = full;
                ramp = 0.5 * full + libm::sqrt(0.25 * full * full + length / acceleration);
            } else {
                rounding = libm::cbrt(0.5 * length / jerk);
                ramp = 2.0 * rounding;
            }
        }
        Ok(Profile {
            distance,
            jerk,
            rounding,
            ramp,
            cruise,
        })
    }

    /// Time from rest to rest, s.
    pub fn duration(&self) -> f64 {
        2.0 * self.ramp + self.cruise
    }

    /// Time of the ramp at either end, s.
    pub fn ramp(&self) -> f64 {
        self.ramp
    }

    /// Where it ends, m (rad).
    pub fn distance(&self) -> f64 {
        self.distance
    }

    /// The reference `t` seconds after the start; at rest before and after.
    pub fn at(&self, t: f64) -> Reference {
        let left = self.duration() - t;
        if t <= 0.0 || left <= 0.0 {
            let position = if t <= 0.0 { 0.0 } else { self.distance };
            return Reference {
                position,
                ..Reference::default()
            };
        }
        let sign = self.distance.signum();
        // Second half: the first, seen from the end.
        let (at, direction, origin) = if t <= left {
            (self.rising(t), sign, 0.0)
        } else {
            (self.rising(left), -sign, self.distance)
        };
        Reference {
            position: origin + direction * at.position,
            velocity: sign * at.velocity,
            acceleration: direction * at.acceleration,
        }
    }

    /// The jerk `t` seconds after the start, m/s^3 (rad/s^3); 0 before and after. Where it steps, the later value.
    pub fn jerk_at(&self, t: f64) -> f64 {
        let (left, tj, ta) = (self.duration() - t, self.rounding, self.ramp);
        if t < 0.0 || left <= 0.0 {
            return 0.0;
        }
        let ramp = |t: f64| match t {
            t if t < tj => self.jerk,
            t if t < ta - tj => 0.0,
            t if t < ta => -self.jerk,
            _ => 0.0,
        };
        // The second half is the first backwards, and jerk keeps its sign under that.
        self.distance.signum() * ramp(t.min(left))
    }

    /// Largest speed of the move, m/s (rad/s).
    pub fn peak_speed(&self) -> f64 {
        self.jerk * self.rounding * (self.ramp - self.rounding)
    }

    /// Largest acceleration of the move, either way, m/s^2 (rad/s^2).
    pub fn peak_acceleration(&self) -> f64 {
        self.jerk * self.rounding
    }

    /// Up to half time, towards positive positions.
    fn rising(&self, t: f64) -> Reference {
        let (j, tj, ta) = (self.jerk, self.rounding, self.ramp);
        let peak = j * tj;
        let velocity = peak * (ta - tj);
        if t < tj {
            Reference {
                position: j * t * t * t / 6.0,
                velocity: 0.5 * j * t * t,
                acceleration: j * t,
            }
        } else if t < ta - tj {
            Reference {
                position: peak * (3.0 * t * t - 3.0 * tj * t + tj * tj) / 6.0,
                velocity: peak * (t - 0.5 * tj),
                acceleration: peak,
            }
        } else if t < ta {
            let left = ta - t;
            Reference {
                position: 0.5 * velocity * ta - velocity * left + j * left * left * left / 6.0,
                velocity: velocity - 0.5 * j * left * left,
                acceleration: j * left,
            }
        } else {
            Reference {
                position: velocity * (t - 0.5 * ta),
                velocity,
                acceleration: 0.0,
            }
        }
    }
}
