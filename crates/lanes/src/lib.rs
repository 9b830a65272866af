//! Batch friction kernels.
//!
//! A search tries thousands of candidates on one record. Here they advance together, one candidate a
//! vector lane, and only what the search needs comes out: costs, or the sums from which it takes its next
//! step. [`stiction_friction`] defines the law and is the oracle these kernels are tested against.
//!
//! | to have | call |
//! |---|---|
//! | a recorded motion, made ready once | [`Track::new`] |
//! | costs of candidates with all parameters given | [`costs`] |
//!
//! Loops over `[f64; N]` are compiled for several instruction sets, of which [`InstructionSet::best`] is
//! taken at run time. A result has the same bits with any of them, with any number of threads, and in any
//! company of other candidates.

mod candidate;
mod cost;
mod curve;
mod dispatch;
mod error;
mod exp;
mod lane_array;
mod time_lanes;
mod track;

pub use candidate::Candidate;
pub use cost::{Scheme, costs};
pub use dispatch::InstructionSet;
pub use error::Error;
pub use track::{Segment, Time, Track};
