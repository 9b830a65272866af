//! The column that says in which rows the axis is enabled, or in which mode it is.

use super::channel::Selector;
use super::flags::{has_zeros, is_flag};
use super::select::select;
use super::{Mapping, describe, names};
use crate::findings::{Finding, full};
use crate::{Error, Table};
use stiction_say::Found;

/// The key of the axis file.
pub(crate) const KEY: &str = "columns.enable";
/// What the column is called in messages.
pub(super) const NAME: &str = "enable";

/// Which rows are kept: those in which a column holds 1, or a number of its own, such as that of a mode.
#[derive(Clone, Debug, PartialEq)]
pub struct Enable {
    /// Which column.
    pub column: Selector,
    /// The number of the rows that are kept; `None` for a column of 0 and 1, of which 1 is kept, and for a mask, of which all bits
    /// are then to be set.
    pub equals: Option<f64>,
    /// The bits of a status word that count; the others may be anything.
    pub mask: Option<u32>,
}

/// Bits of a status word of CiA 402 (object 6041h) that say its state, and what they are where operation is enabled:
/// `xxxx xxxx x01x 0111`.
const STATE: u32 = 0x6f;
const OPERATION_ENABLED: u32 = 0x27;

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
        self.equals.unwrap_or(self.mask.map_or(1.0, f64::from))
    }

    /// The number of the rows that are kept, in words.
    pub(crate) fn kept_words(&self) -> String {
        match self.mask {
            None => full(self.kept()),
            Some(mask) => format!("{} under mask 0x{mask:x}", self.shown(self.kept())),
        }
    }

    /// A number of the column as it is written: under a mask by its bits.
    pub fn shown(&self, value: f64) -> String {
        match self.mask.and(bits(value)) {
            Some(bits) => format!("0x{bits:x}"),
            None => full(value),
        }
    }

    /// What of a number counts: its bits under the mask, where there is one.
    pub fn counted(&self, value: f64) -> f64 {
        match self.mask {
            None => value,
            Some(mask) => bits(value).map_or(f64::NAN, |bits| f64::from(bits & mask)),
        }
    }

    /// The line of the axis file that keeps the rows in which a status word says that operation is enabled.
    fn status_line(table: &Table, column: usize) -> String {
        let with = format!("mask = 0x{STATE:x}, equals = 0x{OPERATION_ENABLED:x}");
        describe::line_with(table, column, NAME, &with)
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

/// The lowest 32 bits of a whole number, with or without its sign.
fn bits(value: f64) -> Option<u32> {
    /// Above it not every whole number is one of its own.
    const LARGEST: f64 = 9_007_199_254_740_992.0;
    let is_whole = value.fract() == 0.0 && value.abs() <= LARGEST;
    // Numbers below zero are those of a counter with a sign.
    is_whole.then_some(value as i64 as u32)
}

/// A column that says in which rows the axis is enabled, and is not used.
enum Unused {
    /// By its name and its zeros.
    Flag(usize),
    /// By the bits of its numbers.
    Status(usize),
}

impl Unused {
    /// The line of the axis file that leaves out its other rows.
    fn line(&self, table: &Table) -> String {
        match *self {
            Self::Flag(column) => Enable::whole_line(table, column),
            Self::Status(column) => Enable::status_line(table, column),
        }
    }
}

/// The column that says that the axis was not enabled in some rows, where a mapping keeps them all.
fn unused(given: &Mapping, table: &Table) -> Option<Unused> {
    if given.enable.is_some() {
        return None;
    }
    let says = |column: &usize| {
        names::says_enabled(&table.columns[*column].name)
            && is_flag(table, *column)
            && has_zeros(table, *column)
    };
    let mut columns = 0..table.columns.len();
    let flag = columns.clone().find(says).map(Unused::Flag);
    flag.or_else(|| columns.find(|c| is_status(table, *c)).map(Unused::Status))
}

/// Whether a column is a status word of CiA 402 by its name, with rows in which operation is enabled and others in which it is not.
fn is_status(table: &Table, index: usize) -> bool {
    let column = &table.columns[index];
    if !names::says_status_word(&column.name) || table.passed.contains_key(&index) {
        return false;
    }
    let enabled = |x: &f64| bits(*x).map(|bits| bits & STATE == OPERATION_ENABLED);
    let (mut on, mut off) = (false, false);
    for x in column.values.iter().filter(|x| !x.is_nan()) {
        match enabled(x) {
            None => return false,
            Some(true) => on = true,
            Some(false) => off = true,
        }
    }
    on && off
}

impl Mapping {
    /// The line of the axis file that leaves out the rows in which a column, by its name, says that the axis was not enabled, where
    /// this mapping keeps them all.
    pub fn enable_line(&self, table: &Table) -> Option<String> {
        Some(unused(self, table)?.line(table))
    }
}

/// Warns of such a column.
pub(super) fn ignored(given: &Mapping, table: &Table) -> Option<Finding> {
    let unused = unused(given, table)?;
    let (column, status_word) = match unused {
        Unused::Flag(column) => (column, false),
        Unused::Status(column) => (column, true),
    };
    Some(Finding::warning(Found::EnableIgnored {
        column: place(table, column),
        status_word,
        line: unused.line(table),
    }))
}

/// The column in words: `7 "Enabled"`.
pub(crate) fn place(table: &Table, column: usize) -> String {
    describe::place(table, column)
}
