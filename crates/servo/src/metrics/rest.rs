//! What an axis does while its reference stands still.

use super::{MIN_STRETCH, settled};
use crate::axis::Sample;
use crate::path::Reference;

/// Shortest rest in which hunting is looked for, s: its cycles last tenths of a second and longer, as the integral of the
/// controller has to build up the break-away force in each.
const MIN_HUNTING_REST: f64 = 1.0;
/// Half width of the band about the middle that the axis has to cross to count, as a fraction of the amplitude.
const BAND: f64 = 0.5;
/// Fewest whole cycles that are a limit cycle.
const FEWEST_CYCLES: usize = 2;
/// Longest cycle of a limit cycle over its shortest: noise crosses the band at any time.
const MOST_UNEVEN: f64 = 2.0;
/// Least amplitude at the end of the rest over that before: what dies out is no limit cycle.
const LEAST_KEPT: f64 = 0.5;
/// Least amplitude over the largest position: below it is rounding.
const ROUNDING: f64 = 1e-12;

/// The rests of the reference after it has moved, of at least so many seconds, each from its middle on.
fn rests(samples: &[Sample], least: f64) -> impl Iterator<Item = &[Sample]> {
    let stands = |r: &Reference| r.velocity == 0.0 && r.acceleration == 0.0;
    let begin = samples
        .iter()
        .position(|s| !stands(&s.reference) || s.reference.position != 0.0);
    let moved = &samples[begin.unwrap_or(samples.len())..];
    settled(moved, least, move |a, b| stands(a) && stands(b))
}

/// Largest mean error, either way, over the second halves of the rests of the reference after it has moved, of at least .1 s
/// each: where the axis stands, m (rad). `None` without such a rest.
pub fn standing_error(samples: &[Sample]) -> Option<f64> {
    rests(samples, MIN_STRETCH)
        .map(|rest| {
            let sum: f64 = rest.iter().map(Sample::error).sum();
            (sum / rest.len() as f64).abs()
        })
        .reduce(f64::max)
}

/// A limit cycle about a reference that stands still.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hunting {
    /// Half the distance of the outermost positions, m (rad); 0 where the axis does not hunt.
    pub amplitude: f64,
    /// Mean length of a cycle, s; `None` where it does not hunt.
    pub period: Option<f64>,
}

impl Hunting {
    /// The largest of all rests of the reference after it has moved, of at least 1 s, each from its middle on; `None` without
    /// such a rest. A limit cycle is what crosses the middle of its range at least twice upwards and once more, in cycles
    /// that do not differ by more than a factor of two, and does not die out.
    pub fn of(samples: &[Sample]) -> Option<Self> {
        rests(samples, MIN_HUNTING_REST)
            .map(|rest| Hunting::in_rest(rest).unwrap_or(Hunting::NONE))
            .reduce(|a, b| if b.amplitude > a.amplitude { b } else { a })
    }

    const NONE: Hunting = Hunting {
        amplitude: 0.0,
        period: None,
    };

    fn in_rest(rest: &[Sample]) -> Option<Self> {
        let (low, high) = ends(rest);
        let (middle, amplitude) = (0.5 * (low + high), 0.5 * (high - low));
        let farthest = rest.iter().fold(0.0_f64, |m, s| m.max(s.position.abs()));
        if amplitude <= ROUNDING * farthest {
            return None;
        }
        let mut rising = Vec::new();
        let mut below = false;
        for sample in rest {
            let off = sample.position - middle;
            if off <= -BAND * amplitude {
                below = true;
            } else if off >= BAND * amplitude && below {
                below = false;
                rising.push(sample.time);
            }
        }
        let cycles: Vec<f64> = rising.windows(2).map(|pair| pair[1] - pair[0]).collect();
        if cycles.len() < FEWEST_CYCLES {
            return None;
        }
        let longest = cycles.iter().fold(0.0, |m: f64, c| m.max(*c));
        let shortest = cycles.iter().fold(f64::INFINITY, |m, c| m.min(*c));
        let (before, after) = rest.split_at(rest.len() / 2);
        let size = |part: &[Sample]| {
            let (low, high) = ends(part);
            high - low
        };
        let lasts = size(after) >= LEAST_KEPT * size(before);
        (lasts && longest <= MOST_UNEVEN * shortest).then(|| Hunting {
            amplitude,
            period: Some(cycles.iter().sum::<f64>() / cycles.len() as f64),
        })
    }
}

/// The outermost positions.
fn ends(samples: &[Sample]) -> (f64, f64) {
    let ends = (f64::INFINITY, f64::NEG_INFINITY);
    samples.iter().fold(ends, |(low, high), s| {
        (low.min(s.position), high.max(s.position))
    })
}
