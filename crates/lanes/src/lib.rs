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
//! | what a step of the separable search needs, for many trials | [`sums`], [`shared_sums`] |
//! | the same for one trial | [`sums_alone`] |
//! | the motion of a mass under a given force, and its cost | [`plants`] |
//! | the cost of the best linear coefficients, for many trials | [`levels`], [`shared_sums`] |
//! | the columns of one trial, written out | [`trace`] |
//! | their derivatives, for given coefficients | [`slopes`] |
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
mod normal;
mod plant;
mod sensitive;
mod time_lanes;
mod trace;
mod track;

pub use candidate::Candidate;
pub use cost::{Scheme, costs};
pub use dispatch::InstructionSet;
pub use error::Error;
pub use normal::{Sums, Trial, levels, shared_sums, sums, sums_alone};
pub use plant::{Axis, Drive, Measured, Motion, Outcome, Stepping, plants};
pub use sensitive::OWN;
pub use trace::{Columns, slopes, trace};
pub use track::{Segment, Time, Track};
