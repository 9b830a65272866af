//! What an axis may do.

use stiction_friction::ParamError;
use stiction_servo::motion;

/// The limits of an axis, SI; those of a rotary axis in brackets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// How far it may go from where it stands, to negative (<= 0) and to positive positions (>= 0), m (rad); not both 0.
    pub stroke: [f64; 2],
    /// Part of the stroke that is left free at either end, 0 to 0.45.
    pub end_zone: f64,
    /// > 0, m/s (rad/s).
    pub speed: f64,
    /// > 0, m/s^2 (rad/s^2).
    pub acceleration: f64,
    /// > 0, m/s^3 (rad/s^3).
    pub jerk: f64,
    /// Force (torque) that the drive can give for long, root mean square, > 0, N (N m).
    pub rated_force: f64,
    /// Largest force that it can give, at least the rated one, N (N m).
    pub peak_force: f64,
}

impl Limits {
    /// Refuses limits out of range.
    pub fn validate(&self) -> Result<(), ParamError> {
        for end in self.stroke {
            ParamError::finite("stroke", end)?;
        }
        let [low, high] = self.stroke;
        if low > 0.0 || high < 0.0 || low == high {
            let allowed = "from 0 or less to 0 or more: how far it may go from where it stands";
            return Err(ParamError::new(
                "stroke",
                if low > 0.0 { low } else { high },
                allowed,
            ));
        }
        if !(0.0..=0.45).contains(&self.end_zone) {
            return Err(ParamError::new(
                "end_zone",
                self.end_zone,
                "0 to 0.45 of the stroke",
            ));
        }
        ParamError::positive("speed", self.speed)?;
        ParamError::positive("acceleration", self.acceleration)?;
        ParamError::positive("jerk", self.jerk)?;
        ParamError::positive("rated_force", self.rated_force)?;
        ParamError::positive("peak_force", self.peak_force)?;
        if self.peak_force < self.rated_force {
            return Err(ParamError::new(
                "peak_force",
                self.peak_force,
                "at least the rated force",
            ));
        }
        Ok(())
    }

    /// How far a motion may go to negative and to positive positions, the end zones left free, m (rad).
    pub fn reach(&self) -> [f64; 2] {
        let [low, high] = self.stroke;
        let zone = self.end_zone * (high - low);
        // An axis that stands within an end zone may only leave it.
        [(low + zone).min(0.0), (high - zone).max(0.0)]
    }

    /// Those of a move at a part of the largest speed and acceleration.
    pub(crate) fn part(&self, speed: f64, acceleration: f64) -> motion::Limits {
        motion::Limits {
            velocity: speed * self.speed,
            acceleration: acceleration * self.acceleration,
            jerk: self.jerk,
        }
    }
}
