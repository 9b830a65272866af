//! What to beware of in the identification of a robot.

use std::fmt;
use stiction_codes::Code;
use stiction_number::{Percent, counted, four_digits, quantity, short};

/// Something a user should know of a robot although the work went on.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
#[rustfmt::skip] // One line a kind.
pub enum OfRobot {
    /// No column is of a joint; where it is taken to stand.
    NotLogged { joint: String, at: f64, unit: &'static str },
    /// A joint does not move in the log.
    Still { joint: String },
    /// A joint moves and has no torque.
    NoTorque { joint: String },
    /// The only torque of a joint is one that is asked for.
    Commanded { joint: String, column: String },
    /// The robot file leaves a joint out.
    LeftOut { joint: String },
    /// A joint moves bodies that have no mass in the URDF.
    NoInertia { link: String, line: usize },
    /// No body has the inertia of a link in the URDF; its principal moments, kg m^2.
    NotPhysical { link: String, line: usize, principal: [f64; 3] },
    /// A joint mimics one that does not exist or does not move.
    NoLeader { joint: String, line: usize, leader: String },
    /// The positions of a joint go beyond its limits in the URDF, as those in other units would.
    BeyondLimits { joint: String, seen: [f64; 2], limits: [f64; 2], unit: &'static str },
    /// The last body is heavier than in the URDF, kg.
    Payload { link: String, mass: f64, deviation: f64 },
    /// A body is far from that of the URDF, in standard deviations of its prior.
    FarFromUrdf { link: String, times: f64 },
    /// The torque of all joints passed a low-pass before it was logged, Hz.
    Filtered { hertz: f64 },
    /// No column of a joint has a unit.
    UnitsAssumed,
    /// Rows that repeat the one before were left out; the rate of what they come from, Hz.
    Republished { repeats: usize, hertz: f64 },
    /// The motors of joints move several of them.
    Coupled { joints: Vec<String> },
    /// A target has nothing for the tool that the robot file names.
    ToolLeftOut { link: String, mass: f64, target: &'static str },
    /// A target has nothing for the inertia of rotors.
    ArmatureLeftOut { target: &'static str },
    /// The URDF is not the one of the identification.
    OtherUrdf { path: String },
    /// The friction of a joint could not be fitted.
    NotFitted { joint: String, why: String },
    /// The search for the friction of a joint ended early.
    NotConverged { joint: String },
    /// The model leaves too much of the torque of a joint.
    TorqueLeft { joint: String, left: f64, most: f64 },
}

impl OfRobot {
    /// The code that its page is named by.
    pub fn code(&self) -> Code {
        match self {
            Self::NotLogged { .. }
            | Self::Still { .. }
            | Self::NoTorque { .. }
            | Self::LeftOut { .. }
            | Self::NotFitted { .. } => Code::JointNotFitted,
            Self::Commanded { .. } => Code::ForceNotGiven,
            Self::NoLeader { .. }
            | Self::NoInertia { .. }
            | Self::NotPhysical { .. }
            | Self::OtherUrdf { .. }
            | Self::FarFromUrdf { .. }
            | Self::Payload { .. } => Code::UrdfInertia,
            Self::Republished { .. } => Code::DuplicateTime,
            Self::Coupled { .. } | Self::ToolLeftOut { .. } | Self::ArmatureLeftOut { .. } => {
                Code::ExportTerms
            }
            Self::NotConverged { .. } => Code::NotConverged,
            Self::TorqueLeft { .. } => Code::PoorFit,
            Self::UnitsAssumed | Self::BeyondLimits { .. } => Code::UnitAssumed,
            Self::Filtered { .. } => Code::ForceFiltered,
        }
    }

    /// Whether it says no more than what was done.
    pub fn is_note(&self) -> bool {
        matches!(
            self,
            Self::NotLogged { .. }
                | Self::UnitsAssumed
                | Self::LeftOut { .. }
                | Self::NoInertia { .. }
        )
    }
}

impl fmt::Display for OfRobot {
    #[rustfmt::skip] // One line a text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotLogged { joint, at, unit } => write!(f, "joint {joint} has no column; it is taken to stand at {}. If it stands elsewhere, write under [joint.{joint}] in robot.toml: at = \"{} {unit}\"", quantity(*at, unit), short(*at)),
            Self::Still { joint } => write!(f, "joint {joint} does not move in the log, so its friction is not identified. Record a motion of all joints"),
            Self::NoTorque { joint } => write!(f, "joint {joint} has no torque or current column, so its friction is not identified. Name it under [joint.{joint}] in robot.toml: torque = \"COLUMN\""),
            Self::Commanded { joint, column } => write!(f, "the torque of joint {joint} is {column}, by its name a command: what the drive did not follow is taken for friction. Record the measured torque or current"),
            Self::LeftOut { joint } => write!(f, "joint {joint} is not fitted, as robot.toml says (fit = false)"),
            Self::NoInertia { link, line } => write!(f, "link {link} (line {line} of the URDF) moves without a mass; its inertia comes from the log alone"),
            Self::NoLeader { joint, line, leader } => write!(f, "joint {joint} (line {line} of the URDF) mimics {leader}, which does not move; it is taken as a joint of its own"),
            Self::NotPhysical { link, line, principal: [a, b, c] } => write!(f, "link {link} (line {line} of the URDF) has an inertia that no body has: principal moments {}, {} and {} kg m^2. Correct the URDF; the fit starts from the nearest possible inertia", short(*a), short(*b), short(*c)),
            Self::BeyondLimits { joint, seen: [low, high], limits: [least, most], unit } => write!(f, "joint {joint} goes from {} to {} {unit}, and the URDF allows {} to {}: the column may be in degrees, or of another joint. Write under [joint.{joint}] in robot.toml: position = {{ column = \"COLUMN\", unit = \"deg\" }}", short(*low), short(*high), short(*least), short(*most)),
            Self::Payload { link, mass, deviation } => write!(f, "link {link} carries {} +- {} kg more than the URDF has. If that is a tool, write in robot.toml, above its tables: tool = {{ link = \"{link}\", mass = \"{} kg\" }}", short(*mass), short(*deviation), short(*mass)),
            Self::FarFromUrdf { link, times } => write!(f, "the log asks for an inertia of link {link} that is far from the URDF, {} standard deviations. Check the direction of gravity, sign, zero and unit of the positions, gains and gear ratios of the torques, and the clock", short(*times)),
            Self::Filtered { hertz } => write!(f, "the torque was low-passed at about {} Hz before it was logged. The model passes the same filter; reversals faster than that are not seen. Log the unfiltered torque or current", short(*hertz)),
            Self::UnitsAssumed => f.write_str("the columns of the joints have no units; they are taken in rad, rad/s and N m (m, m/s and N of joints that slide). Name the unit of a column in robot.toml, as in: position = { column = \"q1\", unit = \"deg\" }"),
            Self::Republished { repeats, hertz } => write!(f, "{} repeat the row before: the readings come at {} Hz and were published again at a higher rate. The repeats are left out, and the rows are spaced evenly at the rate of the readings", counted(*repeats, "row"), four_digits(*hertz)),
            Self::NotConverged { joint } => write!(f, "joint {joint}: the search for its friction ended early"),
            Self::TorqueLeft { joint, left, most } => write!(f, "joint {joint}: the model leaves {} of the torque on samples that were not fitted; a feedforward needs at most {}. Record a motion that moves all joints at once through their range, both ways and at several speeds", Percent::error(100.0 * left).decimals(0), Percent::error(100.0 * most).decimals(0)),
            Self::ToolLeftOut { link, mass, target } => write!(f, "the tool of {} kg on link {link} is not in the files of target {target}: inertias are those of the robot without it. Add it to the URDF as a link of its own", short(*mass)),
            Self::ArmatureLeftOut { target } => write!(f, "the inertia of the rotors (armature in robot.toml) has no place in the files of target {target}; those of mujoco, isaaclab and newton have it"),
            Self::Coupled { joints } => write!(f, "the motors of {} are coupled: speeds and torques here are those of the joints. Turn them by the matrix of [[coupling]] in robot.toml, joints = C motors: the torques of the motors are its transpose times those of the joints", joints.join(", ")),
            Self::OtherUrdf { path } => write!(f, "{path} is not the URDF that the robot was identified with: its SHA-256 is another. Frames and joints have to be the same"),
            Self::NotFitted { joint, why } => write!(f, "joint {joint}: {why}"),
        }
    }
}
