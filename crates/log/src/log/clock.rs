//! Time stamps to seconds: overflow, order, crop, duplicates.

use super::coarse::Coarse;
use crate::findings::{Finding, count, full, median, short};
use crate::mapping::{Mapping, Role, Source};
use crate::{Error, Kind, Table};
use std::ops::Range;
use stiction_policy::{clock, signal};
use stiction_say::Found;

/// Tolerance of the ends of a crop, relative to them, so that decimal limits keep the samples that they name.
const CROP_ROUNDING: f64 = 1e-9;
/// Times that the stamps of recordings behind each other in one file go back; of more the rows are in no order.
const MOST_BREAKS: usize = 10;
/// Counts at which time counters overflow: 16 bits, 31 bits (signed), 32 bits.
const COUNTER_SIZES: [f64; 3] = [65_536.0, 2_147_483_648.0, 4_294_967_296.0];

/// The rows that are kept and when they were taken.
pub(super) struct Clock {
    /// Seconds from the first kept row.
    pub time: Vec<f64>,
    /// Seconds of the first kept row on the clock of the file.
    pub start: f64,
    /// Seconds from the first row of the file to the first kept one.
    pub since_first: f64,
    /// Rows of the table that the crop keeps.
    pub range: Range<usize>,
    /// Rows within `range` that are dropped, in order.
    pub dropped: Vec<usize>,
}

impl Clock {
    /// The kept rows of the table, in order.
    pub fn rows(&self) -> impl Iterator<Item = usize> {
        let mut dropped = self.dropped.iter().peekable();
        let rows = self.range.clone();
        rows.filter(move |row| dropped.next_if_eq(&row).is_none())
    }

    /// The row of the table that a kept row is, both counted from 0.
    pub fn row(&self, kept: usize) -> usize {
        let before = |row: usize| self.dropped.iter().filter(move |d| **d <= row).count();
        let mut row = self.range.start + kept;
        // Each row that is dropped before it moves it on by one.
        loop {
            let moved = self.range.start + kept + before(row);
            if moved == row {
                return row;
            }
            row = moved;
        }
    }
}

pub(super) fn read(
    table: &Table,
    sources: &[(Role, Source)],
    mapping: &Mapping,
    length: usize,
    findings: &mut Vec<Finding>,
) -> Result<Clock, Error> {
    match (
        sources.iter().find(|(role, _)| *role == Role::Time),
        mapping.rate_hz,
    ) {
        (Some((_, source)), _) => {
            let raw = &table.columns[source.column].values[..length];
            stamped(raw, source, mapping, findings).map_err(|e| match e.kind {
                Kind::Time => e.in_column("time"),
                _ => e,
            })
        }
        (None, rate) => counted(rate.unwrap_or(1.0), mapping, length),
    }
}

/// Rows at a stated rate.
fn counted(rate: f64, mapping: &Mapping, length: usize) -> Result<Clock, Error> {
    let at = |row: usize| row as f64 / rate;
    let range = crop(length, mapping, at)?;
    let time = (0..range.len()).map(at).collect();
    Ok(Clock {
        time,
        start: at(range.start),
        since_first: at(range.start),
        range,
        dropped: Vec::new(),
    })
}

