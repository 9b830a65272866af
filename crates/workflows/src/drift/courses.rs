//! The courses of a table: of each parameter of each machine over time.

use crate::error::Error;
use std::collections::{BTreeMap, HashSet};
use std::path::Path;
use stiction_drift::Point;
use stiction_files::batch::{Levels, LogRow, ParameterRow, seconds_in_name, seconds_of_file};
use stiction_policy::drift;

/// Where the times of logs come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Times {
    /// The table.
    #[default]
    Table,
    /// Dates in the names of the logs.
    Names,
    /// When their files were written.
    Files,
}

/// Times beside those of the table, with their names.
pub(super) const OTHERS: [(Times, &str); 2] = [(Times::Names, "names"), (Times::Files, "files")];

impl Times {
    /// Times by the name that they are given by; those of the table where there is none.
    ///
    /// # Errors
    /// Where it is another name.
    pub fn read(name: Option<&str>) -> Result<Self, Error> {
        let Some(name) = name else {
            return Ok(Times::Table);
        };
        let own = OTHERS.iter().find(|(_, own)| *own == name);
        let refused = || Error::usage(format!("times = {name:?}"), "\"names\" or \"files\"");
        own.map(|(times, _)| *times).ok_or_else(refused)
    }

    /// Time of a log, s.
    fn of(self, row: &LogRow) -> Option<f64> {
        match self {
            Times::Table => row.time,
            Times::Names => seconds_in_name(&row.path),
            Times::Files => seconds_of_file(Path::new(&row.path)),
        }
    }
}

/// A parameter of a law, with its unit: what is compared with each other.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Number {
    pub law: String,
    pub name: String,
    pub unit: String,
}

/// A parameter on a machine over time.
#[derive(Clone, Debug, Default)]
pub struct Followed {
    /// Estimates, in the order of time.
    pub points: Vec<Point>,
    /// The log of each, and its axis file.
    pub logs: Vec<(String, Option<String>)>,
    /// When each would be with a log a day in the order of the table, s.
    places: Vec<f64>,
}

/// The courses of a table, by parameter and machine.
#[derive(Default)]
pub(super) struct Courses {
    pub of: BTreeMap<Number, BTreeMap<String, Followed>>,
    /// Logs of each machine.
    pub machines: BTreeMap<String, usize>,
    /// The same with those that failed.
    places: BTreeMap<String, u32>,
    /// Levels of all logs, which may be of several units.
    pub levels: Levels,
    pub logs: usize,
    pub failed: usize,
    /// Logs of which something was identified, and that name no machine.
    pub unnamed: usize,
    /// Where times come from.
    times: Times,
    /// The same that have no time.
    untimed: usize,
    /// First and last time of each of [`OTHERS`], while every log has it.
    others: [Option<(f64, f64)>; OTHERS.len()],
    /// What was taken: key, machine and time of each log. A folder of logs may hold one twice, and one of tables a table.
    seen: HashSet<(String, Option<String>, Option<u64>)>,
}

/// Seconds from a log to the next where times are not known.
const DAY: f64 = 86_400.0;
/// Largest number that is followed, far beyond any machine in any unit.
const LARGEST: f64 = 1e100;
/// Deviations in a 95 % interval.
const WIDTH: f64 = 2.0 * 1.959_963_984_540_054;

impl Courses {
    pub fn new(times: Times) -> Self {
        Self {
            times,
            others: [Some((f64::INFINITY, f64::NEG_INFINITY)); OTHERS.len()],
            ..Self::default()
        }
    }

