//! Why values make no law, or a text is no name.

use crate::{LawKind, Name};
use stiction_friction::ParamError;

/// Why a set of parameters makes no law.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LawError {
    /// A parameter of the law has no value.
    #[error("the law {kind} needs {name}")]
    Missing {
        /// The law.
        kind: LawKind,
        /// The parameter; with a direction where the other direction has a value.
        name: Name,
    },
    /// Another law stands where LuGre is needed.
    #[error("the law is {kind}; allowed: lugre, dahl")]
    NotLuGre {
        /// The law.
        kind: LawKind,
    },
    /// A value that the law cannot have.
    #[error(transparent)]
    Value(#[from] ParamError),
}

/// A text that names no law.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is no law; allowed: {names}", names = LawKind::ALL.map(LawKind::name).join(", "))]
pub struct UnknownLaw(pub String);

/// A text that names no parameter.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is no parameter of any law")]
pub struct UnknownName(pub String);