/// Rows with time stamps.
fn stamped(
    raw: &[f64],
    source: &Source,
    mapping: &Mapping,
    findings: &mut Vec<Finding>,
) -> Result<Clock, Error> {
    let Some(origin) = raw.iter().copied().find(is_stamp) else {
        return Err(Error::new(
            Kind::Time,
            "no row has a time stamp",
            "give the rate instead",
        ));
    };
    let (lifts, broken) = overflows(raw);
    let lift = |row: usize| match lifts.partition_point(|(from, _)| *from <= row) {
        0 => 0.0,
        n => lifts[n - 1].1,
    };
    let since = |row: usize, from: f64| source.si_difference((raw[row] - from) + lift(row));
    let range = crop(raw.len(), mapping, |row| since(row, origin))?;
    if let Some(row) = broken
        .iter()
        .copied()
        .find(|row| range.contains(row) && *row > range.start)
    {
        let often = broken.len() > MOST_BREAKS;
        let mut before = (range.start..row).rev();
        let end = before
            .find(|r| is_stamp(&raw[*r]))
            .map(|row| since(row, origin));
        return Err(backward(raw, row, end.filter(|_| !often)));
    }
    let mut time = Vec::with_capacity(range.len());
    let mut dropped = Vec::new();
    let (mut stampless, mut repeated) = (Vec::new(), Vec::new());
    let mut base: Option<(f64, f64)> = None;
    let mut before = f64::NEG_INFINITY;
    let coarse = || {
        let all: Vec<f64> = range.clone().map(|row| since(row, origin)).collect();
        Coarse::of(&all)
    };
    for row in range.clone() {
        if !is_stamp(&raw[row]) {
            stampless.push(row);
            dropped.push(row);
            continue;
        }
        let (first, first_lift) = *base.get_or_insert((raw[row], lift(row)));
        let now = source.si_difference((raw[row] - first) + (lift(row) - first_lift));
        if now <= before {
            repeated.push(row);
            dropped.push(row);
        } else {
            time.push(now);
            before = now;
        }
    }
    if let Some((at, [from, to])) = two_units(&time) {
        let found = format!(
            "time steps of {} s at the beginning and of {} s at the end, from here on: as far apart as two units",
            short(from),
            short(to)
        );
        let allowed = "time stamps in one unit; or, under [log], crop = [\"FROM s\", \"TO s\"] around the rows in one of them";
        // Those that were dropped are in order.
        let mut kept = range
            .clone()
            .filter(|row| dropped.binary_search(row).is_err());
        let row = kept.nth(at).unwrap_or(range.start);
        return Err(Error::new(Kind::Time, found, allowed).at_data_row(row as u64 + 1));
    }
    let share = |rows: &[usize]| rows.len() as f64 / range.len() as f64;
    if let Some(&first) = stampless.first() {
        let found = format!("{} without a time stamp", count(stampless.len(), "row"));
        if share(&stampless) > clock::MAX_DROPPED_SHARE {
            let allowed = "at most 5 % of the rows; give the rate instead of the time column";
            return Err(Error::new(Kind::Time, found, allowed).at_data_row(first as u64 + 1));
        }
        findings.push(Finding::warning(Found::NoStamps {
            rows: stampless.len(),
            first: first + 1,
        }));
    }
    if let Some(first) = repeated.first()
        && share(&repeated) <= clock::MAX_DROPPED_SHARE
        && stampless.is_empty()
        && let Some(clock) = coarse()
    {
        findings.push(Finding::note(Found::CountedRows {
            rows: repeated.len(),
            first: first + 1,
            tick: clock.tick,
            rate: clock.rate_hz,
        }));
        time = (0..range.len())
            .map(|row| row as f64 / clock.rate_hz)
            .collect();
        dropped.clear();
        repeated.clear();
    }
    if let Some(&first) = repeated.first() {
        let found = format!(
            "{} with the time stamp of the row before",
            count(repeated.len(), "row")
        );
        if share(&repeated) > clock::MAX_DROPPED_SHARE {
            let lasted = since(range.end - 1, origin) - since(range.start, origin);
            let rate = (range.len() - 1) as f64 / lasted;
            let all: Vec<f64> = range.clone().map(|row| since(row, origin)).collect();
            let part = Coarse::of_a_part(&all).filter(|(_, rows)| rows.len() < all.len());
            let full =
                Coarse::of_full_stamps(&all).filter(|_| part.is_none() && coarse().is_none());
            let allowed = match coarse().map_or(rate, |clock| clock.rate_hz) {
                _ if let Some(rate) = full => {
                    let error = Error::new(
                        Kind::Time,
                        found,
                        format!(
                            "at most 5 % of the rows: the clock is coarser than the sampling, at about {} Hz where no row is missing, and rows are missing here and there, \
                             which no rate counts; a log with finer time stamps, or one in which no row is missing",
                            short(rate)
                        ),
                    );
                    return Err(error.at_data_row(first as u64 + 1));
                }
                _ if let Some((clock, rows)) = &part => {
                    let at = |row: usize| short((range.start + row) as f64 / clock.rate_hz);
                    format!(
                        "at most 5 % of the rows: the clock is coarser than the sampling, at {} Hz, and rows are missing beside; a log \
                         with finer time stamps, or, above [columns] of axis.toml in place of time, {} and, under [log], a stretch of \
                         rows without a gap, counted at that rate: crop = [\"{} s\", \"{} s\"]",
                        clock.rate_hz,
                        clock.line(),
                        at(rows.start),
                        at(rows.end - 1)
                    )
                }
                rate if rate.is_finite() && lasted > 0.0 => format!(
                    "at most 5 % of the rows: the clock is coarser than the sampling; give the rate instead of the time column, on average \
                     rate = \"{} Hz\" above [columns] of axis.toml",
                    short(rate)
                ),
                _ => "time stamps that go on; give the rate instead of the time column, as in rate = \"1 kHz\" above [columns] of axis.toml"
                    .to_string(),
            };
            let error = Error::new(Kind::Time, found, allowed).settled_by_line();
            return Err(error.at_data_row(first as u64 + 1));
        }
        findings.push(Finding::warning(Found::RepeatedStamps {
            rows: repeated.len(),
            first: first + 1,
            seconds: since(first, origin),
        }));
    }
    if let Some(&(row, size)) = lifts.iter().find(|(row, _)| range.contains(row)) {
        let times = lifts.iter().filter(|(row, _)| range.contains(row)).count();
        let first = row + 1;
        findings.push(Finding::note(Found::TimeOverflow { size, times, first }));
    }
    if time.last().is_some_and(|t| *t > clock::MAX_DURATION) {
        let found = format!("the record lasts {} s", short(*time.last().unwrap_or(&0.0)));
        return Err(Error::new(
            Kind::Time,
            found,
            "at most 1e9 s; check the unit of the time",
        ));
    }
    let start = base.map_or(0.0, |(first, lift)| {
        source.si(first) + source.si_difference(lift)
    });
    let since_first = base.map_or(0.0, |(first, lift)| {
        source.si_difference((first - origin) + lift)
    });
    Ok(Clock {
        time,
        start,
        since_first,
        range,
        dropped,
    })
}

