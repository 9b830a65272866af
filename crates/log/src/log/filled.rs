//! Zeros that stand for missing samples.
//!
//! Some exports write 0, or practically 0, where they have no sample. The number itself does not show it, but its
//! neighbours do: a signal that passes through 0 comes close to it first. A zero counts as evidence where the three
//! samples before and the three after all lie on one side of 0 and further from it than
//! [`signal::MIN_ZERO_DISTANCE`] times their own spread and the smallest step of the signal. Once there is enough
//! evidence, all zeros of the column are treated as missing cells.
//!
//! A signal that leaves a level at a limit for single samples comes close to 0 without a neighbour that shows it, but then it
//! leaves the level for other values too: 0 is evidence only where more samples stick out to it than to all other values.
//!
//! Velocity is not checked: one that is counted from encoder pulses is 0 wherever no pulse came.

use super::cells::{Columns, runs};
use crate::findings::Finding;
use crate::mapping::Role;
use crate::{Error, Kind};
use std::ops::Range;
use stiction_policy::signal;
use stiction_say::{Found, Zeros};

/// Samples on either side of a zero that it is compared with.
const NEIGHBOURS: usize = 3;

/// Turns zeros that an export filled in back into missing cells.
pub(super) fn clear(columns: &mut Columns, findings: &mut Vec<Finding>) -> Result<(), Error> {
    for role in [Role::Position, Role::Force, Role::Load] {
        let Some(values) = columns.get_mut(role) else {
            continue;
        };
        let filled = filled(values);
        let Some(first) = filled.first().map(|run| run.start) else {
            continue;
        };
        let (rows, cells) = (values.len(), filled.iter().map(Range::len).sum::<usize>());
        let largest = filled
            .iter()
            .flat_map(|run| &values[run.clone()])
            .fold(0.0_f64, |most, x| most.max(x.abs()));
        let zeros = Zeros {
            channel: role.name(),
            largest,
            cells,
            of: rows,
            first: first + 1,
        };
        // A load that is no use is no reason to refuse the motion.
        if role != Role::Load && cells as f64 > signal::MAX_MISSING_SHARE * rows as f64 {
            let allowed = "at most half may be missing; export the column at the rate of the \
                           others, and missing samples as empty cells";
            return Err(Error::new(Kind::Value, zeros.to_string(), allowed).in_column(role.name()));
        }
        findings.push(Finding::warning(Found::ZeroFilled(zeros)).at(first));
        for run in filled {
            values[run].fill(f64::NAN);
        }
    }
    Ok(())
}

/// Runs of zeros that were filled in; empty where zeros may well be real.
fn filled(values: &[f64]) -> Vec<Range<usize>> {
    let largest = values.iter().fold(
        0.0_f64,
        |most, x| if x.is_nan() { most } else { most.max(x.abs()) },
    );
    // Below the rounding of the column's own range there is nothing to be measured.
    let zero = |x: &f64| x.abs() <= f64::EPSILON * largest;
    let zeros = runs(values, zero);
    if zeros.len() < signal::MIN_ZERO_RUNS {
        return Vec::new();
    }
    let rest: Vec<usize> = (0..values.len())
        .filter(|&i| !values[i].is_nan() && !zero(&values[i]))
        .collect();
    let step = rest
        .windows(2)
        .map(|w| (values[w[1]] - values[w[0]]).abs())
        .filter(|d| *d > 0.0)
        .fold(f64::INFINITY, f64::min);
    // Whether `x` lies nearer to 0, and further from all of these samples than they from each other.
    let outlying = |x: f64, before: &[usize], after: &[usize]| {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for &i in before.iter().chain(after) {
            low = low.min(values[i]);
            high = high.max(values[i]);
        }
        let spread = high - low;
        let nearest = (low - x.max(0.0)).max(x.min(0.0) - high);
        spread > 0.0 && nearest > signal::MIN_ZERO_DISTANCE * spread.max(step)
    };
    let before = |at: usize| &rest[at.saturating_sub(NEIGHBOURS)..at];
    let after = |at: usize| &rest[at..(at + NEIGHBOURS).min(rest.len())];
    let sticks_out = |run: &Range<usize>| {
        let at = rest.partition_point(|&i| i < run.start);
        outlying(0.0, before(at), after(at))
    };
    let short = |run: &&Range<usize>| run.len() <= signal::MAX_BRIDGED_SAMPLES;
    let all = zeros.iter().filter(short).count();
    let telling = zeros
        .iter()
        .filter(short)
        .filter(|run| run.start > 0 && run.end < values.len() && sticks_out(run))
        .count();
    if telling < signal::MIN_ZERO_RUNS || (telling as f64) < signal::MIN_ZERO_SHARE * all as f64 {
        return Vec::new();
    }
    let to_other_values = (1..rest.len().saturating_sub(1))
        .filter(|&at| outlying(values[rest[at]], before(at), after(at + 1)))
        .count();
    if telling <= to_other_values {
        return Vec::new();
    }
    zeros
        .into_iter()
        .filter(|run| run.len() <= signal::MAX_BRIDGED_SAMPLES || sticks_out(run))
        .collect()
}
