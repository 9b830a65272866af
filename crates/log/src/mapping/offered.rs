//! The line of the axis file that is offered for a column, with a unit where nothing gives one.

use super::channel::{Motion, Role};
use super::{counted, describe, endings, names, rate};
use crate::{Table, Unit};
use stiction_policy::clock;

/// The line that makes a column a role, complete: with a unit to correct where neither the file nor its name gives one.
pub(super) fn line(table: &Table, column: usize, role: Role, motion: Option<Motion>) -> String {
    if counted::is_counted(table, column) && matches!(role, Role::Position | Role::Force) {
        return counted::lines(table, column, role, motion);
    }
    let own = &table.columns[column];
    let is_written = own.unit.as_deref().is_some_and(|u| !u.trim().is_empty());
    if is_written || endings::unit(table, column).is_some() {
        return describe::line(table, column, role);
    }
    if role == Role::Time {
        let first = times(&own.values).first().copied().unwrap_or("ms");
        let rest = match rate::are_ticks(&own.values) {
            true => rate::TICKS.to_string(),
            false => format!("unit = \"{first}\""),
        };
        return describe::line_with(table, column, role, &rest);
    }
    let motion = motion.or_else(|| names::motion(&own.name));
    let motion = motion.unwrap_or(Motion::Linear);
    let unit = match (role, motion) {
        (Role::Position | Role::Reference, Motion::Linear) => "mm",
        (Role::Position | Role::Reference, Motion::Rotary) => "deg",
        (Role::Velocity, Motion::Linear) => "mm/s",
        (Role::Velocity, Motion::Rotary) => "deg/s",
        (Role::Force | Role::External, _) if names::says_current(&own.name) => "A",
        (Role::Force | Role::External, Motion::Linear) => "N",
        (Role::Force | Role::External, Motion::Rotary) => "N m",
        _ => return describe::line(table, column, role),
    };
    let line = describe::line_with(table, column, role, &format!("unit = \"{unit}\""));
    // Of other columns no samples may have been read.
    let hint = endings::hint(table, column);
    let is_read = own.name.is_empty() || hint.is_some_and(|hint| hint.role == Role::Position);
    if role != Role::Position || !is_read || !counted::are_whole(&own.values) {
        return line;
    }
    // Whole numbers may be millimetres; most often an encoder counts them.
    let size = counted::size(role, &own.name, motion);
    let size = format!("unit = \"counts\", scale = \"{size}\"");
    let counts = describe::line_with(table, column, role, &size);
    format!("{line} or, where the whole numbers are counts of an encoder, {counts}")
}

/// Units in which a time column would be that of a motion log, seconds first.
pub(super) fn times(values: &[f64]) -> Vec<&'static str> {
    let steps = values.windows(2).map(|w| w[1] - w[0]);
    let mut steps: Vec<f64> = steps.filter(|d| d.is_finite()).collect();
    let Some(step) = crate::findings::median(&mut steps) else {
        return Vec::new();
    };
    let fits = |unit: &&str| {
        Unit::parse(unit)
            .is_ok_and(|unit| clock::PLAUSIBLE_SPACING.contains(&(unit.factor() * step)))
    };
    let units = ["s", "ms", "us", "ns", "min"].into_iter();
    units.filter(fits).collect()
}
