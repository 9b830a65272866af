//! Files that a user types in TOML (axis, study, model): one way to read them all.
//!
//! A [`Source`] is parsed to a [`Table`]; the tables are asked for their keys one by one, and each [`Given`] value for what it
//! is to be: text, a number within a range, a value with its unit. A key that nobody asked for is refused. Every error
//! names file, line, column and key, what was found and what is allowed, also where a value turns out to be wrong only
//! when others are known.

mod form;
mod given;
pub(crate) mod machine;
mod name;
mod places;
mod source;
mod swept;
mod syntax;
mod table;
mod typed;

pub(crate) use form::Form;
pub use form::{Looks, looks, refuse_as_log};
pub(crate) use given::{ANY_COUNT, Given, LARGEST_SI};
pub(crate) use places::Places;
pub(crate) use source::Source;
pub(crate) use swept::Swept;
pub(crate) use table::Table;
pub(crate) use typed::read;
