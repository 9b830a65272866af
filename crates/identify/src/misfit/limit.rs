//! A drive that gave less than the force that was logged, where that was large.
//!
//! A log may hold what a controller asked for, and the drive at its limit gives no more than that. Beyond the limit the force is
//! one that the axis never felt: as for a [`coupling`](super::coupling), what exceeds it is one more column, with a factor of 1.

use super::coupling::beside::Beside;
use crate::conditioning::record::Record;
use crate::conditioning::shift::Shift;
use crate::separable::objective::Evaluation;

/// Limits that are tried, in parts of the largest force that was logged.
const TRIED: std::ops::Range<u32> = 12..49;
const STEP: f64 = 0.02;
/// Part of the residual that a limit explains, beyond all that a law can take up, from which it is the cause, and the factors of
/// what exceeds it that make it so: other laws leave only a part of a force that is large.
const SHARE: f64 = 0.8;
const FACTORS: std::ops::Range<f64> = 0.8..1.2;
/// Largest part of the samples beyond a limit: an axis whose drive gives less more often than that does not move as it is asked.
const MOST_BEYOND: f64 = 0.2;
/// Part of these samples that lie together, as many as half a period of the common cut-off has and no fewer than this: a drive stays
/// at its limit, while spikes of a force that answers noise come and go.
const TOGETHER: f64 = 0.8;
const FEWEST_TOGETHER: usize = 5;

/// The most that a drive gave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Force, either way, in its unit.
    pub force: f64,
    /// Part of the samples of the log beyond it, 0 to 1.
    pub beyond: f64,
    /// Part of the variance of the residual that it explains, 0 to 1.
    pub share: f64,
}

/// Looks for a limit; `None` where none explains much of the residual.
pub(super) fn sought(record: &Record, at: &Evaluation, residual: &[f64]) -> Option<Limit> {
    let forces = || record.segments.iter().flat_map(|s| &s.drive);
    let largest = forces().fold(0.0_f64, |most, u| most.max(u.abs()));
    if largest.is_nan() || largest <= 0.0 {
        return None;
    }
    let beside = Beside::new(&at.jacobian(), residual);
    let found = |force: f64| {
        let mut beyond: Vec<Vec<f64>> = record
            .segments
            .iter()
            .map(|s| s.drive.iter().map(|u| u - u.clamp(-force, force)).collect())
            .collect();
        record.filter(&mut beyond);
        let mut column = Vec::with_capacity(residual.len());
        for (segment, full) in record.segments.iter().zip(&beyond) {
            record.thin(segment, full, Shift::NONE, &mut column);
        }
        (force, beside.explained(&column))
    };
    let tried = TRIED.map(|i| found(STEP * f64::from(i) * largest));
    let (force, explained) = tried.max_by(|a, b| a.1.share.total_cmp(&b.1.share))?;
    let count = forces().count() as f64;
    let beyond = forces().filter(|u| u.abs() > force).count() as f64 / count;
    let is_one = explained.share >= SHARE
        && FACTORS.contains(&explained.coefficient)
        && beyond <= MOST_BEYOND
        && stays(record, force);
    is_one.then_some(Limit {
        force,
        beyond,
        share: explained.share,
    })
}

/// Whether a force that is beyond a limit stays there.
fn stays(record: &Record, limit: f64) -> bool {
    let long = (5 * record.decimate / 4).max(FEWEST_TOGETHER);
    let (mut all, mut together) = (0_usize, 0_usize);
    for segment in &record.segments {
        for run in segment
            .drive
            .chunk_by(|a, b| (a.abs() > limit) == (b.abs() > limit))
        {
            if run[0].abs() > limit {
                all += run.len();
                together += if run.len() >= long { run.len() } else { 0 };
            }
        }
    }
    together as f64 >= TOGETHER * all.max(1) as f64
}
