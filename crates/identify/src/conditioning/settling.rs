//! Samples whose force depends on how far the bristles were deflected when a stretch began.

use crate::conditioning::record::Segment;
use stiction_policy::conditioning;

/// Leaves out what comes before the axis has slid `distance`, m or rad, since the start of each stretch; returns how many
/// samples of the regression that takes.
///
/// A law follows the deflection of its bristles from the motion, and the motion before a stretch is not known: a log may
/// begin while the axis is held by its bristles, and a gap may end in the middle of a reversal. What is held at the start
/// decays with the distance that is slid (LuGre: by exp(-s0 |dx|/g)), whichever law of bristles it is.
pub(super) fn settle(segments: &mut [Segment], decimate: usize, distance: f64) -> usize {
    if distance.is_nan() || distance <= 0.0 {
        return 0;
    }
    let ends = segments
        .iter()
        .map(|s| slid(s, distance).div_ceil(decimate));
    let ends: Vec<usize> = ends.collect();
    let of = |range: &[bool]| range.iter().filter(|keep| **keep).count();
    let all: usize = segments.iter().map(|s| of(&s.keep)).sum();
    let early = segments.iter().zip(&ends);
    let lost: usize = early.map(|(s, &end)| of(&s.keep[..end])).sum();
    if lost as f64 > conditioning::MAX_SETTLING_SHARE * all as f64
        || all - lost < conditioning::MIN_SETTLED_SAMPLES
    {
        return 0;
    }
    for (segment, end) in segments.iter_mut().zip(ends) {
        segment.keep[..end].fill(false);
    }
    lost
}

/// The distance, m or rad, that an axis must slide where its bristles are deflected by `breakaway` when they give way.
pub(crate) fn distance(breakaway: f64) -> f64 {
    conditioning::SETTLING_DEFLECTIONS * breakaway
}

/// The first sample at which the axis has slid a distance: the sum of its movements of a [`conditioning::SETTLING_DEFLECTIONS`]th of that or more, one way
/// each. Shorter ones, such as the noise of an axis at rest, do not slide.
fn slid(segment: &Segment, distance: f64) -> usize {
    let least = distance / conditioning::SETTLING_DEFLECTIONS;
    let mut at = 0.0;
    let mut from = 0.0;
    let mut sum = 0.0;
    for (i, v) in segment.velocity.windows(2).enumerate() {
        at += 0.5 * (v[0] + v[1]) * segment.step;
        let moved = f64::abs(at - from);
        if moved >= least {
            sum += moved;
            from = at;
        }
        if sum >= distance * (1.0 - f64::EPSILON) {
            return i + 1;
        }
    }
    segment.velocity.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conditioning::record::tests::of_velocities;

    /// At 1 m/s, 1 ms a sample, 6 mm take 6 samples; an axis that trembles by less than a millimetre does not slide.
    #[test]
    fn an_axis_slides_by_movements_of_break_away() {
        let moving = vec![1.0; 1000];
        let still: Vec<f64> = (0..30)
            .map(|k| if k % 2 == 0 { 0.9 } else { -0.9 })
            .collect();
        let late: Vec<f64> = still.iter().chain(&moving).copied().collect();
        let mut record = of_velocities(1e-3, &[&moving, &late, &still]);
        let lost = settle(&mut record.segments, 1, distance(1e-3));
        let first = |i: usize| record.segments[i].keep.iter().position(|&k| k);
        let starts = [0, 1, 2].map(first);
        assert!(
            matches!(starts, [Some(6..=7), Some(35..=37), None]),
            "{starts:?}"
        );
        assert_eq!(lost, 2060 - record.kept());
        assert_eq!(settle(&mut record.segments, 1, 0.0), 0);
    }

    /// A record that would lose more than half is fitted whole, and so is a short one.
    #[test]
    fn an_axis_that_hardly_slides_is_fitted_whole() {
        let of = |distance: f64, samples: usize| {
            let mut record = of_velocities(1e-3, &[&vec![1.0; samples]]);
            settle(&mut record.segments, 1, distance)
        };
        assert!((480..=500).contains(&of(0.48, 1000)));
        assert_eq!(of(0.52, 1000), 0);
        assert_eq!(of(0.01, 65), 0);
    }
}
