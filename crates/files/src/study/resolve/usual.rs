//! The motion of a path or contour that gives no numbers of its own: slow and short enough for any stage.

use super::dimensions::Dimensions;
use crate::config::Table;
use crate::error::Error;
use stiction_formats::Dimension;
use stiction_log::Motion;
use stiction_servo::motion::Limits;

/// What is usual on a kind of axis.
pub(super) struct Usual {
    is: Dimensions,
    /// Length of a move, of a side; radius of a circle; m (rad).
    pub way: f64,
    limits: Limits,
}

impl Usual {
    pub fn of(motion: Motion) -> Self {
        let (way, velocity, acceleration, jerk) = match motion {
            Motion::Linear => (0.01, 0.05, 1.0, 50.0),
            Motion::Rotary => (1.0, 5.0, 100.0, 5000.0),
        };
        Usual {
            is: Dimensions::of(motion),
            way,
            limits: Limits {
                velocity,
                acceleration,
                jerk,
            },
        }
    }

    /// The limits that are given, and those that are usual in place of the others.
    pub fn limits(&self, table: &Table<'_>) -> Result<Limits, Error> {
        let acceleration = Dimensions::per(self.is.speed, Dimension::TIME);
        let jerk = Dimensions::per(acceleration, Dimension::TIME);
        let or = |key, dimension, usual: f64| -> Result<f64, Error> {
            Ok(table.positive(key, dimension)?.unwrap_or(usual))
        };
        Ok(Limits {
            velocity: or("velocity", self.is.speed, self.limits.velocity)?,
            acceleration: or("acceleration", acceleration, self.limits.acceleration)?,
            jerk: or("jerk", jerk, self.limits.jerk)?,
        })
    }
}
