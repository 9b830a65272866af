//! A rate that is given, beside the time stamps that a table has: the rate counts the rows, and the stamps say whether it can.

use super::channel::Role;
use super::describe;
use crate::findings::{Finding, median, short};
use crate::log::coarse::Coarse;
use crate::{Error, Kind, Table, Unit};
use std::ops::Range;
use stiction_policy::clock;
use stiction_say::Found;

/// Units that time stamps without one may be in, the likeliest first.
const UNITS: [&str; 4] = ["s", "ms", "us", "ns"];

/// What there is to say of a given rate (Hz) and the seconds that it crops, where the time stamps of `column`, in a unit if one is written, or the sample time
/// of the file contradict it.
///
/// # Errors
/// Where stamps in a written unit contradict it: one of the two is wrong.
pub(super) fn compare(
    table: &Table,
    column: Option<(usize, Option<&Unit>)>,
    (rate, crop): (f64, Option<(f64, f64)>),
) -> Result<Option<Finding>, Error> {
    match column {
        Some((column, Some(unit))) => match Rounded::of(table, column, unit, (rate, crop)) {
            Some(rounded) if rounded.agrees(rate) => Ok(rounded.missing(table, column, rate)),
            Some(rounded) => Err(other(table, column, rate, rounded.clock.rate_hz)),
            None => match Steps::of(table, column) {
                Some(steps) if !steps.agree(rate, unit) => {
                    let stamped = 1.0 / (unit.factor() * steps.usual);
                    Err(other(table, column, rate, stamped))
                }
                _ => Ok(None),
            },
        },
        Some((column, None)) => Ok(without_unit(table, column, rate)),
        None => Ok(stated(table, rate)),
    }
}

/// Rows on either side of a step from which the place of the stamps beside it is taken: single ones jitter.
const BESIDE: usize = 5;

/// What there is to say where rows are missing between the stamps of a column, as they show beside a rate (Hz) that
/// agrees with them otherwise: a rate does not count these, and the stamps are read. `None` where none is missing, and of a clock that is
/// too coarse to be read.
pub(super) fn missing_rows(
    table: &Table,
    (column, unit): (usize, Option<&Unit>),
    (rate, crop): (f64, Option<(f64, f64)>),
) -> Option<Finding> {
    // Of stamps without a unit only seconds are what is assumed when they are read.
    let seconds = Unit::parse(UNITS[0]).ok()?;
    let unit = unit.unwrap_or(&seconds);
    let steps = Steps::of(table, column).filter(|steps| steps.agree(rate, unit))?;
    if Rounded::of(table, column, unit, (rate, crop)).is_some() {
        return None;
    }
    let stamps = &table.columns[column].values;
    // Stamps that are late go on where they were; where rows are missing there are fewer than the time has at that rate.
    let span = unit.factor() * (stamps.last()? - stamps.first()?) * rate;
    let fewer = span - (stamps.len() - 1) as f64;
    if fewer.is_nan() || fewer < clock::MIN_LOST_ROW {
        return None;
    }
    let off = |row: usize| stamps[row] / steps.usual - row as f64;
    // A stretch on which single stamps jitter stands where its middle one does.
    let place = |rows: Range<usize>| {
        let mut all: Vec<f64> = rows.map(off).filter(|off| off.is_finite()).collect();
        median(&mut all)
    };
    let jump = |row: &usize| {
        if row + BESIDE > stamps.len() {
            return false;
        }
        let before = place(row.saturating_sub(BESIDE)..*row);
        let after = place(*row..row + BESIDE);
        before
            .zip(after)
            .is_some_and(|(before, after)| after - before > clock::MIN_LOST_ROW)
    };
    let is_long = |row: &usize| off(*row) - off(*row - 1) > clock::MIN_LOST_ROW;
    let jumps: Vec<usize> = (1..stamps.len()).filter(is_long).filter(jump).collect();
    let first = *jumps.first()?;
    // Each would be a row or more.
    if fewer < clock::MIN_LOST_ROW * jumps.len() as f64 {
        return None;
    }
    Some(Finding::warning(Found::RateSkipsRows {
        column: describe::column(table, column),
        seconds: unit.factor() * (stamps[first] - stamps[0]),
        rate,
    }))
}

/// The line of the axis file that makes a column the time, where its numbers run on as time stamps do in some unit.
pub(super) fn time_line(table: &Table, column: usize) -> Option<String> {
    let values = &table.columns[column].values;
    let steps = Steps::of(table, column).filter(|_| values.is_sorted())?;
    if are_ticks(values) {
        return Some(describe::line_with(table, column, Role::Time, TICKS));
    }
    let fits = |unit: &Unit| clock::PLAUSIBLE_SPACING.contains(&(unit.factor() * steps.usual));
    let mut units = UNITS.iter().filter_map(|unit| Unit::parse(unit).ok());
    let unit = units.find(fits).filter(|_| steps.usual != 1.0)?;
    let named = format!("unit = \"{unit}\"");
    Some(describe::line_with(table, column, Role::Time, &named))
}

/// What makes seconds of ticks, in a line of the axis file.
pub(super) const TICKS: &str = "scale = \"100 ns/count\"";

