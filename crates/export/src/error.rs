//! Why a model is not exported.

use stiction_friction::ParamError;
use stiction_number::shortest;

/// A model that cannot be exported to a target.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A name that is no identifier in every target.
    #[error(
        "name {found:?}; allowed: a letter, then letters, digits and single underscores, at most {} characters, not ending in an underscore",
        crate::IDENTIFIER_LENGTH
    )]
    Identifier {
        /// The name found.
        found: String,
    },
    /// A parameter that is too large, or too close to 0, for the number type of a file to compute with.
    #[error(
        "{name} = {}; allowed: from {} to {} (as {number_type})",
        shortest(*value),
        shortest(range.0),
        shortest(range.1)
    )]
    Range {
        /// The parameter, or `limit`.
        name: &'static str,
        /// As given.
        value: f64,
        /// Least and largest size.
        range: (f64, f64),
        /// `double`, `float`, `LREAL` or `REAL`.
        number_type: &'static str,
    },
    /// A parameter or setting that the law or the compensator does not take.
    #[error(
        "{} = {}; allowed: {} (as {number_type})",
        source.name,
        shortest(source.value),
        source.allowed
    )]
    Number {
        /// `double`, `float`, `LREAL` or `REAL`.
        number_type: &'static str,
        /// What is wrong.
        source: ParamError,
    },
    /// A cycle time that no controller has.
    #[error("cycle time {found} s; allowed: {} s to {} s", crate::check::CYCLE_TIMES.0, crate::check::CYCLE_TIMES.1)]
    CycleTime {
        /// The time found, s.
        found: f64,
    },
    /// A law that the target has no form for.
    #[error("target {target} has no form for the law {law}; allowed: {allowed}")]
    Law {
        /// The target.
        target: &'static str,
        /// The law found.
        law: &'static str,
        /// What the target takes.
        allowed: &'static str,
    },
    /// A target that needs to know the motor.
    #[error(
        "target {target} writes forces in per mille of the motor's rated force, and none was given; give it with --rated-force, in {unit}"
    )]
    RatedForce {
        /// The target.
        target: &'static str,
        /// Unit of the model's force.
        unit: String,
    },
    /// A target that takes forces only, and a model that counts in something else.
    #[error(
        "target {target} takes forces in {allowed}, and those of the model are in {found}; give the force a scale in the axis file, such as the force constant, and identify again"
    )]
    ForceUnit {
        /// The target.
        target: &'static str,
        /// Unit of the model's force.
        found: String,
        /// Unit that the target takes.
        allowed: &'static str,
    },
    /// An archive that cannot be made.
    #[error("archive: {found}")]
    Archive {
        /// What went wrong.
        found: String,
    },
}

impl Error {
    pub(crate) fn number(number_type: &'static str, source: ParamError) -> Self {
        Error::Number {
            number_type,
            source,
        }
    }
}
