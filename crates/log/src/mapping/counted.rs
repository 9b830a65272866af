//! Positions and forces in counts: by their names, where no unit says so, and counters that begin again.

use super::channel::{Motion, Role};
use super::{Mapping, describe, endings, names, select};
use crate::log::overflow;
use crate::{Dimension, Table};

/// Whether a column holds counts: by its unit; without one by its name, of an encoder also by its whole numbers.
pub(super) fn is_counted(table: &Table, column: usize) -> bool {
    if let Some(unit) = endings::unit_of(table, column) {
        return unit.dimension() == Dimension::COUNTS;
    }
    let column = &table.columns[column];
    let is_bare = column
        .unit
        .as_ref()
        .is_none_or(|unit| unit.trim().is_empty());
    let whole = || are_whole(&column.values);
    let name = &column.name;
    let by_object = names::says_position_object(name) || names::says_torque_object(name);
    let may_be = names::says_encoder(name) || by_object;
    is_bare && (names::speaks_of_counts(name) || may_be && whole())
}

/// Whether all numbers of a column are whole.
pub(super) fn are_whole(values: &[f64]) -> bool {
    let mut numbers = values.iter().filter(|x| x.is_finite()).peekable();
    numbers.peek().is_some() && numbers.all(|x| x.fract() == 0.0)
}

/// What a count of a role is worth on an axis, as an example.
pub(super) fn size(role: Role, name: &str, motion: Motion) -> &'static str {
    let [linear, rotary] = sizes(role, name);
    match motion {
        Motion::Linear => linear,
        Motion::Rotary => rotary,
    }
}

/// What a count of a role is worth, as an example: of a linear and of a rotary axis.
fn sizes(role: Role, name: &str) -> [&'static str; 2] {
    match role {
        Role::Force if names::says_current(name) => ["0.001 A/count"; 2],
        Role::Force => ["0.01 N/count", "0.01 N m/count"],
        _ => ["1 um/count", "0.5 mrad/count"],
    }
}

/// The lines that give a column in counts its size, of a linear and of a rotary axis, and that of a counter that begins again.
pub(super) fn lines(table: &Table, column: usize, role: Role, motion: Option<Motion>) -> String {
    let own = &table.columns[column];
    if role == Role::Force && names::says_torque_object(&own.name) {
        let rated = |torque: &str| {
            let of = format!("unit = \"0.1%\", scale = \"{torque}\"");
            describe::line_with(table, column, role, &of)
        };
        return match motion {
            Some(Motion::Linear) => rated("100 N"),
            _ => rated("1 N m"),
        };
    }
    let with = |scale: &str| {
        let unit = if own.unit.is_some() {
            ""
        } else {
            "unit = \"counts\", "
        };
        describe::line_with(table, column, role, &format!("{unit}scale = \"{scale}\""))
    };
    let [linear, rotary] = sizes(role, &own.name);
    let size = match motion {
        Some(Motion::Linear) => with(linear),
        Some(Motion::Rotary) => with(rotary),
        None if linear == rotary => with(linear),
        None => format!("{} or {}", with(linear), with(rotary)),
    };
    if role != Role::Position {
        return size;
    }
    match overflow::counts(&table.columns[column].values) {
        Some(counts) => format!(
            "{size}; it jumps as {} that begins again does: then also wrap = \"{counts} counts\" under [log]",
            stiction_say::counter(counts)
        ),
        None => size,
    }
}

impl Mapping {
    /// The counts after which the position of a table begins again, where it is in counts and jumps as a counter does.
    pub fn counter(&self, table: &Table) -> Option<u64> {
        let channel = self.position.as_ref()?;
        let unit = channel.unit.as_ref()?;
        let column = select::select(table, &channel.column, Role::Position).ok()?;
        let is_counted = unit.dimension() == Dimension::COUNTS;
        overflow::counts(&table.columns[column].values).filter(|_| is_counted)
    }
}
