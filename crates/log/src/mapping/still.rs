//! Columns that never change: no motion, and no force that moves anything.

use super::channel::Role;
use crate::Table;

/// Whether all numbers of a column are the same one.
pub(super) fn never_changes(table: &Table, index: usize) -> bool {
    if let Some(passed) = table.passed.get(&index) {
        return passed.never_changes();
    }
    let mut numbers = table.columns[index].values.iter().filter(|x| !x.is_nan());
    match numbers.next() {
        Some(first) => numbers.all(|x| x == first),
        None => false,
    }
}

/// Whether a column that never changes is no candidate for a role: a temperature or a load may well be constant.
pub(super) fn has_to_change(role: Role) -> bool {
    matches!(
        role,
        Role::Position | Role::Velocity | Role::Acceleration | Role::Force | Role::Reference
    )
}
