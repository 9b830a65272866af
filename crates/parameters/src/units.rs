//! Units of parameters.

use crate::Dimension;

/// The units that the units of parameters are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Units<'a> {
    /// Unit of position: `m` or `rad`.
    length: &'static str,
    /// Unit of velocity: `m/s` or `rad/s`.
    speed: &'static str,
    /// Unit of the force, or of what stands for it: `N`, `N*m`, `A`, `V`, `1`.
    force: &'a str,
    /// Unit of the load channel; empty or `1` for a pure number.
    load: &'a str,
}

impl<'a> Units<'a> {
    /// Units of a linear axis (m) with this unit of force.
    pub fn linear(force: &'a str) -> Self {
        Units {
            length: "m",
            speed: "m/s",
            force,
            load: "",
        }
    }

    /// Units of a rotary axis (rad) with this unit of torque.
    pub fn rotary(force: &'a str) -> Self {
        Units {
            length: "rad",
            speed: "rad/s",
            force,
            load: "",
        }
    }

    /// The same with this unit of the load channel.
    #[must_use]
    pub fn with_load(self, load: &'a str) -> Self {
        Units { load, ..self }
    }

    /// Unit of a parameter of this dimension, such as `N*s/m`.
    pub fn of(&self, dimension: Dimension) -> String {
        let Units {
            length,
            speed,
            force,
            load,
        } = *self;
        match dimension {
            Dimension::Stiffness => format!("{force}/{length}"),
            Dimension::Damping => format!("{force}*s/{length}"),
            Dimension::Force => force.to_string(),
            Dimension::Length => length.to_string(),
            Dimension::Rate => "1/s".into(),
            Dimension::Speed => speed.to_string(),
            Dimension::Inertia => match (force, length) {
                ("N", "m") => "kg".into(),
                ("N*m", "rad") => "kg*m^2".into(),
                // A torque on a linear axis, a force on a rotary one.
                ("N*m", _) | ("N", _) => "kg*m".into(),
                (other, _) => format!("{other}*s^2/{length}"),
            },
            Dimension::Time => "s".into(),
            Dimension::QuadraticDamping => format!("{force}*s^2/{length}^2"),
            Dimension::ForcePerLoad if load == force => "1".into(),
            Dimension::ForcePerLoad => match load {
                "" | "1" => force.to_string(),
                simple if simple.chars().all(char::is_alphanumeric) => format!("{force}/{load}"),
                product => format!("{force}/({product})"),
            },
            Dimension::ForcePerTemperature => format!("{force}/K"),
            Dimension::DampingPerTemperature => format!("{force}*s/({length}*K)"),
            Dimension::Load if load.is_empty() => "1".into(),
            Dimension::Load => load.to_string(),
            Dimension::Temperature => "K".into(),
            Dimension::One => "1".into(),
        }
    }
}