    /// Takes a log, once.
    ///
    /// # Errors
    /// Where a number of it is larger than any machine has, and would leave nothing of the others; where it has no time of the
    /// kind that was asked for.
    pub fn take(&mut self, row: &LogRow) -> Result<(), Error> {
        let own = (
            row.key.clone(),
            row.machine.clone(),
            row.time.map(f64::to_bits),
        );
        if !row.key.is_empty() && !self.seen.insert(own) {
            return Ok(());
        }
        self.logs += 1;
        let machine = row.machine.clone().unwrap_or_default();
        let count = self.machines.entry(machine.clone()).or_default();
        let place = self.places.entry(machine.clone()).or_default();
        *place += 1;
        let place = DAY * f64::from(*place);
        if row.error.is_some() {
            self.failed += 1;
            return Ok(());
        }
        self.levels.take(row);
        self.unnamed += usize::from(row.machine.is_none());
        *count += 1;
        let time = self.times.of(row);
        self.untimed += usize::from(time.is_none());
        allowed(row, "time", time)?;
        if time.is_none() && self.times != Times::Table {
            let (found, wanted) = match self.times {
                Times::Files => (
                    "there is no such file here",
                    "times in the list of the batch",
                ),
                _ => (
                    "no date in its name",
                    "a date in the name of each log, such as 2026-03-01 or 20260301_0630",
                ),
            };
            return Err(Error::usage(format!("{}: {found}", row.path), wanted));
        }
        for ((other, _), span) in OTHERS.iter().zip(&mut self.others) {
            // A log without one is enough; of a table with times none is asked.
            *span = span
                .take()
                .filter(|_| row.time.is_none())
                .and_then(|(first, last)| {
                    let time = other.of(row)?;
                    Some((time.min(first), time.max(last)))
                });
        }
        allowed(row, "temperature", row.temperature)?;
        let asymmetric = if row.asymmetric == Some(true) {
            " asymmetric"
        } else {
            ""
        };
        let law = format!("{}{asymmetric}", row.law.as_deref().unwrap_or_default());
        for parameter in &row.parameters {
            let Some((value, std)) = known(parameter) else {
                continue;
            };
            allowed(row, &parameter.name, Some(value))?;
            allowed(row, &parameter.name, Some(std))?;
            let number = Number {
                law: law.clone(),
                name: parameter.name.clone(),
                unit: parameter.unit.clone(),
            };
            let followed = self
                .of
                .entry(number)
                .or_default()
                .entry(machine.clone())
                .or_default();
            followed.places.push(place);
            followed.points.push(Point {
                time: time.unwrap_or(place),
                value,
                std,
                temperature: row.temperature,
            });
            followed.logs.push((row.path.clone(), row.axis.clone()));
        }
        Ok(())
    }

    /// Whether there are machines with several logs, and all of each at the same time.
    pub fn stands_still(&self) -> bool {
        let courses = || self.of.values().flat_map(BTreeMap::values);
        let moves = |f: &Followed| f.points.windows(2).any(|two| two[0].time != two[1].time);
        courses().any(|f| f.points.len() > 1) && !courses().any(moves)
    }

    /// Whether every log has its time; else all are taken in the order of the table.
    pub fn is_timed(&self) -> bool {
        self.untimed == 0
    }

    /// Times that every log has, where the table has none.
    pub fn other_times(&self) -> Vec<String> {
        let moves = |span: &Option<(f64, f64)>| {
            span.is_some_and(|(first, last)| last - first > drift::MAX_COPY_SPAN)
        };
        let all = OTHERS.iter().zip(&self.others);
        let of = all.filter(|(_, span)| !self.is_timed() && moves(span));
        of.map(|((_, name), _)| (*name).into()).collect()
    }

    /// Brings the logs of each machine into the order of time.
    pub fn sort(&mut self) {
        let timed = self.is_timed();
        for followed in self
            .of
            .values_mut()
            .flat_map(|machines| machines.values_mut())
        {
            if !timed {
                let points = followed.points.iter_mut().zip(&followed.places);
                points.for_each(|(point, place)| point.time = *place);
                continue;
            }
            let mut order: Vec<usize> = (0..followed.points.len()).collect();
            order.sort_by(|a, b| {
                followed.points[*a]
                    .time
                    .total_cmp(&followed.points[*b].time)
            });
            followed.points = order.iter().map(|i| followed.points[*i]).collect();
            followed.logs = order.iter().map(|i| followed.logs[*i].clone()).collect();
        }
    }
}

/// Refuses a number whose square would be none.
fn allowed(row: &LogRow, what: &str, number: Option<f64>) -> Result<(), Error> {
    match number.filter(|x| x.is_nan() || x.abs() >= LARGEST) {
        None => Ok(()),
        Some(number) => Err(Error::usage(
            format!("{}: {what} is {}", row.path, stiction_number::short(number)),
            format!("numbers below {LARGEST:e} in a table of stiction batch"),
        )),
    }
}

/// Value and standard deviation of a parameter that the log determines.
fn known(parameter: &ParameterRow) -> Option<(f64, f64)> {
    if !parameter.identifiable || parameter.origin != "identified" {
        return None;
    }
    let value = parameter.value.filter(|x| x.is_finite())?;
    let ends = parameter.low.zip(parameter.high);
    let width = ends.map(|(low, high)| (high - low) / WIDTH);
    let std = width.or(parameter.std)?;
    (std.is_finite() && std >= 0.0).then_some((value, std))
}
