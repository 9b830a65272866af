//! Errors of an export.

use stiction_friction::ParamError;
use stiction_number::shortest;

/// A model that cannot be exported to a target.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A name that is not an identifier in every target.
    #[error(
        "name {found:?}; allowed: a letter, then letters, digits and single underscores, at most {} characters, not ending in an underscore",
        crate::IDENTIFIER_LENGTH
    )]
    Identifier {
        /// The name found.
        found: String,
    },
    /// A parameter that is too large or too small to be computed with in the number type of a file.
    #[error(
        "{name} = {}; allowed: from {} to {}{}",
        shortest(*value),
        shortest(if *value < 0.0 { -range.1 } else { range.0 }),
        shortest(range.1),
        written_as(*number_type)
    )]
    Range {
        /// The parameter, or `limit`.
        name: &'static str,
        /// As given.
        value: f64,
        /// Least and largest size.
        range: (f64, f64),
        /// `double`, `float`, `LREAL` or `REAL`; `None` for a value in memory.
        number_type: Option<&'static str>,
    },
    /// A parameter or setting that the law or the compensator refuses.
    #[error(
        "{} = {}; allowed: {}{}",
        source.name,
        shortest(source.value),
        source.allowed,
        written_as(*number_type)
    )]
    Number {
        /// `double`, `float`, `LREAL` or `REAL`; `None` for a value in memory.
        number_type: Option<&'static str>,
        /// What is wrong.
        source: ParamError,
    },
    /// An implausible cycle time.
    #[error(
        "cycle time {} s; allowed: {} s to {} s",
        shortest(*found),
        crate::check::CYCLE_TIMES.0,
        crate::check::CYCLE_TIMES.1
    )]
    CycleTime {
        /// The time found, s.
        found: f64,
    },
    /// A law that the target cannot express.
    #[error("target {target} cannot express the law {law}; allowed: {allowed}")]
    Law {
        /// The target.
        target: &'static str,
        /// The law found.
        law: String,
        /// The laws that the target can express.
        allowed: &'static str,
    },
    /// A target that needs the rated force of the motor.
    #[error(
        "target {target} writes forces in per mille of the motor's rated force, which is not known; give the rated force, in {unit}"
    )]
    RatedForce {
        /// The target.
        target: &'static str,
        /// Unit of the model's force.
        unit: String,
    },
    /// A target that needs SI forces, and a model in another unit.
    #[error(
        "target {target} needs forces in {allowed}, but those of the model are in {found}; give the force a scale in the axis file, such as the force constant, and identify again"
    )]
    ForceUnit {
        /// The target.
        target: &'static str,
        /// Unit of the model's force.
        found: String,
        /// Unit that the target takes.
        allowed: &'static str,
    },
    /// A target that writes what the model does not have.
    #[error("target {target}: {reason}")]
    Missing {
        /// The target.
        target: &'static str,
        /// What is missing, and what brings it in.
        reason: &'static str,
    },
    /// A target that takes one joint only.
    #[error(
        "target {target} takes no robot; allowed: {}; or export the model.toml of a joint by itself",
        crate::robot::TARGETS
    )]
    NoRobot {
        /// The target.
        target: &'static str,
    },
    /// A target that has no feedforward of a rigid body.
    #[error("target {target} has no feedforward of the rigid body; allowed: c")]
    RobotFeedforward {
        /// The target.
        target: &'static str,
    },
    /// A joint that the robot does not have as it should.
    #[error("joint \"{joint}\": {reason}")]
    RobotJoint {
        /// Name of the joint.
        joint: String,
        /// What is wrong.
        reason: &'static str,
    },
    /// A joint whose model a target cannot express.
    #[error("joint \"{joint}\": {source}")]
    OfJoint {
        /// Name of the joint.
        joint: String,
        /// Why.
        source: Box<Error>,
    },
    /// The URDF of a robot.
    #[error("URDF: {0}")]
    Urdf(#[from] stiction_rigid::Error),
    /// An archive that could not be written.
    #[error("archive: {found}")]
    Archive {
        /// What went wrong.
        found: String,
    },
}

impl Error {
    pub(crate) fn number(number_type: impl Into<Option<&'static str>>, source: ParamError) -> Self {
        Error::Number {
            number_type: number_type.into(),
            source,
        }
    }
}

/// ` (as REAL)` where a number is to be written into a file.
fn written_as(number_type: Option<&'static str>) -> String {
    number_type.map_or(String::new(), |name| format!(" (as {name})"))
}
