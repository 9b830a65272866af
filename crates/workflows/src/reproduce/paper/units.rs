//! Units of an axis as they are typed.

use stiction_servo::known::Kind;

/// SI units of an axis as they are typed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Of a position.
    pub length: &'static str,
    /// Of a velocity.
    pub speed: &'static str,
    /// Of a feed, and how many of it are one of the speed.
    pub feed: (&'static str, f64),
    /// Of what drives it.
    pub force: &'static str,
    /// Of what moves.
    pub mass: &'static str,
    /// Of sigma0.
    pub stiffness: &'static str,
    /// Of sigma1 and sigma2.
    pub damping: &'static str,
}

impl Units {
    pub(super) fn of(kind: Kind) -> Self {
        match kind {
            Kind::Linear => Units {
                length: "m",
                speed: "m/s",
                feed: ("m/min", 60.0),
                force: "N",
                mass: "kg",
                stiffness: "N/m",
                damping: "N*s/m",
            },
            Kind::Rotary => Units {
                length: "rad",
                speed: "rad/s",
                feed: ("rad/s", 1.0),
                force: "N*m",
                mass: "kg*m^2",
                stiffness: "N*m/rad",
                damping: "N*m*s/rad",
            },
        }
    }

    /// Of a parameter of the law by its name.
    pub fn of_parameter(&self, name: &str) -> &'static str {
        match name {
            "sigma0" => self.stiffness,
            "sigma1" | "sigma2" => self.damping,
            "stribeck_velocity" => self.speed,
            _ => self.force,
        }
    }
}
