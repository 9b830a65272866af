//! The text of a file that a user types, and the places in it.

use super::form::{self, Form};
use super::swept::Swept;
use super::syntax;
use crate::error::Error;
use std::path::Path;
use toml::de::DeTable;

/// A configuration file.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a> {
    /// For messages, and where paths in the file start from.
    pub file: &'a Path,
    pub text: &'a str,
    /// What it is to be.
    pub form: Form,
    /// A value in place of one of the file.
    pub swept: Option<Swept<'a>>,
}

impl<'a> Source<'a> {
    /// The tables of the text.
    pub fn parse(&self) -> Result<DeTable<'a>, Error> {
        match DeTable::parse(self.text) {
            Ok(table) => match form::of_tables(table.get_ref()) {
                Some(other)
                    if other != self.form && !form::may_be_both(table.get_ref(), self.form) =>
                {
                    Err(self.form.instead_of(self.file, other.what().into()))
                }
                _ => Ok(table.into_inner()),
            },
            Err(error) => Err(match form::of_text(self.text) {
                Some(found) => self.form.instead_of(self.file, found),
                None => syntax::refusal(self, &error),
            }),
        }
    }

    /// `line 3, column 8`, both counted from 1 as an editor shows them.
    pub fn at(&self, byte: usize) -> String {
        let before = self.text.get(..byte).unwrap_or(self.text);
        let line = before.matches('\n').count() + 1;
        let start = before.rfind('\n').map_or(0, |end| end + 1);
        let column = before[start..].chars().count() + 1;
        format!("line {line}, column {column}")
    }

    /// An error at a place that ends in `: `.
    pub fn error(&self, place: String, found: String, allowed: &str) -> Error {
        Error::Config {
            file: self.file.to_path_buf(),
            place,
            found,
            allowed: allowed.into(),
        }
    }
}
