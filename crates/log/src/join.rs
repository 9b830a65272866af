//! A column of another file, joined to a recording by time stamps.
//!
//! Rows stay those of the recording, and none of its columns is touched. The other column is a straight line between two of
//! its samples that are next to each other; across a gap and beyond its ends there is no value, and the rows are left out.
//! Where it is sampled at half the rate or less, only rows nearest to its samples are kept, since nothing is known of it in
//! between; temperatures and loads change slowly, and are not thinned so.

mod lag;
mod offset;

use crate::findings::{Finding, count, full, median};
use crate::mapping::{Channel, Mapping, Role, Source, select, time_source, wanted};
use crate::{Column, Error, Kind, Selector, Table};
use stiction_policy::join;
use stiction_say::Found;

/// Part of a step by which a row at an end of the other column may miss it by the rounding of time stamps.
const ROUNDING: f64 = 1e-4;

/// A column of another file.
#[derive(Clone, Debug, PartialEq)]
pub struct Elsewhere {
    /// What it is.
    pub role: Role,
    /// The time column of that file; found as in any recording where `None`.
    pub time: Option<Channel>,
    /// What is added to the time stamps of that file.
    pub offset: Offset,
}

/// How the clock of another file goes with that of the recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Offset {
    /// So many seconds are added to its time stamps.
    Given(f64),
    /// As many as make what the two files share go together.
    Estimated,
}

impl Elsewhere {
    /// Which columns of the other file may be needed for this channel, of which only names and units are known yet: itself and
    /// what may be its time stamps; where the offset is estimated also what may go with the log.
    pub fn wanted(&self, channel: &Channel, heads: &Table) -> Vec<bool> {
        let mut open: Vec<Role> = self
            .time
            .is_none()
            .then_some(Role::Time)
            .into_iter()
            .collect();
        if self.offset == Offset::Estimated {
            open.extend(offset::SHARED);
        }
        let time = self.time.as_ref().map(|time| &time.column);
        let selectors: Vec<_> = time.into_iter().chain([&channel.column]).collect();
        wanted(heads, &selectors, &open)
    }

    /// Which columns of the log may be needed for the offset, beside those that the mapping takes.
    pub fn wanted_of_log(&self, heads: &Table) -> Vec<bool> {
        match self.offset {
            Offset::Given(_) => vec![false; heads.columns.len()],
            Offset::Estimated => wanted(heads, &[], &offset::SHARED),
        }
    }
}

/// A recording with columns of other files.
#[derive(Clone, Debug)]
pub struct Joined {
    /// Its columns with those of the others behind them.
    pub table: Table,
    /// The mapping, with those columns by their numbers.
    pub mapping: Mapping,
    /// How many columns are of the recording itself.
    pub(crate) own: usize,
    /// Rows that not all files have.
    pub(crate) outside: Vec<bool>,
    pub(crate) findings: Vec<Finding>,
    /// Whether the force is of another file, by time stamps as they are.
    pub(crate) force_as_stamped: bool,
}

/// A path without its folders.
fn file_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// Samples of the other column by the clock of the recording.
struct Course {
    time: Vec<f64>,
    values: Vec<f64>,
    step: f64,
}

impl Joined {
    /// A recording to which nothing is joined yet.
    pub fn new(table: Table, mapping: &Mapping) -> Self {
        Self {
            outside: vec![false; table.rows()],
            mapping: mapping.clone(),
            own: table.columns.len(),
            table,
            findings: Vec::new(),
            force_as_stamped: false,
        }
    }

