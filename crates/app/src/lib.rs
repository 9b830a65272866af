//! Workflows behind every face of the product: axis files, identification, demo, results on disk.
//!
//! Each workflow takes what a user typed, resolved to plain data, and returns what came out; nothing
//! here prints. Files are written only by [`Bundle::write`].

pub mod axis;
pub mod check;
mod compare;
pub mod compare_file;
pub mod demo;
mod error;
mod export;
mod identify;
mod model;
mod output;
mod report;
pub mod reproduce;
pub mod result;
mod source;
mod spread;
pub mod study;
mod symbols;
pub mod text;
mod typed;

pub use axis::Axis;
pub use compare::{
    CompareOptions, Cost, Excitation, Input, ONE_START, bundle as compare_bundle, compare,
};
pub use error::{Error, Warning};
pub use export::{ExportOptions, Exported, Target, export};
pub use identify::{
    CostKind, Method, Options, Outcome, Procedures, Searching, Simulated, identify,
};
pub use model::ModelFile;
pub use output::{Bundle, check_folder, check_folder_of, check_inputs, write_atomic};
pub use source::{Source, load, table};
pub use stiction_identify::candidates::Scheme;
pub use stiction_identify::{Control, LawKind, Observer, Progress, Silent, Stage};
pub use study::{Study, StudyOutcome};

/// Limits the threads of the whole process; the first call counts. Results do not depend on it.
pub fn set_threads(threads: usize) {
    let _ = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global();
}
