//! Columns of 0 and 1: something that is on or off, no quantity.

use crate::Column;

/// Whether a column holds 0 and 1 alone and at least one 1, without a unit: a flag. A column of zeros may be a quantity at rest.
pub(super) fn is_flag(column: &Column) -> bool {
    let unit = column.unit.as_deref().unwrap_or_default().trim();
    let bare = matches!(
        unit.to_lowercase().as_str(),
        "" | "1" | "-" | "bool" | "bit"
    );
    let mut numbers = column.values.iter().filter(|x| !x.is_nan());
    bare && numbers.all(|x| *x == 0.0 || *x == 1.0) && column.values.contains(&1.0)
}
