//! Contour errors of two axes.

use super::root_mean;
use crate::two_axes::PlaneSample;

/// Contour error, the deviation from the contour across it; m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contour {
    /// Rms deviation.
    pub rms: f64,
    /// Largest deviation either way.
    pub peak: f64,
}

impl Contour {
    /// From the given samples; all 0 without samples.
    pub fn of(samples: &[PlaneSample]) -> Self {
        let deviations = || samples.iter().map(|s| s.deviation);
        Contour {
            rms: root_mean(deviations().map(|d| d * d)),
            peak: deviations().fold(0.0, |m, d| m.max(d.abs())),
        }
    }
}

/// Circular deviation, m: the least distance of two circles about one centre that have all points between them (minimum
/// zone; the bidirectional deviation of ISO 230-4 if the points are those of both directions). At least three points, all
/// finite; fewer give 0. For points that are near no circle, as of an axis that lags far behind, an upper bound.
pub fn circular_deviation(points: &[[f64; 2]]) -> f64 {
    if points.len() < 3 {
        return 0.0;
    }
    let n = points.len() as f64;
    let sum = points
        .iter()
        .fold([0.0; 2], |s, p| [s[0] + p[0], s[1] + p[1]]);
    let mut centre = sum.map(|s| s / n);
    // Few points determine the zone: it is searched for a part of them, and points outside it are added.
    let every = points.len().div_ceil(FIRST_POINTS);
    let mut part: Vec<[f64; 2]> = points.iter().copied().step_by(every).collect();
    let mut best = width(points, centre);
    for _ in 0..MAX_ROUNDS {
        let start = width(&part, centre);
        let (found, ended) = narrowest(&part, centre, start);
        let (low, high) = radii(&part, found);
        let whole = width(points, found);
        if whole < best {
            (best, centre) = (whole, found);
        }
        if !ended || whole - (high - low) <= ZONE_ACCURACY * whole {
            break;
        }
        for stretch in points.chunks(points.len().div_ceil(STRETCHES)) {
            let (near, far) = ends(stretch, found);
            let outside = |p: &[f64; 2]| !(low..=high).contains(&radius(*p, found));
            part.extend([near, far].iter().filter(|p| outside(p)));
        }
    }
    best
}

/// Points for which the zone is searched at first.
const FIRST_POINTS: usize = 1000;
/// Stretches of all points whose nearest and farthest ones are added in each round.
const STRETCHES: usize = 64;
/// Most rounds of search and adding.
const MAX_ROUNDS: usize = 20;
/// Most strides of a search: some hundred lead to the centre of a circle; points along a line have no centre.
const MAX_STRIDES: usize = 2000;
/// Accuracy of the zone: strides end at this fraction of its width, and points outside by less are ignored.
const ZONE_ACCURACY: f64 = 1e-9;

fn radius(point: [f64; 2], centre: [f64; 2]) -> f64 {
    libm::hypot(point[0] - centre[0], point[1] - centre[1])
}

/// The least and the largest radius.
fn radii(points: &[[f64; 2]], centre: [f64; 2]) -> (f64, f64) {
    points
        .iter()
        .map(|p| radius(*p, centre))
        .fold((f64::INFINITY, 0.0), |(low, high), r| {
            (low.min(r), high.max(r))
        })
}

fn width(points: &[[f64; 2]], centre: [f64; 2]) -> f64 {
    let (low, high) = radii(points, centre);
    high - low
}

/// The nearest and the farthest point.
fn ends(points: &[[f64; 2]], centre: [f64; 2]) -> ([f64; 2], [f64; 2]) {
    let by_radius =
        |a: &&[f64; 2], b: &&[f64; 2]| radius(**a, centre).total_cmp(&radius(**b, centre));
    let near = points.iter().min_by(by_radius).copied();
    let far = points.iter().max_by(by_radius).copied();
    (near.unwrap_or(centre), far.unwrap_or(centre))
}

/// The centre of the least zone near one whose zone is `best` wide, and whether the search converged.
fn narrowest(points: &[[f64; 2]], mut centre: [f64; 2], mut best: f64) -> ([f64; 2], bool) {
    // The width is not smooth in the centre: directions are tried, and the stride is halved where none is better.
    let mut stride = best;
    let smallest = ZONE_ACCURACY * best;
    for _ in 0..MAX_STRIDES {
        // Also where the width is NaN.
        if stride.is_nan() || stride <= smallest {
            return (centre, true);
        }
        let tried = DIRECTIONS.map(|[x, y]| [centre[0] + stride * x, centre[1] + stride * y]);
        let mut next = None;
        for place in tried {
            let zone = width(points, place);
            if zone < best {
                (best, next) = (zone, Some(place));
            }
        }
        match next {
            Some(place) => centre = place,
            None => stride *= 0.5,
        }
    }
    (centre, false)
}

/// Directions that are tried, 30 degrees apart: along a crease of the width only few lead down.
const DIRECTIONS: [[f64; 2]; 12] = {
    /// cos 30°.
    const C: f64 = 0.866_025_403_784_438_6;
    [
        [1.0, 0.0],
        [C, 0.5],
        [0.5, C],
        [0.0, 1.0],
        [-0.5, C],
        [-C, 0.5],
        [-1.0, 0.0],
        [-C, -0.5],
        [-0.5, -C],
        [0.0, -1.0],
        [0.5, -C],
        [C, -0.5],
    ]
};
