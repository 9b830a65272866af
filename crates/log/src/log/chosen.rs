//! Rows that the axis file leaves out: by a column that says in which rows the axis is enabled or in which mode it is, and by
//! parts of the record that are fitted or validated.
//!
//! They go as if they had not been recorded. The record is split where they were, however few they are: what drove the axis
//! while it was not enabled is not in the force.

use super::cells::{Columns, runs};
use super::clock::Clock;
use crate::findings::{Finding, count, short};
use crate::mapping::{Enable, Mapping, Parts, enable, parts};
use crate::{Error, Kind, Table};
use stiction_number::full;
use stiction_say::Found;

/// Most different numbers of a column that are named.
const MOST_NAMED: usize = 6;

/// Rows that a column leaves out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotEnabled {
    /// The column: `7 "Enabled"`.
    pub column: String,
    /// Rows that are left out.
    pub rows: usize,
    /// Of so many.
    pub of: usize,
}

/// Which rows of a log in the making are chosen.
pub(super) struct Chosen {
    /// One entry a kept row; nothing where all are chosen.
    rows: Option<Vec<Row>>,
    left_out: Option<NotEnabled>,
    /// The number that chooses a row.
    kept: f64,
    /// The same in words.
    words: String,
    /// Stretches that are not enabled, and the times of the first one.
    stretches: usize,
    first: Option<(f64, f64)>,
}

/// What becomes of a row.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Row {
    Kept,
    /// In a part of the record that is kept, but not enabled.
    NotEnabled,
    /// In another part of the record.
    Elsewhere,
}

impl Chosen {
    /// The rows that are chosen of those that the clock keeps.
    /// `outside` are rows of the table that another file does not have.
    pub fn read(
        table: &Table,
        mapping: &Mapping,
        clock: &Clock,
        outside: &[bool],
    ) -> Result<Self, Error> {
        let mut out = Self {
            rows: None,
            left_out: None,
            kept: mapping.enable.as_ref().map_or(1.0, Enable::kept),
            words: mapping
                .enable
                .as_ref()
                .map_or_else(String::new, Enable::kept_words),
            stretches: 0,
            first: None,
        };
        if let Some(parts) = &mapping.parts {
            refuse_empty(parts, clock)?;
            let in_part = |t: &f64| match parts.keep(clock.since_first + t) {
                true => Row::Kept,
                false => Row::Elsewhere,
            };
            out.rows = Some(clock.time.iter().map(in_part).collect());
        }
        if outside.contains(&true) {
            let mut rows = out
                .rows
                .take()
                .unwrap_or_else(|| vec![Row::Kept; clock.time.len()]);
            for (row, at) in rows.iter_mut().zip(kept_rows(clock)) {
                if outside.get(at).copied().unwrap_or(false) {
                    *row = Row::Elsewhere;
                }
            }
            out.rows = Some(rows);
        }
        if let Some((enable, column)) = mapping.enable.as_ref().zip(Enable::of(mapping, table)?) {
            out.enable(table, enable, column, clock)?;
        }
        Ok(out)
    }

    /// Takes out the rows that are not enabled.
    fn enable(
        &mut self,
        table: &Table,
        enable: &Enable,
        column: usize,
        clock: &Clock,
    ) -> Result<(), Error> {
        let values = &table.columns[column].values;
        if values.len() < clock.range.end {
            let found = format!(
                "enable, column {}, has {}, and the record goes to data row {}",
                enable::place(table, column),
                count(values.len(), "sample"),
                clock.range.end
            );
            let allowed = "a column at the rate of the others; export them with one sample time";
            return Err(Error::new(Kind::Value, found, allowed).of_setting(enable::KEY));
        }
        let values = kept_rows(clock).map(|row| values[row]);
        let mut rows = self
            .rows
            .take()
            .unwrap_or_else(|| vec![Row::Kept; clock.time.len()]);
        let mut there = Vec::new();
        for (row, value) in rows.iter_mut().zip(values) {
            if *row == Row::Kept {
                let value = enable.counted(value);
                there.push(value);
                if value != self.kept {
                    *row = Row::NotEnabled;
                }
            }
        }
        refuse(table, column, enable, &there)?;
        self.rows = Some(rows);
        self.left_out = Some(NotEnabled {
            column: enable::place(table, column),
            rows: 0,
            of: 0,
        });
        Ok(())
    }

    /// Keeps the rows that a rule names.
    pub fn keep(&mut self, rule: impl Fn(usize) -> bool) {
        if let Some(rows) = &mut self.rows {
            let mut at = 0..rows.len();
            rows.retain(|_| at.next().is_some_and(&rule));
        }
    }

    /// Whether any row is left out.
    pub fn leaves_out(&self) -> bool {
        let rows = self.rows.as_ref();
        rows.is_some_and(|rows| rows.iter().any(|row| *row != Row::Kept))
    }

    /// Leaves the other rows out; when the record goes on after each stretch of them.
    pub fn cut(&mut self, time: &mut Vec<f64>, columns: &mut Columns) -> Vec<f64> {
        let Some(rows) = self.rows.take() else {
            return Vec::new();
        };
        let not_enabled = runs(&rows, |row| *row == Row::NotEnabled);
        if let Some(left_out) = &mut self.left_out {
            left_out.rows = not_enabled.iter().map(|run| run.len()).sum();
            left_out.of = rows.iter().filter(|row| **row != Row::Elsewhere).count();
        }
        self.stretches = not_enabled.len();
        let first = not_enabled.first();
        self.first = first.map(|run| (time[run.start], time[run.end - 1]));
        let gone = runs(&rows, |row| *row != Row::Kept);
        let resumed = gone.iter().filter_map(|run| time.get(run.end).copied());
        let resumed = resumed.collect();
        columns.keep(time, |row| rows[row] == Row::Kept);
        resumed
    }

