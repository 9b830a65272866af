//! TRUE and FALSE in cells between numbers: no measurement, and no 1 or 0 either. They are read as missing, and named; a column of
//! them alone is one of flags.

use super::commas::letters;
use crate::text::{Cell, classify};

/// Where a sheet has such cells, a column each.
#[derive(Default)]
pub(super) struct Booleans {
    columns: Vec<Column>,
}

#[derive(Clone, Default)]
struct Column {
    numbers: u64,
    booleans: u64,
    /// The row of the first, and what it says.
    first: Option<(u64, String)>,
}

impl Booleans {
    /// Takes note of a cell (column from 0, row from 1).
    pub fn see(&mut self, column: usize, row: u64, text: &str, is_boolean: bool) {
        if text.is_empty() {
            return;
        }
        if self.columns.len() <= column {
            self.columns.resize(column + 1, Column::default());
        }
        let seen = &mut self.columns[column];
        if is_boolean {
            seen.booleans += 1;
            seen.first.get_or_insert_with(|| (row, text.to_owned()));
        } else if matches!(classify(text.as_bytes()), Cell::Text) {
            // The title of a column: what stands above it is no sample.
            *seen = Column::default();
        } else {
            seen.numbers += 1;
        }
    }

    /// Whether those of a column are among numbers.
    pub fn are_missing(&self, column: usize) -> bool {
        let seen = self.columns.get(column);
        seen.is_some_and(|seen| seen.numbers > 0 && seen.booleans > 0)
    }

    /// What is said of them.
    pub fn said(&self) -> impl Iterator<Item = String> {
        let columns = self.columns.iter().enumerate();
        columns.filter(|(column, _)| self.are_missing(*column)).filter_map(|(column, seen)| {
            let (row, text) = seen.first.as_ref()?;
            let letters = letters(column);
            Some(match seen.booleans {
                1 => format!("{text} in row {row} of column {letters}: no number, read as missing"),
                many => format!(
                    "{many} cells TRUE or FALSE among the numbers of column {letters}, first {text} in row {row}: read as missing"
                ),
            })
        })
    }
}
