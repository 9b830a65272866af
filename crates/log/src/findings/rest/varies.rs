//! Whether the force of a rest varies on purpose.

use crate::log::Log;
use std::ops::Range;
use stiction_policy::rest;
use stiction_signal::Travel;

/// Length of the blocks over which the force is averaged, s.
const BLOCK_SECONDS: f64 = 0.25;

/// One past the last sample of a rest at the start before which the force is held: the end of the rest where it does
/// not vary, else where a ramp or a step begins.
pub(super) fn first_change(log: &Log, rest: &Range<usize>, spread: f64) -> usize {
    let Some(force) = Blocks::of(log, rest).filter(|force| force.varies(spread)) else {
        return rest.end;
    };
    let bound = (rest::MIN_CHANGE * spread).max(rest::MIN_CHANGE_DEVIATIONS * force.error);
    let first = force.means[0].1;
    let change = force
        .means
        .iter()
        .position(|(_, mean)| (mean - first).abs() > bound);
    // The block before may hold the beginning of the change.
    let block = change.map_or(force.means.len(), |i| i.saturating_sub(1));
    force
        .means
        .get(block)
        .map_or(rest.end, |(start, _)| (*start).max(rest.start + 1))
}

/// Whether the force of a rest varies by more than integrator, brake and noise explain where they hold it.
pub(super) fn at_all(log: &Log, rest: &Range<usize>, spread: f64) -> bool {
    Blocks::of(log, rest).is_some_and(|force| force.varies(spread))
}

/// From the 5th to the 95th percentile of the force of a record; 0 without one.
pub(super) fn spread(log: &Log) -> f64 {
    let mut sorted = log.force.clone().unwrap_or_default();
    if sorted.is_empty() {
        return 0.0;
    }
    let last = (sorted.len() - 1) as f64;
    let mut percentile = |part: f64| {
        let at = (part * last) as usize;
        *sorted.select_nth_unstable_by(at, f64::total_cmp).1
    };
    percentile(0.95) - percentile(0.05)
}

/// Whether the force goes to and fro in a rest at the end.
pub(super) fn to_and_fro(log: &Log, rest: &Range<usize>, spread: f64) -> bool {
    let Some(force) = Blocks::of(log, rest) else {
        return false;
    };
    let shortest = (rest::MIN_SWING * spread).max(2.0 * rest::MIN_CHANGE_DEVIATIONS * force.error);
    let travel = Travel::of(force.means.iter().map(|(_, mean)| *mean), shortest);
    travel.up > shortest && travel.down > shortest
}

/// Means of the force over short blocks of a rest.
struct Blocks {
    /// First sample and mean of each block.
    means: Vec<(usize, f64)>,
    /// Standard error of such a mean, from the scatter within the blocks.
    error: f64,
}

impl Blocks {
    /// `None` without a force, or in a rest shorter than two blocks.
    fn of(log: &Log, rest: &Range<usize>) -> Option<Self> {
        let force = log.force.as_deref()?;
        let samples = ((BLOCK_SECONDS * log.rate_hz) as usize).max(4);
        let (mut means, mut squares) = (Vec::new(), 0.0);
        let mut counted = 0_usize;
        for (i, block) in force.get(rest.clone())?.chunks_exact(samples).enumerate() {
            let mean = block.iter().sum::<f64>() / samples as f64;
            // Differences of neighbours, so that a ramp is not scatter.
            squares += block
                .windows(2)
                .map(|f| (f[1] - f[0]) * (f[1] - f[0]))
                .sum::<f64>();
            counted += samples - 1;
            means.push((rest.start + i * samples, mean));
        }
        if means.len() < 2 {
            return None;
        }
        Some(Self {
            means,
            error: (0.5 * squares / (counted * samples) as f64).sqrt(),
        })
    }

    /// Whether the means differ by more than where a controller or brake holds the force.
    fn varies(&self, spread: f64) -> bool {
        let (low, high) = self.extremes();
        high - low
            > (rest::MAX_HELD_FORCE * spread).max(2.0 * rest::MIN_CHANGE_DEVIATIONS * self.error)
    }

    fn extremes(&self) -> (f64, f64) {
        let means = self.means.iter().map(|(_, mean)| *mean);
        means.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        })
    }
}
