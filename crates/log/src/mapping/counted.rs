//! Positions in encoder counts: by their names, where no unit says so, and counters that begin again.

use super::channel::{Motion, Role};
use super::{Mapping, describe, names, select};
use crate::Table;
use crate::log::unwrap;

/// Whether a column without a unit holds encoder counts: by its name, of an encoder also by its whole numbers.
pub(super) fn is_counted(table: &Table, column: usize) -> bool {
    let column = &table.columns[column];
    let is_bare = column
        .unit
        .as_ref()
        .is_none_or(|unit| unit.trim().is_empty());
    let whole = || {
        let mut numbers = column.values.iter().filter(|x| x.is_finite()).peekable();
        numbers.peek().is_some() && numbers.all(|x| x.fract() == 0.0)
    };
    is_bare
        && (names::speaks_of_counts(&column.name) || names::says_encoder(&column.name) && whole())
}

/// The lines that give a column in counts its size, of a linear and of a rotary axis, and that of a counter that begins again.
pub(super) fn lines(table: &Table, column: usize, motion: Option<Motion>) -> String {
    let with = |scale: &str| {
        let is_written = table.columns[column].unit.is_some();
        let unit = if is_written {
            ""
        } else {
            "unit = \"counts\", "
        };
        describe::line_with(
            table,
            column,
            Role::Position,
            &format!("{unit}scale = \"{scale}\""),
        )
    };
    let size = match motion {
        Some(Motion::Linear) => with("1 um/count"),
        Some(Motion::Rotary) => with("0.5 mrad/count"),
        None => format!("{} or {}", with("1 um/count"), with("0.5 mrad/count")),
    };
    match period(&table.columns[column].values) {
        Some(counts) => format!(
            "{size}; it jumps as a counter of {} bits that begins again does: then also wrap = \"{counts} counts\" under [log]",
            counts.ilog2()
        ),
        None => size,
    }
}

/// The counts after which a counter begins again, where all its jumps are those of one.
fn period(values: &[f64]) -> Option<u64> {
    /// Part of the range that a step reaches only where the counter begins again.
    const JUMP: f64 = 0.5;
    let numbers: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    let low = numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let high = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let steps = numbers.windows(2).map(|pair| pair[1] - pair[0]);
    let jumps = steps.filter(|step| step.abs() > JUMP * (high - low));
    let mut bits = jumps.map(|jump| unwrap::bits(jump, 1.0));
    let first = bits.next()??;
    bits.all(|other| other == Some(first)).then_some(1 << first)
}

impl Mapping {
    /// The counts after which the position of a table begins again, where it is in counts and jumps as a counter does.
    pub fn counter(&self, table: &Table) -> Option<u64> {
        let channel = self.position.as_ref()?;
        let unit = channel.unit.as_ref()?;
        let column = select::select(table, &channel.column, Role::Position).ok()?;
        let is_counted = unit.dimension() == crate::Dimension::COUNTS;
        period(&table.columns[column].values).filter(|_| is_counted)
    }
}
