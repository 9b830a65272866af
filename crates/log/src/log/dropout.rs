//! Cells of a temperature or a load that no sensor measured.
//!
//! A temperature is above 0 K. Beside that, a sensor that drops out leaves the course of its channel in one row and comes
//! back to it in another: 0, -999 or the end of a range, for a row or for longer. Such a step is told from those that the
//! channel makes by itself.
//!
//! A temperature cannot make such steps, however long it stays; a load can. So of a load only what comes back after
//! few rows, on one value where it is more than [`signal::MAX_BRIDGED_SAMPLES`], is a dropout, and only where there is little of it.
//!
//! These cells become missing ones, which a slow channel has filled in.

use super::cells::{Columns, LeftOut};
use super::clock::Clock;
use crate::Table;
use crate::findings::{Finding, full, median};
use crate::mapping::{Role, Source};
use std::ops::Range;
use stiction_policy::signal;
use stiction_say::{Dropout, Found, Useless, Value};

/// Steps are taken over so many rows, and the least quartile counts: with a dropout at every second row none is over one.
const OVER_ROWS: std::ops::RangeInclusive<usize> = 1..=4;

/// Turns what no sensor measured into missing cells; says what, and which channels are no use.
pub(super) fn clear(
    columns: &mut Columns,
    table: &Table,
    sources: &[(Role, Source)],
    clock: &Clock,
    findings: &mut Vec<Finding>,
) -> Vec<LeftOut> {
    let mut left_out = Vec::new();
    for (role, source) in sources {
        if ![Role::Temperature, Role::Load].contains(role) {
            continue;
        }
        let Some(values) = columns.get_mut(*role) else {
            continue;
        };
        // What stands in the file, with its place.
        let cell = |kept: usize| {
            let row = clock.row(kept);
            let number = table.columns[source.column].values[row];
            (row + 1, format!("{} {}", full(number), source.unit))
        };
        let column = source.place(table);
        if *role == Role::Temperature {
            let found = runs_below_zero(values);
            if let Some(first) = found.first().map(|run| run.start) {
                let (row, number) = cell(first);
                let found_below = Found::BelowAbsoluteZero {
                    rows: rows(&found),
                    of: values.len(),
                    first: row,
                    column: column.clone(),
                    number,
                };
                findings.push(Finding::warning(found_below).at(first));
                empty(values, &found);
            }
        }
        let least = least_step(values, *role);
        let found = strays(values, &clock.time, least, *role);
        let Some(first) = found.first().map(|run| run.start) else {
            continue;
        };
        let (row, number) = cell(first);
        let whole = (0..values.len()).filter(|i| !values[*i].is_nan()).count();
        let dropout = Dropout {
            channel: role.name(),
            times: found.len(),
            rows: rows(&found),
            first: row,
            column,
            number,
            step: Value::new(least, source.dimension.si_text()),
        };
        if rows(&found) as f64 >= signal::MIN_ON_COURSE * whole as f64 {
            values.clear();
            left_out.push(LeftOut::new(*role, Useless::Scattered(dropout)));
            findings.extend(left_out.last().map(LeftOut::finding));
            continue;
        }
        findings.push(Finding::warning(Found::Dropout(dropout)).at(first));
        empty(values, &found);
    }
    left_out
}

fn rows(runs: &[Range<usize>]) -> usize {
    runs.iter().map(Range::len).sum()
}

fn empty(values: &mut [f64], runs: &[Range<usize>]) {
    for run in runs {
        values[run.clone()].fill(f64::NAN);
    }
}

fn runs_below_zero(values: &[f64]) -> Vec<Range<usize>> {
    super::cells::runs(values, |x| *x <= 0.0)
}

/// The step from which on a channel leaves its course.
fn least_step(values: &[f64], role: Role) -> f64 {
    let numbers: Vec<f64> = values.iter().copied().filter(|x| !x.is_nan()).collect();
    let quartile = |over: usize| {
        let mut steps: Vec<f64> = numbers
            .windows(over + 1)
            .map(|w| (w[over] - w[0]).abs())
            .collect();
        let quarter = steps.len() / 4;
        (quarter > 0).then(|| *steps.select_nth_unstable_by(quarter, f64::total_cmp).1)
    };
    let usual = OVER_ROWS.filter_map(quartile).min_by(f64::total_cmp);
    let least = match role {
        Role::Temperature => signal::MIN_TEMPERATURE_DROPOUT,
        _ => {
            let mut sizes: Vec<f64> = numbers.iter().map(|x| x.abs()).collect();
            signal::MIN_LOAD_DROPOUT * median(&mut sizes).unwrap_or(0.0)
        }
    };
    least.max(signal::MIN_DROPOUT_STEPS * usual.unwrap_or(0.0))
}

