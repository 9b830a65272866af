//! Single samples of the force far beyond all others: transmission errors, which would be most of what a fit sees.

use super::finding::{Finding, place};
use crate::log::Log;
use std::ops::Range;
use stiction_codes::Code;
use stiction_policy::force;
use stiction_say::{Found, Value};

/// Finds such samples, puts straight lines in their place, and excludes them.
pub(super) fn spikes(log: &mut Log) {
    let Some(force) = &mut log.force else { return };
    let most = force::MAX_SPIKES.min(force.len() / 1000).max(1);
    if force.len() < 100 * most {
        return;
    }
    let above = outermost(force, most + 1, 1.0);
    let below = outermost(force, most + 1, -1.0);
    let (high, low) = (above[most].0, -below[most].0);
    let range = high - low;
    if range.is_nan() || range <= 0.0 {
        return;
    }
    let far = |(value, _): &&(f64, usize), edge: f64| value - edge > force::MIN_SPIKE * range;
    let above = above.iter().filter(|at| far(at, high));
    let below = below.iter().filter(|at| far(at, -low));
    let mut rows: Vec<usize> = above.chain(below).map(|(_, row)| *row).collect();
    rows.sort_unstable();
    let in_a_row = rows.chunk_by(|a, b| a + 1 == *b);
    let runs: Vec<Range<usize>> = in_a_row
        .map(|run| run[0]..run[run.len() - 1] + 1)
        .filter(|run| {
            run.len() <= force::MAX_SPIKE_SAMPLES && run.start > 0 && run.end < force.len()
        })
        .collect();
    let Some(first) = runs.first().map(|run| run.start) else {
        return;
    };
    let largest = force[first];
    for run in &runs {
        let (from, to) = (force[run.start - 1], force[run.end]);
        let steps = (run.len() + 1) as f64;
        for (step, row) in (1..).zip(run.clone()) {
            force[row] = from + (to - from) * f64::from(step) / steps;
        }
    }
    let found = Found::Outliers {
        samples: runs.iter().map(Range::len).sum(),
        times: force::MIN_SPIKE,
        force: Value::new(largest, &log.force_unit),
        first: place(log, first),
    };
    log.findings.push(Finding::warning(found).at(first));
    for run in runs {
        log.exclude(run, Code::ForceSpike);
    }
}

/// So many of the largest values times a sign, with their rows, the largest first.
fn outermost(values: &[f64], wanted: usize, sign: f64) -> Vec<(f64, usize)> {
    let mut out: Vec<(f64, usize)> = Vec::with_capacity(wanted + 1);
    for (row, value) in values.iter().map(|x| sign * x).enumerate() {
        if out.len() == wanted && value <= out[wanted - 1].0 {
            continue;
        }
        let at = out.partition_point(|(other, _)| *other >= value);
        out.insert(at, (value, row));
        out.truncate(wanted);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::outermost;

    #[test]
    fn the_outermost_are_the_largest_with_their_rows() {
        let values = [1.0, 5.0, -9.0, 5.0, 3.0];
        assert_eq!(outermost(&values, 3, 1.0), [(5.0, 1), (5.0, 3), (3.0, 4)]);
        assert_eq!(outermost(&values, 2, -1.0), [(9.0, 2), (-1.0, 0)]);
    }
}
