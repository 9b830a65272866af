//! Columns of 0 and 1: something that is on or off, no quantity.

use crate::Table;
use stiction_formats::Passed;

/// Whether a column holds 0 and 1 alone and at least one 1, without a unit: a flag. A column of zeros may be a quantity at rest.
pub(super) fn is_flag(table: &Table, index: usize) -> bool {
    let column = &table.columns[index];
    let unit = column.unit.as_deref().unwrap_or_default().trim();
    let bare = matches!(
        unit.to_lowercase().as_str(),
        "" | "1" | "-" | "bool" | "bit"
    );
    bare && match table.passed.get(&index) {
        Some(Passed { ones, others, .. }) => *ones && !others,
        None => {
            let mut numbers = column.values.iter().filter(|x| !x.is_nan());
            numbers.all(|x| *x == 0.0 || *x == 1.0) && column.values.contains(&1.0)
        }
    }
}

/// Whether a column of 0 and 1 holds a 0.
pub(super) fn has_zeros(table: &Table, index: usize) -> bool {
    match table.passed.get(&index) {
        Some(passed) => passed.zeros,
        None => table.columns[index].values.contains(&0.0),
    }
}
