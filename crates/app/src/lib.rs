//! Workflows behind every face of the product: axis files, identification, demo, results on disk.
//!
//! Each workflow takes what a user typed, resolved to plain data, and returns what came out; nothing
//! here prints. Files are written only by [`Bundle::write`].

// An error carries where, what and what instead, and is made once, at the end.
#![allow(clippy::result_large_err)]

pub mod axis;
pub mod codes;
mod error;
mod identify;
mod model;
mod output;
mod report;
pub mod result;
mod source;
mod symbols;

pub use axis::Axis;
pub use error::{Error, Warning};
pub use identify::{Options, Outcome, identify};
pub use model::ModelFile;
pub use output::{Bundle, check_folder, write_atomic};
pub use source::{Source, load, table};
