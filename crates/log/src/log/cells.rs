//! The columns in SI, and what becomes of their missing cells.

use super::Excluded;
use super::clock::Clock;
use crate::findings::{Finding, count, short};
use crate::mapping::{Role, Source};
use crate::{Error, Kind, Table};
use std::borrow::Cow;
use std::ops::Range;
use stiction_codes::Code;
use stiction_policy::signal;
use stiction_say::{Found, Mended as Done, Useless};

/// The columns of a log in the making, one number a kept row.
pub(super) struct Columns {
    columns: Vec<(Role, Vec<f64>)>,
    beyond: Vec<Beyond>,
}

/// Numbers of a column that are too large to be measurements, infinite ones among them.
struct Beyond {
    role: Role,
    cells: usize,
    /// Data row of the first, counted from 1, and what stands there, with its unit.
    row: usize,
    number: String,
}

/// A channel that is no use, and why.
pub(super) struct LeftOut {
    pub role: Role,
    pub why: Useless,
}

impl LeftOut {
    pub fn new(role: Role, why: Useless) -> Self {
        Self { role, why }
    }

    /// What is said of it.
    pub fn finding(&self) -> Finding {
        Finding::warning(Found::LeftOut(self.why.clone()))
    }
}

/// What was done about missing cells.
pub(super) struct Mended {
    pub bridged: Vec<Excluded>,
    /// Samples whose reference was missing, in order.
    pub without_reference: Vec<Range<usize>>,
    pub findings: Vec<Finding>,
    pub left_out: Vec<LeftOut>,
}

impl Columns {
    /// The kept rows of every column but time, in SI; a missing cell is NaN. Of a table that is ours a column goes as soon as it
    /// is read, but for those whose cells are quoted later.
    pub fn read(table: &mut Cow<'_, Table>, sources: &[(Role, Source)], clock: &Clock) -> Self {
        let (mut columns, mut beyond) = (Vec::new(), Vec::new());
        let done = |role: Role, column: usize, table: &mut Cow<'_, Table>| {
            let quoted = matches!(role, Role::Temperature | Role::Load);
            if let (Cow::Owned(table), false) = (table, quoted) {
                table.columns[column].values = Vec::new();
            }
        };
        for (role, source) in sources.iter().filter(|(role, _)| *role == Role::Time) {
            done(*role, source.column, table);
        }
        for (role, source) in sources.iter().filter(|(role, _)| *role != Role::Time) {
            let values = &table.columns[source.column].values;
            let kept = clock.rows();
            columns.push((*role, kept.map(|row| source.si(values[row])).collect()));
            let large = |row: &usize| !values[*row].is_nan() && source.si(values[*row]).is_nan();
            if let Some(row) = clock.range.clone().find(large) {
                beyond.push(Beyond {
                    role: *role,
                    cells: clock.range.clone().filter(large).count(),
                    row: row + 1,
                    number: format!("{} {}", short(values[row]), source.unit),
                });
            }
            done(*role, source.column, table);
        }
        Self { columns, beyond }
    }

    pub fn get_mut(&mut self, wanted: Role) -> Option<&mut Vec<f64>> {
        self.columns
            .iter_mut()
            .find(|(role, _)| *role == wanted)
            .map(|(_, values)| values)
    }

    /// Adds a column, one number a kept row.
    pub fn add(&mut self, role: Role, values: Vec<f64>) {
        self.columns.push((role, values));
    }

    pub fn take(&mut self, wanted: Role) -> Option<Vec<f64>> {
        self.get_mut(wanted)
            .map(std::mem::take)
            .filter(|values| !values.is_empty())
    }

    /// Keeps the rows that a rule names, with their times.
    pub fn keep(&mut self, time: &mut Vec<f64>, rule: impl Fn(usize) -> bool) {
        let drop: Vec<bool> = (0..time.len()).map(|row| !rule(row)).collect();
        retain(time, &drop);
        for (_, values) in self.columns.iter_mut().filter(|(_, v)| !v.is_empty()) {
            retain(values, &drop);
        }
    }

    /// Bridges short runs of missing cells and drops the rows of long ones, with their times.
    pub fn mend(&mut self, time: &mut Vec<f64>) -> Result<Mended, Error> {
        let rows = time.len();
        let (mut findings, mut left_out) = (Vec::new(), Vec::new());
        let mut drop = vec![false; rows];
        let mut bridged = vec![false; rows];
        let mut unasked = vec![false; rows];
        for (role, values) in &mut self.columns {
            let runs = missing(values);
            let Some(first) = runs.first().cloned() else {
                continue;
            };
            let cells: usize = runs.iter().map(Range::len).sum();
            let core = matches!(
                role,
                Role::Position | Role::Velocity | Role::Force | Role::External
            );
            if core && cells as f64 > signal::MAX_MISSING_SHARE * rows as f64 {
                if let Some(beyond) = self.beyond.iter().find(|b| b.role == *role)
                    && 2 * beyond.cells > cells
                {
                    return Err(beyond.refusal(rows));
                }
                let found = format!("{role}: {cells} of {} missing", count(rows, "cell"));
                let allowed = "at most half may be missing; a column at a slower rate has to be exported at the \
                               rate of the others";
                return Err(Error::new(Kind::Value, found, allowed).in_column(role.name()));
            }
            if cells == rows {
                values.clear();
                let channel = role.name();
                left_out.push(LeftOut::new(*role, Useless::Empty { channel }));
                findings.extend(left_out.last().map(LeftOut::finding));
                continue;
            }
            let slow = matches!(role, Role::Temperature | Role::Load);
            let holes = if slow { holes(time, &runs) } else { 0.0 };
            if holes >= signal::MAX_HOLES {
                values.clear();
                let why = Useless::Holes {
                    channel: role.name(),
                    cells,
                    of: rows,
                    part: holes,
                };
                left_out.push(LeftOut::new(*role, why));
                findings.extend(left_out.last().map(LeftOut::finding));
                continue;
            }
            let (mut short, mut long) = (0, 0);
            for run in runs {
                let inside = run.start > 0 && run.end < rows;
                if core && !(inside && run.len() <= signal::MAX_BRIDGED_SAMPLES) {
                    long += run.len();
                    drop[run].fill(true);
                    continue;
                }
                short += run.len();
                if core {
                    bridged[run.clone()].fill(true);
                }
                if *role == Role::Reference {
                    unasked[run.clone()].fill(true);
                }
                bridge(time, values, run);
            }
            let done = match core {
                true => Done::Excluded {
                    interpolated: short,
                    dropped: long,
                },
                false => Done::Bridged { holes },
            };
            let beyond = self.beyond.iter().find(|b| b.role == *role);
            let found = Found::Missing {
                channel: role.name(),
                cells,
                of: rows,
                first: first.start + 1,
                implausible: beyond.map(|b| (b.cells, b.number.clone(), b.row)),
                done,
            };
            let grave = holes > 0.0
                || core && (long > 0 || cells as f64 > signal::MAX_MISSING_UNWARNED * rows as f64);
            findings.push(Finding::graded(found, grave).at(first.start));
        }
        if drop.contains(&true) {
            retain(&mut bridged, &drop);
            retain(&mut unasked, &drop);
            self.keep(time, |row| !drop[row]);
        }
        let excluded = |samples| Excluded {
            samples,
            code: Code::MissingCells,
        };
        Ok(Mended {
            bridged: runs(&bridged, |b| *b).into_iter().map(excluded).collect(),
            without_reference: runs(&unasked, |b| *b),
            findings,
            left_out,
        })
    }
}

