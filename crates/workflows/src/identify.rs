//! Identification: logs in, a law with intervals and a verdict out.
//!
//! [`identify()`] goes in four steps, each a file with a plain type that it hands on: the logs are loaded, conditioned to
//! a record, fitted, and the law is judged. Procedures and the simulation of the axis go other ways from the first step
//! to the last.

mod assemble;
mod beside;
mod choice;
mod compensation;
mod condition;
mod conditioning;
mod disagree;
mod fit;
mod friction;
mod heard;
mod judge;
mod ladder;
mod late;
mod left;
mod load;
mod logs;
mod machine;
mod method;
mod mixed;
mod options;
mod outcome;
mod outside;
mod pitch;
mod planned;
mod predict;
mod procedure;
mod remaining;
mod remedy;
mod run;
mod searched;
mod seen;
mod settled;
mod simulate;
mod stated;
mod trust;
mod turn;
mod turned;
mod unfit;
mod verdict;
mod weight;

pub(crate) use condition::record_of;
pub(crate) use load::Asked;
pub use method::Method;
pub use options::{CostKind, Files, Options, Procedures, Searching};
pub use outcome::{ForceFit, Found, Outcome, Simulated};
pub use predict::{Prediction, predict};
pub(crate) use run::identify_asked;
pub use run::{identify, identify_logs};
pub(crate) use searched::ranges;
pub use turn::{presliding_length, slowest_turn};