/// Whether these are counts of 100 ns since 1601 or since the year 1, of 1970 to 2100: no other stamps are so large.
pub(super) fn are_ticks(values: &[f64]) -> bool {
    const SINCE_1601: std::ops::Range<f64> = 1.164e17..1.575e17;
    const SINCE_1: std::ops::Range<f64> = 6.213e17..6.624e17;
    let first = values.iter().find(|value| !value.is_nan());
    first.is_some_and(|first| SINCE_1601.contains(first) || SINCE_1.contains(first))
}

/// Steps of time stamps, in their own unit.
struct Steps {
    /// The median of those that go forward; where a clock that is coarser than the sampling repeats its stamps, the mean.
    usual: f64,
    /// From the first row to the last.
    mean: f64,
}

impl Steps {
    fn of(table: &Table, column: usize) -> Option<Self> {
        let rows = table.columns[column].values.iter().copied().enumerate();
        let stamps: Vec<(usize, f64)> = rows.filter(|(_, t)| t.is_finite()).collect();
        let (first, last) = (stamps.first()?, stamps.last()?);
        let steps: Vec<f64> = stamps.windows(2).map(|w| w[1].1 - w[0].1).collect();
        let mean = (last.1 - first.1) / (last.0 - first.0).max(1) as f64;
        let repeated = steps.iter().filter(|step| **step == 0.0).count();
        let mut forward: Vec<f64> = steps.iter().copied().filter(|step| *step > 0.0).collect();
        let usual = median(&mut forward)?;
        Some(Self {
            usual: match repeated as f64 > clock::MIN_REPEATED_SHARE * steps.len() as f64 {
                true => mean,
                false => usual,
            },
            mean,
        })
    }

    /// Whether a rate is theirs. The mean step counts as much as the median, from which rows that are missing keep it apart.
    fn agree(&self, rate: f64, unit: &Unit) -> bool {
        let agrees = |step: f64| (rate * unit.factor() * step - 1.0).abs() <= clock::MAX_RATE_ERROR;
        agrees(self.mean) || agrees(self.usual)
    }
}

/// Stamps that a coarse clock has rounded.
struct Rounded {
    clock: Coarse,
    /// The first of the rows that are kept.
    first: usize,
    /// Where rows are missing among them, the longest stretch without, counted from the first.
    stretch: Option<Range<usize>>,
}

impl Rounded {
    fn of(
        table: &Table,
        column: usize,
        unit: &Unit,
        (rate, crop): (f64, Option<(f64, f64)>),
    ) -> Option<Self> {
        let stamps = &table.columns[column].values;
        let row = |seconds: f64| ((seconds * rate) as usize).min(stamps.len());
        let kept = crop.map_or(0..stamps.len(), |(from, to)| row(from)..row(to));
        let first = kept.start;
        let time: Vec<f64> = stamps[kept].iter().map(|t| unit.factor() * t).collect();
        let whole = Coarse::of(&time).map(|clock| (clock, None));
        let part = || Coarse::of_a_part(&time).map(|(clock, rows)| (clock, Some(rows)));
        let (clock, stretch) = whole.or_else(part)?;
        Some(Self {
            clock,
            first,
            stretch,
        })
    }

    fn agrees(&self, rate: f64) -> bool {
        (rate / self.clock.rate_hz - 1.0).abs() <= clock::MAX_RATE_ERROR
    }

    /// What there is to say of rows that are missing, which a rate does not count.
    fn missing(&self, table: &Table, column: usize, rate: f64) -> Option<Finding> {
        let rows = self.stretch.as_ref()?;
        let at = |row: usize| (self.first + row) as f64 / rate;
        Some(Finding::warning(Found::RateSkipsGaps {
            column: describe::column(table, column),
            rate,
            crop: [at(rows.start), at(rows.end - 1)],
        }))
    }
}

fn other(table: &Table, column: usize, rate: f64, stamped: f64) -> Error {
    let found = format!(
        "rate is {} Hz, but the time stamps run at {} Hz",
        short(rate),
        short(stamped)
    );
    let allowed = "rate is for logs without time; take it out of axis.toml, or correct it";
    let place = describe::place(table, column);
    let error = Error::new(Kind::Ambiguous, found, allowed);
    error.in_column(place).of_setting("rate")
}

/// Stamps whose unit is not known contradict a rate where they are too fast or too slow for it in every unit.
fn without_unit(table: &Table, column: usize, rate: f64) -> Option<Finding> {
    let steps = Steps::of(table, column)?;
    let units = || UNITS.iter().filter_map(|unit| Unit::parse(unit).ok());
    let numbers_rows = steps.usual == 1.0;
    if numbers_rows || units().any(|unit| steps.agree(rate, &unit)) {
        return None;
    }
    let seconds = |unit: &Unit| unit.factor() * steps.usual;
    let unit = units().find(|unit| clock::PLAUSIBLE_SPACING.contains(&seconds(unit)))?;
    let named = format!("unit = \"{unit}\"");
    Some(Finding::warning(Found::StampsUnread {
        column: describe::column(table, column),
        rate,
        unit: unit.to_string(),
        stamped: 1.0 / seconds(&unit),
        line: describe::line_with(table, column, Role::Time, &named),
    }))
}

/// A file without time stamps may state its sample time.
fn stated(table: &Table, rate: f64) -> Option<Finding> {
    let step = table.sample_time.filter(|step| *step > 0.0)?;
    if (rate * step - 1.0).abs() <= clock::MAX_RATE_ERROR {
        return None;
    }
    Some(Finding::warning(Found::RateDiffers { rate, step }))
}
