//! A drive that gave less than the force that was logged, where that was large.
//!
//! A log may hold what a controller asked for, and the drive at its limit gives no more than that. Beyond the limit the force is
//! one that the axis never felt: what exceeds it is one more column, with a factor of 1.

use super::beside::Beside;
use super::waves::highest;
use super::{Candidate, Effect, Fitted};
use crate::conditioning::record::Record;
use crate::conditioning::shift::Shift;
use stiction_policy::effect;

/// Limits that are tried, in parts of the largest force that was logged.
const TRIED: std::ops::Range<u32> = 12..49;
const STEP: f64 = 0.02;
/// Steps of the search beside the best of them.
const STEPS: usize = 8;

/// The limit that explains most, where one does.
pub(super) fn candidate(fitted: &Fitted, beside: &Beside) -> Option<Candidate> {
    let record = fitted.objective.record();
    let forces = || record.segments.iter().flat_map(|s| &s.drive);
    let largest = forces().fold(0.0_f64, |most, u| most.max(u.abs()));
    if largest.is_nan() || largest <= 0.0 {
        return None;
    }
    let column = |force: f64| {
        let beyond = record.segments.iter().map(|s| {
            let each = s.drive.iter().map(|u| u - u.clamp(-force, force));
            each.collect::<Vec<f64>>()
        });
        let mut beyond: Vec<Vec<f64>> = beyond.collect();
        record.filter(&mut beyond);
        let mut column = Vec::with_capacity(fitted.level.len());
        for (segment, full) in record.segments.iter().zip(&beyond) {
            record.thin(segment, full, Shift::NONE, &mut column);
        }
        column
    };
    let count = forces().count() as f64;
    let beyond = |force: f64| forces().filter(|u| u.abs() > force).count() as f64 / count;
    let share = |part: f64| beside.explained(&column(part * largest)).share;
    let tried =
        TRIED.skip_while(|i| beyond(STEP * f64::from(*i) * largest) > effect::MAX_LIMITED_SHARE);
    let first = tried.clone().next()?;
    let tried = tried.map(|i| (i, share(STEP * f64::from(i))));
    let (best, _) = tried.max_by(|a, b| a.1.total_cmp(&b.1))?;
    // One below all that were tried is not known.
    (best > first).then_some(())?;
    let force = largest * highest(STEP * f64::from(best), STEP, STEPS, share);
    let own = column(force);
    let small = 0.5 * STEP;
    let [low, high] = [1.0 - small, 1.0 + small].map(|part| column(part * force));
    let slope = high.iter().zip(&low).map(|(h, l)| (h - l) / (2.0 * small));
    let slope = slope.collect();
    let beyond = beyond(force);
    (beyond <= effect::MAX_LIMITED_SHARE && stays(record, force)).then_some(())?;
    let mut candidate = Candidate::new(vec![own], move |c| {
        effect::LIMIT_FACTORS
            .contains(&c[0])
            .then_some(Effect::Limit(force, beyond))
    });
    candidate.slope = Some(slope);
    Some(candidate)
}

/// Whether a force that is beyond a limit stays there.
fn stays(record: &Record, limit: f64) -> bool {
    let long = (5 * record.decimate / 4).max(effect::MIN_CONSECUTIVE_SAMPLES);
    let (mut all, mut together) = (0_usize, 0_usize);
    for segment in &record.segments {
        let alike = |a: &f64, b: &f64| (a.abs() > limit) == (b.abs() > limit);
        for run in segment.drive.chunk_by(alike) {
            if run[0].abs() > limit {
                all += run.len();
                together += if run.len() >= long { run.len() } else { 0 };
            }
        }
    }
    together as f64 >= effect::MIN_CONSECUTIVE_SHARE * all.max(1) as f64
}
