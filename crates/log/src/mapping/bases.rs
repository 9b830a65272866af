//! Columns that have other time stamps than the rest, as a robot's state and its efforts in one file.
//!
//! They are of another length, or, in a text whose rows hold what has nothing to do with each other, stand behind a time column
//! that runs at another rate.

use super::channel::{Role, Selector};
use super::select::select;
use super::{Mapping, describe, endings};
use crate::{Dimension, Table};
use stiction_policy::clock;

/// A column with other time stamps than the rows of a log.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnStamps {
    /// What it is.
    pub role: Role,
    /// Its place in the table.
    pub(crate) column: usize,
    /// That of its time stamps.
    stamps: usize,
    /// Its time stamps.
    pub time: Selector,
    /// The line of the axis file that says so: `force = { column = "effort.tau", time = "effort.t" }`.
    pub line: String,
}

impl OwnStamps {
    /// Its time stamps as the place of an error.
    pub(crate) fn place(&self, table: &Table) -> String {
        describe::column(table, self.stamps)
    }
}

impl Mapping {
    /// Columns of this mapping that are of another length than its time column, each with a time column of its own length, and
    /// those that stand behind a time column with other stamps.
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
        // Where nothing stands behind the time of the log itself, the other stamps say nothing of what belongs to it.
        let behind =
            |role: &Role| place(*role).is_some_and(|c| stamps_before(table, c) == Some(time));
        let told_by_place = others.clone().any(|role| behind(&role));
        let of = |role: Role| {
            let column = place(role)?;
            let stamps = match differ(length(column), length(time)) {
                true => stamps_of(table, column)?,
                false => stamps_before(table, column)
                    .filter(|own| told_by_place && *own != time && run_apart(table, *own, time))?,
            };
            let name = &table.columns[stamps].name;
            let unique = table.columns.iter().filter(|c| c.name == *name).count() == 1;
            let time = match unique && name.trim() == name && !name.is_empty() {
                true => Selector::Name(name.clone()),
                false => Selector::Index(table.number(stamps)),
            };
            let rest = describe::line(table, stamps, Role::Time);
            Some(OwnStamps {
                column,
                stamps,
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
    lost > 2 && lost as f64 > clock::MAX_CUT_SHARE * a.max(b) as f64
}

/// The time column of the length of a column, of several the one whose name begins most like its own; of those that are alike in
/// that, the last one before it, else the first.
fn stamps_of(table: &Table, column: usize) -> Option<usize> {
    let own = &table.columns[column];
    let is_time = |index: &usize| {
        *index != column
            && table.columns[*index].values.len() == own.values.len()
            && is_time(table, *index)
    };
    let alike = |index: &usize| {
        let other = table.columns[*index].name.chars();
        other
            .zip(own.name.chars())
            .take_while(|(a, b)| a == b)
            .count()
    };
    let times = (0..table.columns.len()).filter(is_time);
    let near = |index: usize| match index < column {
        true => (true, index),
        false => (false, table.columns.len() - index),
    };
    times.max_by_key(|index| (alike(index), near(*index)))
}

/// Whether a column is time by its name, in a unit of time or none.
pub(super) fn is_time(table: &Table, index: usize) -> bool {
    endings::hint(table, index).is_some_and(|hint| hint.role == Role::Time)
        && endings::unit_of(table, index).is_none_or(|unit| unit.dimension() == Dimension::TIME)
}

/// The last time column before a column: tables of several clocks are written as time, values, time, values.
fn stamps_before(table: &Table, column: usize) -> Option<usize> {
    (0..column).rev().find(|index| is_time(table, *index))
}

/// Whether two time columns of one length are stamps of different samples: one ends earlier, or they run at different rates.
/// Two clocks that stamp the same rows differ by an offset and little more.
fn run_apart(table: &Table, own: usize, other: usize) -> bool {
    let factors =
        [own, other].map(|index| endings::unit_of(table, index).map(|unit| unit.factor()));
    let (own, other) = (&table.columns[own], &table.columns[other]);
    let increases = |values: &[f64]| {
        let mut known = values.iter().filter(|t| t.is_finite());
        let first = known.next();
        let ends = first.zip(values.iter().rfind(|t| t.is_finite()));
        known.is_sorted() && ends.is_some_and(|(first, last)| last > first)
    };
    if own.values.len() != other.values.len()
        || !increases(&own.values)
        || !increases(&other.values)
    {
        return false;
    }
    let known = |values: &[f64]| values.iter().filter(|t| t.is_finite()).count();
    if differ(known(&own.values), known(&other.values)) {
        return true;
    }
    let (a, b) = match factors {
        [None, None] => (1.0, 1.0),
        [Some(a), Some(b)] => (a, b),
        _ => return false,
    };
    let pairs = own.values.iter().zip(&other.values);
    let rows: Vec<(f64, f64)> = pairs
        .map(|(x, y)| (a * x, b * y))
        .filter(|(x, y)| x.is_finite() && y.is_finite())
        .collect();
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
        return false;
    };
    let (own, other) = (last.0 - first.0, last.1 - first.1);
    (own - other).abs() > clock::MAX_BASE_DRIFT * own.max(other)
}

/// Of columns that could be the time, those as long as the motion, where some are and others are not; of several that are stamps
/// of different samples, the one that the motion stands behind.
pub(super) fn as_long(table: &Table, times: Vec<usize>, motion: usize) -> Vec<usize> {
    let length = |column: usize| table.columns[column].values.len();
    let fits: Vec<usize> = times
        .iter()
        .copied()
        .filter(|time| !differ(length(*time), length(motion)))
        .collect();
    let fits = if fits.is_empty() { times } else { fits };
    let own = stamps_before(table, motion).filter(|own| fits.contains(own));
    match own {
        Some(own) if fits.iter().all(|t| *t == own || run_apart(table, *t, own)) => vec![own],
        _ => fits,
    }
}