/// The first stamp behind which steps are those of the end, and the steps at beginning and end, s, where these are as far apart as
/// units of time are, such as milliseconds in one part of a file and seconds in the other.
fn two_units(time: &[f64]) -> Option<(usize, [f64; 2])> {
    /// Part of the record at each end, and fewest steps there.
    const END: usize = 20;
    const FEWEST: usize = 20;
    const UNITS: [f64; 2] = [1e3, 1e6];
    const SAME: f64 = 0.02;
    let steps: Vec<f64> = time.windows(2).map(|w| w[1] - w[0]).collect();
    let many = steps.len() / END;
    if many < FEWEST {
        return None;
    }
    let of = |part: &[f64]| median(&mut part.to_vec());
    let (from, to) = (of(&steps[..many])?, of(&steps[steps.len() - many..])?);
    let ratio = (to / from).max(from / to);
    UNITS
        .iter()
        .any(|unit| (ratio / unit - 1.0).abs() < SAME)
        .then_some(())?;
    let middle = (from * to).sqrt();
    let is_of_the_end = |step: &f64| (*step > middle) == (to > from);
    // The longest stretch of them that reaches the end.
    let at = steps.iter().rposition(|step| !is_of_the_end(step))? + 1;
    Some((at + 1, [from, to]))
}

/// The rate of the rows, Hz, whose stamps a clock rounds that is coarser than the sampling; `None` where the stamps are to be kept.
pub(super) fn rate_of_coarse(raw: &[f64], source: &Source) -> Option<f64> {
    let first = raw.first().copied().filter(is_stamp)?;
    let time: Vec<f64> = raw
        .iter()
        .map(|t| source.si_difference(t - first))
        .collect();
    let repeated = time.windows(2).filter(|pair| pair[1] == pair[0]).count();
    let mean = (time.len() - 1) as f64 / time.last()?;
    let is_mostly_repeated = repeated as f64 > clock::MAX_DROPPED_SHARE * time.len() as f64;
    let whole = Coarse::of(&time);
    // Where rows are missing no rate counts them.
    let is_whole = whole.is_some() || Coarse::of_a_part(&time).is_none();
    let mean = short(mean).parse().ok().filter(|_| {
        is_mostly_repeated && is_whole && mean.is_finite() && mean > 0.0 && time.is_sorted()
    });
    whole.map(|clock| clock.rate_hz).or(mean)
}

