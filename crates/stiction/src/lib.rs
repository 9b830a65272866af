//! Friction of servo axes: from a drive's log to a law with intervals, and to its compensation.
//!
//! This crate puts the parts together: forms of files ([`axis`], [`result`], [`study`]), workflows ([`identify()`],
//! [`simulate`], [`compare()`], [`reproduce`], [`export()`]), what people read of them ([`text`], [`report`]), and which
//! files an outcome becomes ([`bundle`]).

pub mod bundle;
mod fit_csv;

pub use stiction_files::Error as FileError;
pub use stiction_files::study::Study;
/// Forms of files.
pub use stiction_files::{
    Axis, Bundle, ModelFile, Warning, axis, check_folder, check_folder_of, check_inputs,
    compare_file, model, reproduce_file, result, study, write_atomic,
};
/// Engine types that options and observers are made of.
pub use stiction_identify::candidates::Scheme;
pub use stiction_identify::{Control, LawKind, Observer, Progress, Silent, Stage};
/// Numbers as people read them.
pub use stiction_number as number;
/// Reports and text for a terminal.
pub use stiction_pages::{report, text};
pub use stiction_workflows::compare::{
    CompareOptions, Cost, Excitation, Input, ONE_START, compare,
};
pub use stiction_workflows::export::{ExportOptions, Exported, Target, export};
pub use stiction_workflows::identify::{
    CostKind, Method, Options, Outcome, Procedures, Searching, Simulated, identify,
};
pub use stiction_workflows::source::{Source, load, table};
pub use stiction_workflows::study::{StudyOutcome, simulate};
/// Workflows.
pub use stiction_workflows::{
    Error, check, compare, demo, export, identify, reproduce, set_threads, source,
};