    /// Joins the column that the mapping names for a role, from a table that `name` stands for in messages.
    ///
    /// # Errors
    /// Where one of the two has no time stamps, where they do not increase, where the two share no time, and where the offset is to
    /// be estimated and nothing tells it.
    pub fn join(&mut self, name: &str, other: &Table, from: &Elsewhere) -> Result<(), Error> {
        let role = from.role;
        let Some(channel) = self.mapping.channel(role).cloned() else {
            return Ok(());
        };
        if self.mapping.rate_hz.is_some() {
            let found =
                format!("{role} is joined from {name} by time stamps, and the rate is given");
            let allowed =
                "time stamps in the log too: take rate out, and give time under [columns]";
            return Err(Error::new(Kind::Time, found, allowed).of_setting("rate"));
        }
        let own = time_source(&self.table, self.mapping.time.as_ref())?;
        let stamps = &self.table.columns[own.column].values;
        let origin = stamps.iter().copied().find(|t| own.si(*t).is_finite());
        let origin = own.si(origin.unwrap_or(0.0));
        let time: Vec<f64> = stamps.iter().map(|t| own.si(*t) - origin).collect();
        let in_other = |e: Error| {
            let found = format!("{name}: {}", e.found);
            // The time of that file stands in the table of its column; that under [columns] is of the log.
            let own = format!("in the table of {role} under [columns]: time =");
            let allowed = e.allowed.replace("under [columns]: time =", &own);
            Error::new(e.kind, found, allowed).of_setting(role.key("file"))
        };
        let estimate = match from.offset {
            Offset::Given(_) => None,
            Offset::Estimated => Some(self.estimate(name, other, from)?),
        };
        let offset = match (from.offset, &estimate) {
            (Offset::Given(seconds), _) => seconds,
            (Offset::Estimated, estimate) => estimate.as_ref().map_or(0.0, |e| e.seconds),
        };
        let course = Course::read(other, &channel, from, (origin, offset)).map_err(in_other)?;
        let step = step(&time).unwrap_or(0.0);
        self.refuse_apart(name, &course, &time, (from, offset))?;
        let slow = matches!(role, Role::Temperature | Role::Load);
        if !slow && course.step >= join::MIN_THINNED_RATIO * step {
            self.thin(&course, &time);
        } else {
            self.outside.resize(self.table.rows(), false);
        }
        let stamps = &self.table.columns[own.column].values;
        let time: Vec<f64> = stamps.iter().map(|t| own.si(*t) - origin).collect();
        let values: Vec<f64> = time.iter().map(|t| course.at(*t)).collect();
        self.say(name, &course, &time, &values, step, (from, offset));
        self.findings
            .extend(estimate.map(|estimate| estimate.finding(name, from.role)));
        for (outside, value) in self.outside.iter_mut().zip(&values) {
            *outside |= value.is_nan();
        }
        self.force_as_stamped |= role == Role::Force && from.offset == Offset::Given(0.0);
        let index = select(other, &channel.column, role).map_err(in_other)?;
        let own = other.columns[index].name.clone();
        // Columns of the log keep their names for themselves.
        let is_taken = self.table.columns.iter().any(|column| column.name == own);
        self.table.columns.push(Column {
            name: if is_taken {
                format!("{own} of {}", file_name(name))
            } else {
                own
            },
            unit: other.columns[index].unit.clone(),
            stamps: other.columns[index].stamps,
            values,
        });
        let number = self.table.number(self.table.columns.len() - 1);
        self.mapping.set(
            role,
            Channel {
                column: Selector::Index(number),
                ..channel
            },
        );
        Ok(())
    }

    fn refuse_apart(
        &self,
        name: &str,
        course: &Course,
        time: &[f64],
        (from, offset): (&Elsewhere, f64),
    ) -> Result<(), Error> {
        if time.iter().any(|t| !course.at(*t).is_nan()) {
            return Ok(());
        }
        let ends = |time: &[f64]| {
            let mut known = time.iter().copied().filter(|t| t.is_finite());
            let first = known.next().unwrap_or(0.0);
            (first, known.next_back().unwrap_or(first))
        };
        let ((a, b), (c, d)) = (ends(time), ends(&course.time));
        let found = format!(
            "{name} and this log share no time: it runs from {} to {} s, counted from the first sample of the log, which runs from \
             {} to {} s",
            micro(c),
            micro(d),
            micro(a),
            micro(b)
        );
        let allowed = format!(
            "files of one clock, or what is to be added to the time stamps of the other one, such as offset = \"{} s\", or offset = \"estimate\"",
            micro(a - c + offset)
        );
        Err(Error::new(Kind::Time, found, allowed).of_setting(from.role.key("file")))
    }

    /// Keeps the rows that are nearest to samples of the other column, and the first, from which times count.
    fn thin(&mut self, course: &Course, time: &[f64]) {
        let mut keep = vec![false; time.len()];
        let known: Vec<usize> = (0..time.len()).filter(|i| time[*i].is_finite()).collect();
        for stamp in &course.time {
            let after = known.partition_point(|i| time[*i] < *stamp);
            let around = known[after.saturating_sub(1)..(after + 1).min(known.len())].iter();
            let distance = |i: &usize| (time[*i] - stamp).abs();
            let nearest = around.min_by(|a, b| distance(a).total_cmp(&distance(b)));
            if let Some(row) =
                nearest.filter(|row| distance(row) <= join::MAX_ROW_DISTANCE * course.step)
            {
                keep[*row] = true;
            }
        }
        self.outside.resize(time.len(), false);
        if let Some(first) = keep.first_mut().filter(|kept| !**kept) {
            *first = true;
            self.outside[0] = true;
        }
        let kept: Vec<usize> = (0..keep.len()).filter(|row| keep[*row]).collect();
        self.table.starts = self.table.starts_among(&kept);
        let retain = |values: &mut Vec<f64>| {
            let mut row = 0..;
            values.retain(|_| {
                row.next()
                    .is_some_and(|i| keep.get(i).copied().unwrap_or(false))
            });
        };
        self.table
            .columns
            .iter_mut()
            .for_each(|c| retain(&mut c.values));
        let mut row = keep.iter();
        self.outside.retain(|_| *row.next().unwrap_or(&false));
    }