/// Where the counter overflows, with what has to be added from there on, and the rows that go back
/// for no such reason.
fn overflows(raw: &[f64]) -> (Vec<(usize, f64)>, Vec<usize>) {
    let forward = raw
        .windows(2)
        .map(|w| w[1] - w[0])
        .filter(|d| *d > 0.0 && d.is_finite());
    let usual = median(&mut forward.collect::<Vec<_>>()).unwrap_or(0.0);
    let (mut lifts, mut broken): (Vec<(usize, f64)>, _) = (Vec::new(), Vec::new());
    let mut total = 0.0;
    let mut before = f64::NEG_INFINITY;
    for (row, &now) in raw.iter().enumerate().filter(|(_, t)| is_stamp(t)) {
        if now < before {
            let counter = COUNTER_SIZES.into_iter().find(|size| {
                let step = now + size - before;
                let whole = now.fract() == 0.0 && before.fract() == 0.0;
                whole
                    && now >= -size / 2.0
                    && step > 0.0
                    && step <= clock::MAX_OVERFLOW_STEP * usual
            });
            match counter {
                Some(size) => {
                    total += size;
                    lifts.push((row, total));
                }
                None => broken.push(row),
            }
        }
        before = now;
    }
    (lifts, broken)
}

/// Whether a number can be a time stamp.
fn is_stamp(raw: &f64) -> bool {
    raw.abs() <= signal::MAX_MEASURED
}

/// The refusal of time that goes back at a row; `end` is the last second, counted from the first sample, that may be kept before it.
fn backward(raw: &[f64], row: usize, end: Option<f64>) -> Error {
    let before = raw[..row]
        .iter()
        .rev()
        .copied()
        .find(is_stamp)
        .unwrap_or(f64::NAN);
    let found = format!(
        "time goes back from {} to {} in data row {}",
        full(before),
        full(raw[row]),
        row + 1
    );
    let in_order = end.is_some();
    let allowed = match end {
        Some(end) => format!(
            "increasing time stamps; if two recordings are in one file, keep the first under [log] of axis.toml: crop = [\"0 s\", \
             \"{} s\"], or give the rate instead of the time column",
            full((end * 1e6).floor() / 1e6)
        ),
        None => "increasing time stamps: sort the rows by them, or give the rate instead of the time column".into(),
    };
    let error = Error::new(Kind::Time, found, allowed).at_data_row(row as u64 + 1);
    match in_order {
        true => error.settled_by_line(),
        false => error,
    }
}

/// The rows between the first at or after the begin of the crop and the last before its end.
fn crop(
    length: usize,
    mapping: &Mapping,
    at: impl Fn(usize) -> f64,
) -> Result<Range<usize>, Error> {
    let Some((from, to)) = mapping.crop else {
        return Ok(0..length);
    };
    let slack = CROP_ROUNDING * from.abs().max(to.abs()).min(1e9);
    let start = (0..length).find(|&row| at(row) >= from - slack);
    // Another recording may begin right behind the last row that is asked for.
    let begins_again = |row: usize| at(row - 1) >= to - slack && at(row) < at(row - 1);
    let end = start.map(|s| {
        (s..length)
            .find(|&row| at(row) > to + slack || row > s && begins_again(row))
            .unwrap_or(length)
    });
    match (start, end) {
        (Some(start), Some(end)) if start < end => Ok(start..end),
        _ => {
            let last = (0..length)
                .rev()
                .map(&at)
                .find(|t| t.is_finite())
                .unwrap_or(0.0);
            let found = format!("crop from {} to {} s keeps no sample", full(from), full(to));
            let allowed = format!(
                "the record runs from 0 to {} s, counted from its first sample",
                short(last)
            );
            Err(Error::new(Kind::Value, found, allowed).of_setting("log.crop"))
        }
    }
}
