//! Motion logs: readers for the formats drives write, units, column mapping, and what is wrong with
//! a recording.
//!
//! Data flows one way: bytes -> [`Table`] (columns as they stand in the file) -> mapping and units ->
//! `Log` (SI, checked). A reader never guesses silently: what it detected is in
//! [`Table::detected`], what it cannot decide is an [`Error`] that lists the choices.

mod error;
mod table;

pub use error::{Error, Kind, Place};
pub use table::{Column, Scalar, Table};
