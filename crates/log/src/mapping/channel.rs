//! The roles of columns, and how one is selected and read.

use crate::{Dimension, Unit, Value};
use std::fmt;

/// Whether the axis moves along a line or turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Position in m, velocity in m/s, force in N.
    Linear,
    /// Position in rad, velocity in rad/s, torque in N m.
    Rotary,
}

impl Motion {
    /// Dimension of positions.
    pub fn position(self) -> Dimension {
        match self {
            Motion::Linear => Dimension::LENGTH,
            Motion::Rotary => Dimension::ANGLE,
        }
    }

    /// Dimension of velocities.
    pub fn velocity(self) -> Dimension {
        match self {
            Motion::Linear => Dimension::LINEAR_VELOCITY,
            Motion::Rotary => Dimension::ANGULAR_VELOCITY,
        }
    }

    /// Dimension of accelerations.
    pub fn acceleration(self) -> Dimension {
        match self {
            Motion::Linear => Dimension::LINEAR_ACCELERATION,
            Motion::Rotary => Dimension::ANGULAR_ACCELERATION,
        }
    }

    /// Dimension of forces: force or torque.
    pub fn force(self) -> Dimension {
        match self {
            Motion::Linear => Dimension::FORCE,
            Motion::Rotary => Dimension::TORQUE,
        }
    }
}

impl fmt::Display for Motion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Motion::Linear => "linear",
            Motion::Rotary => "rotary",
        })
    }
}

/// What a column can be used as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// When the sample was taken.
    Time,
    /// Measured position.
    Position,
    /// Measured velocity.
    Velocity,
    /// Measured acceleration.
    Acceleration,
    /// Force or torque that drives the axis, or the current or voltage it is proportional to.
    Force,
    /// Reference (commanded) position.
    Reference,
    /// Temperature.
    Temperature,
    /// Normal load, in whatever unit.
    Load,
    /// Force or torque that acts on the axis from outside.
    External,
}

impl Role {
    /// Every role, in the order of a log.
    pub const ALL: [Role; 9] = [
        Role::Time,
        Role::Position,
        Role::Velocity,
        Role::Acceleration,
        Role::Force,
        Role::Reference,
        Role::Temperature,
        Role::Load,
        Role::External,
    ];

    /// Those that a log may lack: found by name where the axis file neither names them nor says that there is none.
    pub const OPTIONAL: [Role; 4] = [
        Role::Acceleration,
        Role::Reference,
        Role::Temperature,
        Role::Load,
    ];

    /// The role's name, as its key in the axis file.
    pub fn name(self) -> &'static str {
        match self {
            Role::Time => "time",
            Role::Position => "position",
            Role::Velocity => "velocity",
            Role::Acceleration => "acceleration",
            Role::Force => "force",
            Role::Reference => "reference",
            Role::Temperature => "temperature",
            Role::Load => "load",
            Role::External => "external",
        }
    }

    /// The key of the axis file for a part of this column, `column`, `unit` or `scale`.
    pub(crate) fn key(self, part: &str) -> String {
        format!("columns.{}.{part}", self.name())
    }
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// How a column is named.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Selector {
    /// By its name, with or without the unit in brackets; case counts only where it must.
    Name(String),
    /// By its number, counted from 1.
    Index(usize),
}

/// What has the sign of a force that is logged as a magnitude.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Sign {
    /// Reference less position, as in a position loop.
    FollowingError,
    /// Another column.
    Column(Selector),
}

/// One column and how its numbers become SI: `number * unit * scale`, negated if inverted.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Which column.
    pub column: Selector,
    /// Unit of the column; takes precedence over a unit in the file.
    pub unit: Option<Unit>,
    /// What one unit of the column is worth, as `35.15 N/V`, `1 um/count` or a plain number.
    pub scale: Option<Value>,
    /// Whether the sign is inverted.
    pub invert: bool,
    /// Where the sign comes from if the column is a magnitude; of a force only.
    pub sign: Option<Sign>,
}

impl Channel {
    /// The column of this name, as it stands in the file.
    pub fn named(name: impl Into<String>) -> Self {
        Self {
            column: Selector::Name(name.into()),
            ..Self::index(0)
        }
    }

    /// The column of this number, counted from 1, as it stands in the file.
    pub fn index(number: usize) -> Self {
        Self {
            column: Selector::Index(number),
            unit: None,
            scale: None,
            invert: false,
            sign: None,
        }
    }

    /// The same column in this unit.
    #[must_use]
    pub fn unit(mut self, unit: Unit) -> Self {
        self.unit = Some(unit);
        self
    }

    /// The same column, worth this much.
    #[must_use]
    pub fn scale(mut self, scale: Value) -> Self {
        self.scale = Some(scale);
        self
    }

    /// The same column with its sign inverted.
    #[must_use]
    pub fn inverted(mut self) -> Self {
        self.invert = true;
        self
    }
}
