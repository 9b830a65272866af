//! Columns that have other time stamps than the rest, as a robot's state and its efforts in one file.

use super::channel::{Role, Selector};
use super::select::select;
use super::{Mapping, describe, names};
use crate::{Dimension, Table, Unit};

/// Part of the samples by which columns of one base may differ in length.
pub(crate) const MAX_CUT_SHARE: f64 = 0.01;

/// A column with other time stamps than the rows of a log.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnStamps {
    /// What it is.
    pub role: Role,
    /// Its time stamps.
    pub time: Selector,
    /// The line of the axis file that says so: `force = { column = "effort.tau", time = "effort.t" }`.
    pub line: String,
}

impl Mapping {
    /// Columns of this mapping that are of another length than its time column, each with a time column of its own length.
    pub fn own_stamps(&self, table: &Table) -> Vec<OwnStamps> {
        let length = |column: usize| table.columns[column].values.len();
        let place = |role: Role| {
            let channel = self.channel(role)?;
            select(table, &channel.column, role).ok()
        };
        let Some(time) = place(Role::Time) else {
            return Vec::new();
        };
        let others = Role::ALL.into_iter().filter(|role| *role != Role::Time);
        let of = |role: Role| {
            let column = place(role).filter(|column| differ(length(*column), length(time)))?;
            let stamps = stamps_of(table, column)?;
            let name = &table.columns[stamps].name;
            let unique = table.columns.iter().filter(|c| c.name == *name).count() == 1;
            let time = match unique && name.trim() == name && !name.is_empty() {
                true => Selector::Name(name.clone()),
                false => Selector::Index(table.number(stamps)),
            };
            let rest = describe::line(table, stamps, Role::Time);
            Some(OwnStamps {
                line: describe::line_with(table, column, role, &rest),
                role,
                time,
            })
        };
        others.filter_map(of).collect()
    }
}

/// Whether two columns are too far apart in length to be of one base.
fn differ(a: usize, b: usize) -> bool {
    let lost = a.abs_diff(b);
    lost > 2 && lost as f64 > MAX_CUT_SHARE * a.max(b) as f64
}

/// The time column of the length of a column, of several the one whose name begins most like its own.
fn stamps_of(table: &Table, column: usize) -> Option<usize> {
    let own = &table.columns[column];
    let is_time = |index: &usize| {
        let other = &table.columns[*index];
        let unit = other.unit.as_ref().and_then(|unit| Unit::parse(unit).ok());
        let named = names::hint(&other.name).is_some_and(|hint| hint.role == Role::Time);
        *index != column
            && other.values.len() == own.values.len()
            && named
            && unit.is_none_or(|unit| unit.dimension() == Dimension::TIME)
    };
    let alike = |index: &usize| {
        let other = table.columns[*index].name.chars();
        other
            .zip(own.name.chars())
            .take_while(|(a, b)| a == b)
            .count()
    };
    let times = (0..table.columns.len()).filter(is_time);
    times.max_by_key(|index| (alike(index), std::cmp::Reverse(*index)))
}

/// Of columns that could be the time, those as long as the motion, where some are and others are not.
pub(super) fn as_long(table: &Table, times: Vec<usize>, motion: usize) -> Vec<usize> {
    let length = |column: usize| table.columns[column].values.len();
    let fits: Vec<usize> = times
        .iter()
        .copied()
        .filter(|time| !differ(length(*time), length(motion)))
        .collect();
    if fits.is_empty() { times } else { fits }
}