    fn say(
        &mut self,
        name: &str,
        course: &Course,
        time: &[f64],
        values: &[f64],
        step: f64,
        (from, offset): (&Elsewhere, f64),
    ) {
        let last = time.iter().copied().rfind(|t| t.is_finite()).unwrap_or(0.0);
        let slow = matches!(from.role, Role::Temperature | Role::Load);
        let beyond = |t: &&f64| **t < -course.step || **t > last + course.step;
        self.findings.push(Finding::note(Found::Joined {
            channel: from.role.name(),
            file: name.to_string(),
            offset,
            rates: [1.0 / course.step, 1.0 / step],
            thinned: !slow && course.step >= join::MIN_THINNED_RATIO * step,
            rows: values.len(),
            outside: values.iter().filter(|x| x.is_nan()).count(),
            unused: course.time.iter().filter(beyond).count(),
        }));
    }
}

/// A time to the microsecond, s, with all its digits before that: stamps may count from 1970.
fn micro(seconds: f64) -> String {
    full((1e6 * seconds).round() / 1e6)
}

impl Course {
    /// The column of another file, with its times counted from one of them and an offset added.
    fn read(
        table: &Table,
        channel: &Channel,
        from: &Elsewhere,
        (origin, offset): (f64, f64),
    ) -> Result<Self, Error> {
        let clock: Source = time_source(table, from.time.as_ref())?;
        let column = select(table, &channel.column, from.role)?;
        Self::of(
            table,
            &clock,
            &table.columns[column].values,
            (origin, offset),
        )
    }

    /// Numbers of a table that belong to its time stamps, which are counted from one of them, with an offset added.
    fn of(
        table: &Table,
        clock: &Source,
        own: &[f64],
        (origin, offset): (f64, f64),
    ) -> Result<Self, Error> {
        let stamps = &table.columns[clock.column].values;
        let (mut time, mut values) = (Vec::new(), Vec::new());
        for (row, (stamp, value)) in stamps.iter().zip(own).enumerate() {
            let now = clock.si(*stamp) - origin + offset;
            match time.last() {
                _ if !now.is_finite() => continue,
                Some(before) if now < *before => {
                    let found = format!("time goes back in data row {}", row + 1);
                    return Err(Error::new(Kind::Time, found, "increasing time stamps"));
                }
                // The first of equal stamps counts; a missing cell is a gap.
                Some(before) if now == *before => continue,
                _ if value.is_nan() => continue,
                _ => {
                    time.push(now);
                    values.push(*value);
                }
            }
        }
        match step(&time) {
            Some(step) => Ok(Self { time, values, step }),
            None => {
                let found = format!("{} with a time stamp and a value", count(time.len(), "row"));
                Err(Error::new(Kind::Value, found, "at least two"))
            }
        }
    }

    /// Time of the first sample, s.
    fn first(&self) -> f64 {
        self.time[0]
    }

    /// Time from the first to the last, s.
    fn span(&self) -> f64 {
        self.time[self.time.len() - 1] - self.time[0]
    }

    /// The values at times of one step from the first on, each the mean over its step where that is longer than the own one.
    fn grid(&self, step: f64) -> Vec<f64> {
        let first = self.first();
        let count = (self.span() / step) as usize + 1;
        let mean = |n: usize| {
            let middle = first + step * n as f64;
            let from = self.time.partition_point(|t| *t < middle - 0.5 * step);
            let own = self.time[from..].partition_point(|t| *t < middle + 0.5 * step);
            match own {
                0 | 1 => self.at(middle),
                _ => self.values[from..from + own].iter().sum::<f64>() / own as f64,
            }
        };
        match step > join::MIN_GAP * self.step {
            true => (0..count).map(mean).collect(),
            false => (0..count)
                .map(|n| self.at(first + step * n as f64))
                .collect(),
        }
    }

    /// The value at a time; NaN in a gap and beyond the ends.
    fn at(&self, t: f64) -> f64 {
        if !t.is_finite() {
            return f64::NAN;
        }
        let after = self.time.partition_point(|x| *x <= t);
        let (Some(i), Some(next)) = (after.checked_sub(1), self.time.get(after)) else {
            let end = if after == 0 { 0 } else { self.time.len() - 1 };
            let near = (self.time[end] - t).abs() <= ROUNDING * self.step;
            return if near { self.values[end] } else { f64::NAN };
        };
        let (from, span) = (self.time[i], next - self.time[i]);
        if span > join::MIN_GAP * self.step {
            return match t == from {
                true => self.values[i],
                false => f64::NAN,
            };
        }
        self.values[i] + (self.values[after] - self.values[i]) * ((t - from) / span)
    }
}

/// Median step of increasing times, s.
fn step(time: &[f64]) -> Option<f64> {
    let steps = time.windows(2).map(|w| w[1] - w[0]);
    let mut steps: Vec<f64> = steps.filter(|d| d.is_finite() && *d > 0.0).collect();
    median(&mut steps)
}
