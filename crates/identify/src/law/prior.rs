//! What is known of the bristle and the Stribeck curve of any machine before its log.
//!
//! Normal densities in the logarithm, as weak as they can be and still keep an unknown that a log does not show from running off with
//! the others. A log weighs against them as its residual is correlated: `variance` is that of an independent sample.

use crate::conditioning::record::Record;
use crate::law::{Law, Layout};
use crate::scatter::strokes::Strokes;
use stiction_search::Derivatives;

/// Presliding length: from two counts of the encoder (without one a thousandth of a stroke) to a tenth of a stroke, three deviations
/// in all, but at least this one.
const COUNTS: f64 = 2.0;
const SHORTEST: f64 = 1e-3;
const LONGEST: f64 = 0.1;
const LEAST_DEVIATION: f64 = 1.0;
/// Fs/Fc - 1 and its deviation: .15 to .6, as published LuGre parameters of guides, screws and gears have it.
const RISE: (f64, f64) = (0.3, 0.7);
/// Stribeck velocity in parts of the top speed, and its deviation.
const VELOCITY: (f64, f64) = (0.05, 1.0);

/// Mean and deviation of the logarithms of three quantities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// `kappa`, the inverse of the presliding length, 1/m or 1/rad.
    kappa: (f64, f64),
    /// `Fs/Fc - 1`, for positive and negative velocity.
    rise: [(f64, f64); 2],
    /// Stribeck velocity, m/s or rad/s, for each.
    velocity: [(f64, f64); 2],
    /// Square of the residual that counts as one independent sample, in the square of the unit of the force.
    variance: f64,
}

impl Prior {
    /// Of a record with these strokes.
    pub(crate) fn of(record: &Record, strokes: &Strokes, variance: f64) -> Self {
        let stroke = strokes.usual_length();
        let counts = record.resolution.map(|step| COUNTS * step);
        let shortest = counts.unwrap_or(SHORTEST * stroke);
        let longest = (LONGEST * stroke).max(shortest * std::f64::consts::E);
        let range = libm::log(longest / shortest);
        Self {
            kappa: (
                -0.5 * (libm::log(shortest) + libm::log(longest)),
                (range / 3.0).max(LEAST_DEVIATION),
            ),
            rise: [(libm::log(RISE.0), RISE.1); 2],
            velocity: [(libm::log(VELOCITY.0 * strokes.top), VELOCITY.1); 2],
            variance,
        }
    }

    /// Mean and deviation of the logarithm of the inverse of the presliding length.
    pub(crate) fn kappa(&self) -> (f64, f64) {
        self.kappa
    }

    /// What is known of each nonlinear unknown of a law: its place, mean and deviation.
    fn known(&self, layout: Layout) -> impl Iterator<Item = (usize, f64, f64)> {
        let [excess, other] = layout.excess;
        let [velocity, slower] = layout.velocity;
        let each = [
            (layout.kappa, self.kappa),
            (excess, self.rise[0]),
            (other.filter(|_| other != excess), self.rise[1]),
            (velocity, self.velocity[0]),
            (slower.filter(|_| slower != velocity), self.velocity[1]),
        ];
        // Elements have slip lengths and a curve of their own.
        each.into_iter()
            .filter(move |_| layout.yields == 0)
            .filter_map(|(at, (mean, deviation))| Some((at?, mean, deviation)))
            .filter(|(_, mean, deviation)| mean.is_finite() && deviation.is_finite())
    }

    /// The same for the unknowns of one law, as its costs count it.
    pub(crate) fn beside(&self, law: &Law) -> Beside {
        let known = self.known(law.layout());
        let each = known.map(|(at, mean, deviation)| Known {
            at,
            mean,
            information: 1.0 / (deviation * deviation),
        });
        Beside {
            variance: self.variance,
            known: each.collect(),
        }
    }

    /// Whether anything is known of a law.
    pub(crate) fn is_of(&self, law: &Law) -> bool {
        self.known(law.layout()).next().is_some()
    }

    /// As surely known, about these unknowns of a law.
    pub(crate) fn about(&self, law: &Law, p: &[f64]) -> Self {
        let layout = law.layout();
        let at = |i: Option<usize>, before: (f64, f64)| match i {
            Some(i) => (p[i], before.1),
            None => before,
        };
        Self {
            kappa: at(layout.kappa, self.kappa),
            rise: layout.excess.map(|i| at(i, self.rise[0])),
            velocity: layout.velocity.map(|i| at(i, self.velocity[0])),
            variance: self.variance,
        }
    }

    /// The unknowns of a law with Stribeck curves as they are expected.
    pub(crate) fn expected(&self, law: &Law, p: &[f64]) -> Vec<f64> {
        let layout = law.layout();
        let mut out = p.to_vec();
        for (at, mean, _) in self.known(layout) {
            if Some(at) != layout.kappa {
                out[at] = mean;
            }
        }
        out
    }
}

/// What a prior adds to the cost of the unknowns of a law.
#[derive(Clone, Debug, Default)]
pub(crate) struct Beside {
    variance: f64,
    known: Vec<Known>,
}

/// What is known of one unknown.
#[derive(Clone, Copy, Debug)]
struct Known {
    at: usize,
    mean: f64,
    information: f64,
}

impl Beside {
    /// Added cost.
    pub fn cost(&self, p: &[f64]) -> f64 {
        let off = |known: &Known| p[known.at] - known.mean;
        let each = self.known.iter();
        each.map(|known| self.variance * known.information * off(known) * off(known))
            .sum()
    }

    /// Place of each unknown, its added weight, and its pull towards the mean.
    pub fn pulls(&self, p: &[f64]) -> impl Iterator<Item = (usize, f64, f64)> {
        self.known.iter().map(|known| {
            let weight = self.variance * known.information;
            (known.at, weight, weight * (known.mean - p[known.at]))
        })
    }

    /// A reduced problem with it.
    pub fn add(&self, p: &[f64], mut to: Derivatives) -> Derivatives {
        to.cost += self.cost(p);
        let unknowns = to.gradient.len();
        for (i, weight, pull) in self.pulls(p) {
            to.gradient[i] -= pull;
            to.normal[i * unknowns + i] += weight;
        }
        to
    }

    /// Place of each unknown, and the inverse of its variance.
    pub fn information(&self) -> impl Iterator<Item = (usize, f64)> {
        self.known.iter().map(|known| (known.at, known.information))
    }
}
