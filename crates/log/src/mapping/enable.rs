//! The column that says in which rows the axis is enabled, or in which mode it is.

use super::channel::Selector;
use super::flags::{has_zeros, is_flag};
use super::select::select;
use super::{Mapping, describe, names};
use crate::findings::{Finding, Severity};
use crate::{Error, Table};
use stiction_codes::Code;

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

/// The column that says by its name and its zeros that the axis was not enabled in some rows, where a mapping keeps them all.
fn unused(given: &Mapping, table: &Table) -> Option<usize> {
    let says = |column: &usize| {
        names::says_enabled(&table.columns[*column].name)
            && is_flag(table, *column)
            && has_zeros(table, *column)
    };
    let mut columns = (0..table.columns.len()).filter(|_| given.enable.is_none());
    columns.find(says)
}

impl Mapping {
    /// The line of the axis file that leaves out the rows in which a column, by its name, says that the axis was not enabled, where
    /// this mapping keeps them all.
    pub fn enable_line(&self, table: &Table) -> Option<String> {
        let column = unused(self, table)?;
        Some(Enable::whole_line(table, column))
    }
}

/// Warns of such a column.
pub(super) fn ignored(given: &Mapping, table: &Table) -> Option<Finding> {
    let column = unused(given, table)?;
    let message = format!(
        "column {} is 0 in some rows, and all rows are used: where the axis is not enabled, the force is not what moves it; if it \
         is enabled where the column is 1, leave out the others: {} under [columns] of the axis file",
        place(table, column),
        Enable::whole_line(table, column)
    );
    Some(Finding::new(
        Code::EnableIgnored,
        Severity::Warning,
        message,
    ))
}

/// The column in words: `7 "Enabled"`.
pub(crate) fn place(table: &Table, column: usize) -> String {
    describe::place(table, column)
}
