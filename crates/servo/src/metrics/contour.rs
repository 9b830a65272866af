//! How well two axes kept to a contour.

use super::root_mean;
use crate::two_axes::PlaneSample;

/// Deviation from the contour, across it; m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contour {
    /// Rms deviation.
    pub rms: f64,
    /// Largest deviation either way.
    pub peak: f64,
}

impl Contour {
    /// Of the samples given; none give zeros.
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
/// finite; fewer give 0.
pub fn circular_deviation(points: &[[f64; 2]]) -> f64 {
    if points.len() < 3 {
        return 0.0;
    }
    let zone = |centre: [f64; 2]| {
        let radii = points
            .iter()
            .map(|p| libm::hypot(p[0] - centre[0], p[1] - centre[1]));
        let (least, largest) = radii.fold((f64::INFINITY, 0.0_f64), |(low, high), r| {
            (low.min(r), high.max(r))
        });
        largest - least
    };
    let n = points.len() as f64;
    let sum = points
        .iter()
        .fold([0.0; 2], |s, p| [s[0] + p[0], s[1] + p[1]]);
    let mut centre = sum.map(|s| s / n);
    let mut best = zone(centre);
    // The width is not smooth in the centre: directions are tried, and the stride is halved where none is better.
    let mut stride = best;
    let smallest = 1e-9 * best;
    while stride > smallest {
        let tried = DIRECTIONS.map(|[x, y]| [centre[0] + stride * x, centre[1] + stride * y]);
        let widths = tried.map(zone);
        let mut next = None;
        for (place, width) in tried.into_iter().zip(widths) {
            if width < best {
                (best, next) = (width, Some(place));
            }
        }
        match next {
            Some(place) => centre = place,
            None => stride *= 0.5,
        }
    }
    best
}

/// Twelve, 30 degrees apart: along a crease of the width few directions lead down.
const DIRECTIONS: [[f64; 2]; 12] = {
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
