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
mod contradictions;
mod disagree;
mod effects;
mod extrapolation;
mod fit;
mod force_unit;
mod friction;
mod heard;
mod inverted_sign;
mod judge;
mod ladder;
mod load;
mod logs;
mod machine;
mod method;
mod operating_range;
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
mod settling;
mod simulate;
mod time_offset;
mod trust;
mod turn;
mod verdict;
mod weight;

pub(crate) use compensation::rms;
pub(crate) use condition::{check_share, record_of};
pub(crate) use load::Asked;
pub use method::Method;
pub use options::{CostKind, Files, Options, Procedures, Searching};
pub use outcome::{ForceFit, Found, Outcome, Simulated};
pub use predict::{Prediction, predict};
pub(crate) use run::identify_asked;
pub use run::{identify, identify_files, identify_logs};
pub(crate) use searched::ranges;
pub use turn::{presliding_length, slowest_turn};
