//! An axis that something else than friction holds where it rests: a brake, or a clamp.
//!
//! Bristles let the axis follow the force that they take up: a force that changes by so much moves it by that over their stiffness.
//! Where the force of a rest goes by far more without a count of motion, no friction holds the axis.

use super::{Candidate, Effect, Fitted};
use crate::conditioning::shift::Shift;

/// Shortest rest that is looked at, s, and the part of it over which a force is averaged.
const SHORTEST: f64 = 0.03;
const BLOCKS: usize = 6;
/// Motion that a rest may have, counts; the reading of one that does not move may go to and fro between two.
const STILL: f64 = 1.5;
/// How much farther than that the bristles would have moved, and the part of the rests, from which something else holds the axis: a
/// stiffness that was fitted beside may be several times that of the bristles.
const FARTHER: f64 = 4.0;
const PART: f64 = 0.5;
const FEWEST: usize = 3;

/// What the force of such rests does, as it would not beside bristles; `None` where friction holds the axis, or its counts are too
/// coarse to tell.
pub(super) fn candidate(fitted: &Fitted) -> Option<Candidate> {
    let record = fitted.objective.record();
    let kappa = fitted.objective.law().layout().kappa?;
    let count = record.resolution.filter(|count| *count > 0.0)?;
    let level = fitted
        .level
        .iter()
        .fold(0.0_f64, |most, f| most.max(f.abs()));
    let bent = FARTHER * STILL * count * level * libm::exp(fitted.p[kappa]);
    let (mut rests, mut force) = ([0, 0], 0.0_f64);
    let mut all = Vec::with_capacity(record.segments.len());
    for segment in &record.segments {
        let least = (SHORTEST / segment.step) as usize;
        let mut column = vec![0.0; segment.drive.len()];
        for rest in still(&segment.reading, STILL * count) {
            if rest.len() < least.max(4 * BLOCKS) {
                continue;
            }
            let own = &segment.drive[rest.clone()];
            let Some(went) = went(own) else {
                continue;
            };
            rests[1] += 1;
            if went > bent {
                rests[0] += 1;
                force = force.max(went);
                let mean = own.iter().sum::<f64>() / own.len() as f64;
                let inside = column[rest].iter_mut().zip(own);
                inside.for_each(|(x, u)| *x = u - mean);
            }
        }
        all.push(column);
    }
    let [held, looked_at] = rests;
    (held >= FEWEST && held as f64 >= PART * looked_at as f64).then_some(())?;
    record.filter(&mut all);
    let mut column = Vec::with_capacity(fitted.level.len());
    for (segment, full) in record.segments.iter().zip(&all) {
        record.thin(segment, full, Shift::NONE, &mut column);
    }
    Some(Candidate::new(vec![column], move |c| {
        (c[0] > 0.0).then_some(Effect::Brake(rests, force))
    }))
}

/// Ranges over which a reading stays within a distance.
fn still(reading: &[f64], within: f64) -> Vec<std::ops::Range<usize>> {
    let mut out = Vec::new();
    let (mut start, mut low, mut high) = (0, f64::INFINITY, f64::NEG_INFINITY);
    for (k, &x) in reading.iter().enumerate() {
        let (below, above) = (low.min(x), high.max(x));
        if above - below > within && k > start {
            out.push(start..k);
            (start, low, high) = (k, x, x);
        } else {
            (low, high) = (below, above);
        }
    }
    out.push(start..reading.len());
    out
}

/// By how much the mean of a force over parts of a rest goes, beyond what its noise explains.
fn went(force: &[f64]) -> Option<f64> {
    let length = force.len() / BLOCKS;
    let blocks: Vec<&[f64]> = force.chunks_exact(length).collect();
    let means = blocks
        .iter()
        .map(|block| block.iter().sum::<f64>() / length as f64);
    let (low, high) = means.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(x), high.max(x))
    });
    // Differences of neighbours, so that a ramp is no noise.
    let steps = force.windows(2).map(|f| (f[1] - f[0]) * (f[1] - f[0]));
    let noise = (0.5 * steps.sum::<f64>() / (force.len() * length) as f64).sqrt();
    let went = high - low - 4.0 * noise;
    (went > 0.0).then_some(went)
}

#[cfg(test)]
mod tests {
    use super::{still, went};

    #[test]
    fn a_force_goes_beyond_its_noise_and_a_reading_is_still() {
        let force: Vec<f64> = (0..600).map(|k| if k < 300 { 4.0 } else { 1.0 }).collect();
        let found = went(&force).unwrap();
        assert!((2.5..3.0).contains(&found), "{found}");
        let noise: Vec<f64> = (0..600).map(|k| libm::sin((k * k) as f64)).collect();
        assert!(went(&noise).unwrap_or(0.0) < 0.2);
        let reading = [0.0, 1.0, 0.0, 1.0, 2.0, 3.0, 3.0];
        assert_eq!(still(&reading, 1.5), vec![0..4, 4..7]);
    }
}