    /// What was left out; times are those of the kept part.
    pub fn finding(&self) -> Option<Finding> {
        let (left_out, (from, to)) = self.left_out.as_ref().zip(self.first)?;
        Some(Finding::note(Found::NotEnabled {
            column: left_out.column.clone(),
            enabled: self.words.clone(),
            rows: left_out.rows,
            of: left_out.of,
            places: self.stretches,
            seconds: [from, to],
        }))
    }

    /// How many rows the column leaves out.
    pub fn not_enabled(self) -> Option<NotEnabled> {
        self.left_out
    }
}

/// The rows of the table that the clock keeps.
fn kept_rows(clock: &Clock) -> impl Iterator<Item = usize> {
    let mut dropped = clock.dropped.iter().peekable();
    let kept = clock.range.clone();
    kept.filter(move |row| dropped.next_if_eq(&row).is_none())
}

/// When each other recording of a table begins, by the first of its rows that is kept.
pub(super) fn started(table: &Table, clock: &Clock) -> Vec<f64> {
    if table.starts.is_empty() {
        return Vec::new();
    }
    let kept: Vec<usize> = kept_rows(clock).collect();
    let starts = table.starts_among(&kept).into_iter();
    starts.map(|at| clock.time[at]).collect()
}

/// Refuses a stretch without a sample.
fn refuse_empty(parts: &Parts, clock: &Clock) -> Result<(), Error> {
    let at = |t: &f64| clock.since_first + t;
    let empty = |stretch: &&(f64, f64)| !clock.time.iter().any(|t| parts::holds(**stretch, at(t)));
    let Some((from, to)) = parts.stretches().iter().find(empty) else {
        return Ok(());
    };
    let found = format!("{} to {} s holds no sample", full(*from), full(*to));
    let last = clock.time.last().map_or(0.0, at);
    let allowed = format!(
        "what is kept of the record runs from {} to {} s, counted from the first sample of the file",
        short(clock.since_first),
        short(last)
    );
    Err(Error::new(Kind::Value, found, allowed).of_setting(parts::KEY))
}

/// Refuses a column of so many numbers that it is neither a flag nor one of modes, where no number is given.
pub(super) fn refuse_many(table: &Table, column: usize, enable: &Enable) -> Result<(), Error> {
    let values = &table.columns[column].values;
    let is_flag = enable.equals.is_none() && enable.mask.is_none();
    match is_flag && different(values).len() > MOST_NAMED {
        true => refuse(table, column, enable, values),
        false => Ok(()),
    }
}

/// Refuses a column that keeps no row, or that is no flag where no number is given.
fn refuse(table: &Table, column: usize, enable: &Enable, values: &[f64]) -> Result<(), Error> {
    let there = different(values);
    let shown = |x: &f64| match enable.mask {
        None => short(*x),
        Some(_) => enable.shown(*x),
    };
    let named: Vec<String> = there.iter().take(MOST_NAMED).map(shown).collect();
    let many = there.len() > MOST_NAMED;
    let more = if many { ", ..." } else { "" };
    let holds = match named.as_slice() {
        [] => "no number".to_string(),
        named => format!("{}{more}", named.join(", ")),
    };
    let place = enable::place(table, column);
    // A column of many numbers is probably none of modes.
    let mode = there.iter().find(|x| **x != 0.0).or(there.first());
    let mode = mode.filter(|_| !many).map_or("8".into(), |x| full(*x));
    let line = Enable::line(table, column, &mode);
    if enable.mask.is_some() && !values.contains(&enable.kept()) {
        let found = format!(
            "enable, column {place}, is {} in no row; there it is {holds}",
            enable.kept_words()
        );
        let allowed =
            "a number that it holds under the mask, which is then equals, or another mask";
        return Err(Error::new(Kind::Value, found, allowed).of_setting(enable::KEY));
    }
    let is_flag = there.iter().all(|x| *x == 0.0 || *x == 1.0);
    let (found, allowed) = if enable.equals.is_none() && enable.mask.is_none() && !is_flag {
        let found = format!("enable, column {place}, holds {holds}");
        let are_whole = there.iter().all(|x| x.fract() == 0.0);
        let allowed = match many && !are_whole {
            true => "0 and 1 alone, or a column of modes, of which one is kept with equals; a column of so many fractions is neither"
                .into(),
            false => {
                format!("0 and 1 alone; of a column of modes say which one is kept, as in: {line}")
            }
        };
        (found, allowed)
    } else if !values.contains(&enable.kept()) {
        let kept = full(enable.kept());
        let found = format!("enable, column {place}, is {kept} in no row; it holds {holds}");
        let allowed = match there.is_empty() {
            true => "a column of numbers".to_string(),
            false => format!("a number that it holds, as in: {line}"),
        };
        (found, allowed)
    } else {
        return Ok(());
    };
    Err(Error::new(Kind::Value, found, allowed).of_setting(enable::KEY))
}

/// The different numbers of a column in the order of their size, or the first that are more than can be named.
fn different(values: &[f64]) -> Vec<f64> {
    let mut out: Vec<f64> = Vec::new();
    for x in values.iter().filter(|x| !x.is_nan()) {
        if let Err(at) = out.binary_search_by(|y| y.total_cmp(x)) {
            out.insert(at, *x);
            if out.len() > MOST_NAMED {
                break;
            }
        }
    }
    out
}
