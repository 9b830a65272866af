//! The column that says in which rows the axis is enabled, or in which mode it is.

use super::channel::Selector;
use super::select::select;
use super::{Mapping, describe};
use crate::{Error, Table};

/// The key of the axis file.
pub(crate) const KEY: &str = "columns.enable";
/// What the column is called in messages.
pub(super) const NAME: &str = "enable";

/// Which rows are kept: those in which a column holds 1, or a number of its own, such as that of a mode.
#[derive(Clone, Debug, PartialEq)]
pub struct Enable {
    /// Which column.
    pub column: Selector,
    /// The number of the rows that are kept; `None` for a column of 0 and 1, of which 1 is kept.
    pub equals: Option<f64>,
}

impl Enable {
    /// Where the column of a mapping is in a table; `None` where the mapping names none.
    pub(crate) fn of(mapping: &Mapping, table: &Table) -> Result<Option<usize>, Error> {
        let Some(enable) = &mapping.enable else {
            return Ok(None);
        };
        let at = |e: Error| e.of_setting(format!("{KEY}.column"));
        select(table, &enable.column, NAME).map(Some).map_err(at)
    }

    /// The number of the rows that are kept.
    pub fn kept(&self) -> f64 {
        self.equals.unwrap_or(1.0)
    }

    /// The line of the axis file that keeps the rows in which this column is 1.
    pub(super) fn whole_line(table: &Table, column: usize) -> String {
        describe::line(table, column, NAME)
    }

    /// The line of the axis file that keeps the rows in which this column holds a number.
    pub(crate) fn line(table: &Table, column: usize, equals: &str) -> String {
        describe::line_with(table, column, NAME, &format!("equals = {equals}"))
    }
}

/// The column in words: `7 "Enabled"`.
pub(crate) fn place(table: &Table, column: usize) -> String {
    describe::place(table, column)
}
