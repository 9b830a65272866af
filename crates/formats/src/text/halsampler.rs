//! Samples that LinuxCNC's halsampler lost.
//!
//! It writes a line `overrun` wherever the number of a sample does not follow that of the sample before
//! ([`sampler_usr.c`](https://github.com/LinuxCNC/linuxcnc/blob/master/src/hal/components/sampler_usr.c)): at the head of a
//! log where sampling had begun before, which loses nothing of the log, and between rows where samples were overwritten
//! before it read them, or were read by another. How many samples are missing only the numbers tell, which it writes in front
//! of each row with `-t`. What LinuxCNC 2.9 drops when its buffer is full has neither mark nor number.

use super::body::Body;
use super::problem::count;
use super::row::Role;
use crate::limits::Budget;
use crate::{Error, Kind};

/// Whether a line is the mark of halsampler, and nothing else.
pub(super) fn is_overrun(text: &[u8]) -> bool {
    let rest = text.strip_prefix(b"overrun");
    rest.is_some_and(|rest| matches!(rest, [] | [b'\n' | b'\r', ..]))
}

/// Puts a row of missing values in place of every sample that was lost between two rows, and says how many.
pub(super) fn restore(body: &mut Body, budget: Budget) -> Result<Option<String>, Error> {
    let rows = body.rows;
    let overruns: Vec<usize> = (body.overruns.iter().copied())
        .filter(|row| (1..rows).contains(row))
        .collect();
    let Some(&first) = overruns.first() else {
        return Ok(None);
    };
    let said = match overruns.len() {
        1 => format!("`overrun` after data row {first}"),
        n => format!("`overrun` in {n} places, first after data row {first}"),
    };
    let lost = match (&body.state.roles[..], &body.columns[..]) {
        ([Role::Number, ..], [numbers, ..]) => lost(numbers, &overruns),
        _ => None,
    };
    let Some(lost) = lost else {
        return Err(Error::new(
            Kind::Time,
            format!(
                "{said}: samples are missing, and no sample number in front of each row tells how many"
            ),
            "log with `halsampler -t`; a larger depth= of `loadrt sampler` loses none; or keep the rows before the first \
             overrun alone",
        ));
    };
    let missing: usize = lost.iter().sum();
    if missing > rows {
        return Err(Error::new(
            Kind::Limit,
            format!("{said}: {missing} samples are missing, and {rows} are there"),
            "at most as many missing as there are; log with a larger depth= of `loadrt sampler`, or keep the rows before \
             the first overrun alone",
        ));
    }
    let width = body.columns.iter().filter(|c| !c.is_empty()).count();
    let samples = (rows + missing).saturating_mul(width) as u64;
    if samples > budget.samples() {
        return Err(budget.too_many_samples(Some(samples)));
    }
    for (index, column) in body.columns.iter_mut().enumerate() {
        if !column.is_empty() {
            *column = filled(column, &overruns, &lost, index == 0);
        }
    }
    Ok(Some(format!(
        "{said}: {} missing, in rows without values",
        count(missing, "sample")
    )))
}

/// How many samples each overrun lost, where the first column has the numbers of the samples.
fn lost(numbers: &[f64], overruns: &[usize]) -> Option<Vec<usize>> {
    let mut next = overruns.iter().peekable();
    let mut lost = Vec::with_capacity(overruns.len());
    for (row, pair) in (1..).zip(numbers.windows(2)) {
        let step = pair[1] - pair[0];
        if next.next_if_eq(&&row).is_none() {
            if step != 1.0 {
                return None;
            }
        } else if step > 1.0 && step.fract() == 0.0 && step < f64::from(u32::MAX) {
            lost.push(step as usize - 1);
        } else {
            return None;
        }
    }
    Some(lost)
}

/// A column with rows for what was lost: the numbers of the samples go on, other values are missing.
fn filled(column: &[f64], overruns: &[usize], lost: &[usize], numbers: bool) -> Vec<f64> {
    let mut out = Vec::with_capacity(column.len() + lost.iter().sum::<usize>());
    let mut from = 0;
    for (&row, &lost) in overruns.iter().zip(lost) {
        out.extend_from_slice(&column[from..row]);
        let last = column[row - 1];
        out.extend((0..lost).map(|n| match numbers {
            true => last + 1.0 + n as f64,
            false => f64::NAN,
        }));
        from = row;
    }
    out.extend_from_slice(&column[from..]);
    out
}
