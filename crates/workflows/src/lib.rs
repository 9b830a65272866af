//! What stiction does with logs and models, each as a function from plain data to a plain outcome.
//!
//! - [`check`](check::check): what was read, and what a log can and cannot determine.
//! - [`identify`](identify::identify): a law with intervals from logs, and whether it may be trusted.
//! - [`Batch`](batch::Batch): many logs, each identified by itself.
//! - [`drift`](drift::drift): what changed on which machine, from the table of a batch.
//! - [`simulate`](study::simulate): a study of compensations on a simulated axis.
//! - [`compare`](compare::compare): search methods beside each other.
//! - [`reproduce`]: published experiments run again.
//! - [`plan`](plan::plan): the motion to record, within the limits of an axis.
//! - [`export`](export::export): a model as code for a target.
//! - [`Library`](library::Library): machines that are identified already.
//! - [`demo`](demo::demo): a known axis, simulated, identified and held against the truth.
//!
//! Begin with [`identify`](identify::identify), which goes from paths to an outcome, or with
//! [`source`] for logs in memory:
//!
//! ```
//! use stiction_files::Axis;
//! use stiction_formats::Column;
//! use stiction_workflows::{Error, source};
//!
//! let column = |name: &str, unit: &str, values: Vec<f64>| Column {
//!     name: name.into(),
//!     unit: Some(unit.into()),
//!     values,
//!     ..Column::default()
//! };
//! let time: Vec<f64> = (0..100).map(|k| 1e-3 * f64::from(k)).collect();
//! let position = time.iter().map(|t| 5.0 * (6.0 * t).sin()).collect();
//! let columns = vec![column("time", "s", time), column("position", "mm", position)];
//!
//! let log = source::in_memory("run 3", columns, &Axis::default())?;
//! assert_eq!(log.log.position.as_ref().map(Vec::len), Some(100)); // now in m
//! let refused = log.samples().unwrap_err(); // nothing to identify without a force
//! assert!(refused.to_string().contains("no force column"));
//! # Ok::<(), Error>(())
//! ```
//!
//! Files have the formats of `stiction-files`; reports and texts for people are made by `stiction-pages`; nothing
//! here prints.

pub mod batch;
pub mod check;
pub mod compare;
mod compile;
pub mod demo;
pub mod drift;
mod entries;
mod error;
pub mod export;
pub mod identify;
pub mod library;
pub mod plan;
pub mod reproduce;
pub mod robot;
pub mod source;
mod spread;
mod stepped;
pub mod study;
mod turns;
pub mod verdict;
mod wording;

pub use error::{Error, Parts};
pub use stepped::{Law, SteppedLaw, forces_along};
pub use verdict::Verdict;
pub use wording::{Part, Setting, Wording};

/// Limits the threads of the whole process; the first call counts. Results do not depend on it.
pub fn set_threads(threads: usize) {
    let _ = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global();
}