/// The part of the time that a record lasts in which a channel has no number for long, 0 to 1.
fn holes(time: &[f64], missing: &[Range<usize>]) -> f64 {
    let last = time.len() - 1;
    let whole = time[last] - time[0];
    let lasts = |run: &Range<usize>| time[run.end.min(last)] - time[run.start.saturating_sub(1)];
    let long = missing
        .iter()
        .map(lasts)
        .filter(|s| *s > signal::MIN_HOLE * whole);
    // Divided once, so that a hole that is the whole record is one.
    long.sum::<f64>() / whole
}

impl Beyond {
    fn refusal(&self, rows: usize) -> Error {
        let found = format!(
            "{} is {}, and {} of {} are implausibly large",
            self.role,
            self.number,
            self.cells,
            count(rows, "cell")
        );
        let allowed = format!(
            "at most {:e} in SI units; check its unit and scale",
            signal::MAX_MEASURED
        );
        Error::new(Kind::Value, found, allowed)
            .at_data_row(self.row as u64)
            .in_column(self.role.name())
    }
}

fn missing(values: &[f64]) -> Vec<Range<usize>> {
    runs(values, |x| x.is_nan())
}

/// Stretches where a test holds.
pub(super) fn runs<T>(values: &[T], test: impl Fn(&T) -> bool) -> Vec<Range<usize>> {
    let mut at = 0;
    let mut found = Vec::new();
    for run in values.chunk_by(|a, b| test(a) == test(b)) {
        if test(&run[0]) {
            found.push(at..at + run.len());
        }
        at += run.len();
    }
    found
}

/// A straight line in time between the neighbours of a run; held where there is only one.
fn bridge(time: &[f64], values: &mut [f64], run: Range<usize>) {
    let before = run.start.checked_sub(1).map(|i| (time[i], values[i]));
    let after = values.get(run.end).map(|x| (time[run.end], *x));
    for i in run {
        values[i] = match (before, after) {
            (Some((t0, x0)), Some((t1, x1))) => x0 + (x1 - x0) * ((time[i] - t0) / (t1 - t0)),
            (Some((_, x)), None) | (None, Some((_, x))) => x,
            (None, None) => return,
        };
    }
}

fn retain<T>(values: &mut Vec<T>, drop: &[bool]) {
    let mut dropped = drop.iter();
    values.retain(|_| !dropped.next().copied().unwrap_or(false));
}
