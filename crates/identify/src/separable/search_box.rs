//! Where the nonlinear unknowns are looked for.

use crate::conditioning::record::Record;
use crate::error::Error;
use crate::law::{Law, Layout};
use stiction_search::descent::Region;

/// Longest delay between force and motion that is looked for, either way, in samples.
pub(crate) const MOST_DELAY: f64 = 4.0;

/// Longest presliding length that is looked for, in strokes: a bristle of that length is a spring all along one of them.
const LONGEST: f64 = 10.0;

/// Bounds of the nonlinear unknowns, in logarithms and in the order of the law.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchBox {
    low: Vec<f64>,
    high: Vec<f64>,
}

/// Bounds in physical units from which a [`SearchBox`] is made; the same for both directions.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ranges {
    /// Presliding length Fc/s0, m or rad.
    length: (f64, f64),
    /// Fs/Fc - 1.
    excess: (f64, f64),
    /// Stribeck velocity, m/s or rad/s.
    velocity: (f64, f64),
    /// Fc- / Fc+, or Fs- / Fs+.
    ratio: (f64, f64),
    /// Break-away part of the steady deflection, as the odds b/(1 - b).
    breakaway: (f64, f64),
    /// Rate at which a slipping Maxwell-slip element follows the Stribeck curve, 1/s.
    attraction: (f64, f64),
    /// Stribeck exponent.
    exponent: (f64, f64),
}

impl SearchBox {
    /// A box around given nonlinear unknowns, reaching `decades` to each side.
    pub fn around(p: &[f64], decades: f64) -> Self {
        let reach = decades * std::f64::consts::LN_10;
        Self {
            low: p.iter().map(|x| x - reach).collect(),
            high: p.iter().map(|x| x + reach).collect(),
        }
    }

    /// A box between bounds in the order of the law, each lower one first.
    pub fn between(low: Vec<f64>, high: Vec<f64>) -> Self {
        debug_assert!(low.len() == high.len() && low.iter().zip(&high).all(|(a, b)| a <= b));
        Self { low, high }
    }

    /// The box that the record itself allows: the presliding length between one count of the encoder
    /// (or a thousandth of the longest step) and ten strokes, the Stribeck velocity between
    /// 1e-4 of the top speed and the top speed, `Fs/Fc - 1` from .02 to 3, a Stribeck exponent that is
    /// fitted from .3 to 4, the break-away part of an elasto-plastic law from .02 to .98. The yield
    /// deflections of a Maxwell-slip law lie where the presliding length does, up to half the stroke.
    pub fn from_record(record: &Record, law: &Law) -> Result<Self, Error> {
        let top = record.top_speed();
        let stroke = record.stroke();
        if !(top > 0.0 && stroke > 0.0 && top.is_finite()) {
            return Err(Error::NoMotion {
                bound: top,
                unit: "",
            });
        }
        let longest = LONGEST * stroke;
        let step = record
            .segments
            .iter()
            .map(|s| s.step)
            .fold(f64::INFINITY, f64::min);
        let finest = record.resolution.unwrap_or(1e-3 * top * step);
        let ranges = Ranges {
            length: (finest.clamp(1e-6 * stroke, 0.1 * stroke), longest),
            excess: (0.02, 3.0),
            velocity: (1e-4 * top, top),
            ratio: (0.1, 10.0),
            breakaway: (0.02 / 0.98, 0.98 / 0.02),
            // Rate from one over the time of a stroke to one over a sample time.
            attraction: (1.0 / (stroke / top).max(100.0 * step), 1.0 / step),
            exponent: (0.3, 4.0),
        };
        let layout = law.layout();
        let mut low = vec![0.0; layout.count];
        let mut high = vec![0.0; layout.count];
        let mut set = |index: Option<usize>, (a, b): (f64, f64)| {
            if let Some(i) = index {
                low[i] = libm::log(a);
                high[i] = libm::log(b);
            }
        };
        set(layout.kappa, (1.0 / ranges.length.1, 1.0 / ranges.length.0));
        for side in 0..2 {
            set(layout.excess[side], ranges.excess);
            set(layout.velocity[side], ranges.velocity);
        }
        set(layout.ratio, ranges.ratio);
        set(layout.breakaway, ranges.breakaway);
        set(layout.attraction, ranges.attraction);
        for i in layout.yields() {
            // An element that yields after more than half the stroke is not certain to slip.
            set(Some(i), (ranges.length.0, 0.5 * stroke));
        }
        set(layout.exponent, ranges.exponent);
        Ok(Self { low, high })
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.low.len()
    }

    /// Whether there are no unknowns.
    pub fn is_empty(&self) -> bool {
        self.low.is_empty()
    }

    /// Lower bound of an unknown.
    pub fn low(&self, i: usize) -> f64 {
        self.low[i]
    }

    /// Upper bound of an unknown.
    pub fn high(&self, i: usize) -> f64 {
        self.high[i]
    }

    /// The box of the symmetric law inside that of an asymmetric one: its positive direction.
    pub(crate) fn symmetric(&self, layout: &Layout) -> Self {
        let own = [
            layout.kappa,
            layout.excess[0],
            layout.velocity[0],
            layout.breakaway,
            layout.exponent,
        ];
        let pick = |x: &[f64]| own.iter().flatten().map(|&i| x[i]).collect();
        Self {
            low: pick(&self.low),
            high: pick(&self.high),
        }
    }

    /// The same box with the delay as its last unknown.
    pub(crate) fn with_delay(&self) -> Self {
        let mut out = self.clone();
        out.low.push(-MOST_DELAY);
        out.high.push(MOST_DELAY);
        out
    }

    /// The same box without one unknown.
    pub(crate) fn without(&self, i: usize) -> Self {
        let mut out = self.clone();
        out.low.remove(i);
        out.high.remove(i);
        out
    }

    /// The same box with one unknown held at a value.
    pub(crate) fn holding(&self, i: usize, value: f64) -> Self {
        let mut out = self.clone();
        out.low[i] = value;
        out.high[i] = value;
        out
    }

    /// The same as a descent sees it.
    pub(crate) fn region(&self) -> Region<'_> {
        Region {
            low: &self.low,
            high: &self.high,
        }
    }

    /// The nearest point inside.
    pub fn clamp(&self, p: &[f64]) -> Vec<f64> {
        self.region().clamp(p)
    }

    /// The point at a place in the unit cube.
    pub fn at(&self, unit: &[f64]) -> Vec<f64> {
        unit.iter()
            .enumerate()
            .map(|(i, x)| self.low[i] + x * (self.high[i] - self.low[i]))
            .collect()
    }

    /// Whether an unknown stands at one of its bounds.
    pub fn at_bound(&self, p: &[f64], i: usize) -> bool {
        let tolerance = 1e-6 * (self.high[i] - self.low[i]);
        p[i] - self.low[i] <= tolerance || self.high[i] - p[i] <= tolerance
    }
}