/// A stretch of the numbers of a channel without a step out of its course: their places among the numbers.
struct Piece {
    numbers: Range<usize>,
    /// Whether a pause lies before it.
    resumes: bool,
}

/// Runs of rows off the course of a channel.
fn strays(values: &[f64], time: &[f64], least: f64, role: Role) -> Vec<Range<usize>> {
    let at: Vec<usize> = (0..values.len()).filter(|i| !values[*i].is_nan()).collect();
    let pieces = pieces(values, time, &at, least);
    let mut numbers: Vec<f64> = at.iter().map(|i| values[*i]).collect();
    let Some(middle) = median(&mut numbers).filter(|_| pieces.len() > 1) else {
        return Vec::new();
    };
    let value = |number: usize| values[at[number]];
    let off = |p: &Piece| (value(p.numbers.start) - middle).abs();
    // The longest is on course; of equally long ones that which is nearest to what the channel mostly is.
    let longest = (0..pieces.len()).max_by(|&a, &b| {
        let by_length = pieces[a].numbers.len().cmp(&pieces[b].numbers.len());
        by_length.then(off(&pieces[b]).total_cmp(&off(&pieces[a])))
    });
    let Some(longest) = longest else {
        return Vec::new();
    };
    let mut on_course = vec![true; pieces.len()];
    let back = signal::MAX_RETURN_DISTANCE * least;
    let (mut level, mut on) = (value(pieces[longest].numbers.end - 1), true);
    for i in longest + 1..pieces.len() {
        let piece = &pieces[i];
        on = piece.resumes || (!on && (value(piece.numbers.start) - level).abs() <= back);
        on_course[i] = on;
        if on {
            level = value(piece.numbers.end - 1);
        }
    }
    (level, on) = (value(pieces[longest].numbers.start), true);
    for i in (0..longest).rev() {
        let piece = &pieces[i];
        let paused = pieces[i + 1].resumes;
        on = paused || (!on && (value(piece.numbers.end - 1) - level).abs() <= back);
        on_course[i] = on;
        if on {
            level = value(piece.numbers.start);
        }
    }
    // Rows without a number between two that are off are off, too.
    let mut found: Vec<Range<usize>> = Vec::new();
    let mut at_an_end = false;
    for (i, piece) in pieces.iter().enumerate().filter(|(i, _)| !on_course[*i]) {
        let run = at[piece.numbers.start]..at[piece.numbers.end - 1] + 1;
        at_an_end |= i == 0 || i + 1 == pieces.len();
        match found.last_mut().filter(|_| i > 0 && !on_course[i - 1]) {
            Some(last) => last.end = run.end,
            None => found.push(run),
        }
    }
    if role == Role::Temperature {
        return found;
    }
    let longest =
        (signal::MAX_LOAD_DROPOUT * values.len() as f64).max(signal::MAX_BRIDGED_SAMPLES as f64);
    let brief = |run: &Range<usize>| {
        let first = values[run.start];
        run.len() <= signal::MAX_BRIDGED_SAMPLES
            || run.len() as f64 <= longest && values[run.clone()].iter().all(|x| *x == first)
    };
    let few = rows(&found) as f64 <= signal::MAX_LOAD_DROPOUTS * values.len() as f64;
    match few && !at_an_end && found.iter().all(brief) {
        true => found,
        false => Vec::new(),
    }
}

/// The numbers of a channel, cut where it steps out of or into its course and at pauses.
fn pieces(values: &[f64], time: &[f64], at: &[usize], least: f64) -> Vec<Piece> {
    let spacings = at.windows(2).map(|w| time[w[1]] - time[w[0]]);
    let usual = median(&mut spacings.collect::<Vec<_>>()).unwrap_or(0.0);
    let pause = signal::MIN_PAUSE.max(signal::MIN_PAUSE_STEPS * usual);
    let mut out = Vec::new();
    let (mut start, mut resumes) = (0, false);
    for i in 1..=at.len() {
        let (steps, paused) = match at.get(i) {
            None => (true, false),
            Some(&row) => {
                let before = at[i - 1];
                let step = (values[row] - values[before]).abs();
                (step > least, time[row] - time[before] > pause)
            }
        };
        if steps || paused {
            out.push(Piece {
                numbers: start..i,
                resumes,
            });
            (start, resumes) = (i, paused);
        }
    }
    out
}
