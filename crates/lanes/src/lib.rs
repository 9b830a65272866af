//! Batch friction kernels. Start with [`Track::new`] and [`costs`], as in the example below.
//!
//! A search tries thousands of candidates on one record. Here they advance together, one candidate per
//! vector lane, and only what the search needs is returned: costs, or the sums from which it takes its next
//! step. [`stiction_friction`] defines the law, and these kernels are tested against it.
//!
//! | to have | call |
//! |---|---|
//! | a recorded motion, made ready once | [`Track::new`] |
//! | costs of candidates with all parameters given | [`costs`] |
//! | their residual force at every sample, to be filtered | [`residuals`] |
//! | what a step of the separable search needs, for many trials | [`sums`], [`shared_sums`] |
//! | the same for one trial | [`sums_alone`] |
//! | the motion of a mass under a given force, and its cost | [`plants`] |
//! | the cost of the best linear coefficients, for many trials | [`levels`], [`shared_sums`] |
//! | the columns of one trial, written out | [`trace`] |
//! | their derivatives, for given coefficients | [`slopes`] |
//! | both of a law with parameters for each direction | [`directed_levels`], [`directed_slopes`] |
//!
//! Loops over `[f64; N]` are compiled for several instruction sets, of which [`InstructionSet::best`] is
//! chosen at run time. A result has the same bits with any of them, with any number of threads, and whatever
//! other candidates are evaluated with it.
//!
//! ```
//! use stiction_lanes::{Candidate, InstructionSet, Scheme, Segment, Time, Track, costs};
//!
//! let velocity: Vec<f64> = (0..2000).map(|k| 0.02 * (k as f64 * 5e-3).sin()).collect();
//! let truth = Candidate::gaussian([1.2e5, 600.0, 60.0, 20.0, 30.0, 5e-3]);
//! let law = truth.law()?;
//! let mut z = 0.0;
//! let mut force = vec![law.force(z, velocity[0])];
//! for v in velocity.windows(2) {
//!     z = law.step_record(z, 1e-3, v[0], v[1]);
//!     force.push(law.force(z, v[1]));
//! }
//! let track = Track::new(&[Segment {
//!     time: Time::Step(1e-3),
//!     velocity: &velocity,
//!     force: &force,
//!     keep: &[],
//!     columns: &[],
//! }])?;
//! let stiffer = Candidate { stiffness: 1.3e5, ..truth };
//! let cost = costs(&track, &[truth, stiffer], Scheme::Explin, InstructionSet::best())?;
//! assert!(cost[0] < 1e-18 && cost[1] > 1.0); // N^2
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod candidate;
mod cost;
mod curve;
mod directed;
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
pub use cost::{Scheme, costs, residuals};
pub use directed::{DIRECTED, Directed, directed_levels, directed_slopes};
pub use error::Error;
pub use normal::{Sums, Trial, levels, shared_sums, sums, sums_alone};
pub use plant::{Axis, Drive, Measured, Motion, Outcome, Stepping, plants};
pub use sensitive::OWN;
pub use stiction_dispatch::InstructionSet;
pub use trace::{Columns, slopes, trace};
pub use track::{Segment, Time, Track};
