//! What stiction does with logs and models, each as a function from plain data to a plain outcome.
//!
//! - [`check`](check::check): what was read, and what a log can and cannot determine.
//! - [`identify`](identify::identify): a law with intervals from logs, and whether it may be trusted.
//! - [`simulate`](study::simulate): a study of compensations on a simulated axis.
//! - [`compare`](compare::compare): search methods beside each other.
//! - [`reproduce`]: published experiments run again.
//! - [`export`](export::export): a model as code for a target.
//! - [`demo`](demo::demo): a known axis, simulated, identified and held against the truth.
//!
//! Begin with [`identify`](identify::identify). Forms of files are those of `stiction-files`; what people read is made
//! by `stiction-pages`; nothing here prints.

pub mod check;
pub mod compare;
pub mod demo;
mod entries;
mod error;
pub mod export;
pub mod identify;
pub mod reproduce;
pub mod source;
mod spread;
pub mod study;
pub mod verdict;

pub use error::Error;
pub use verdict::Verdict;

/// Limits the threads of the whole process; the first call counts. Results do not depend on it.
pub fn set_threads(threads: usize) {
    let _ = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global();
}
