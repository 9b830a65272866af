//! `model.toml`: a friction law with parameters, units, intervals, and where they came from.

pub(crate) mod covariance;
pub mod dependences;
mod fault;
mod form;
mod read;
mod refusal;
mod supported;

pub use covariance::root as square_root;
pub use dependences::Dependences;
pub use form::{BacklashEntry, ModelFile, ModelParameter, SCHEMA, SourceEntry, SourceInput};
pub(crate) use read::BY_HAND;
pub use read::ReadModel;
pub use supported::Lowered;
