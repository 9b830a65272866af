//! The step of [`curve`](crate::curve) with its derivatives with respect to `ln kappa`, `ln(Fs/Fc - 1)` and
//! `ln vs`.
//!
//! With `W = dw/dp` and `M = exp(-A) w + (gb - ga) d mean/dA` the derivatives follow the same recursion:
//!
//! ```text
//! W+ = exp(-A) W - (dgb/dp - dga/dp) mean - M dA/dp
//! ```

use crate::curve::{Curve, SUBNORMAL_GUARD, Speed};
use crate::exp::{LONGEST_DECAY, at_least, decays, exp, fma};

/// Unknowns of the trial.
pub(crate) const UNKNOWNS: usize = 3;

/// Lower limit of the exponents in the Stribeck curve: there the excess is below the rounding of the level,
/// and its square is still a normal number.
pub(crate) const LOWEST_STRIBECK_EXPONENT: f64 = -80.0;

/// A node: its level, speed over level, and the derivatives of the level; `kappa` has none.
#[derive(Clone, Copy)]
pub(crate) struct Node {
    pub g: f64,
    /// `v/g`.
    pub q: f64,
    /// `dg/dp` for `ln(Fs/Fc - 1)` and `ln vs`.
    pub slope: [f64; 2],
    /// The same over g.
    pub relative: [f64; 2],
}

impl Node {
    /// Before the first node: unloaded.
    pub const START: [f64; 6] = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0];

    #[inline(always)]
    pub fn to_array(self) -> [f64; 6] {
        let ([a, b], [c, d]) = (self.slope, self.relative);
        [self.g, self.q, a, b, c, d]
    }

    #[inline(always)]
    pub fn from_array([g, q, a, b, c, d]: [f64; 6]) -> Self {
        Node {
            g,
            q,
            slope: [a, b],
            relative: [c, d],
        }
    }
}

/// An interval: `w+ = keep w + add`, `W+ = keep W + add_slope - (keep w + bend) length_slope`.
#[derive(Clone, Copy)]
pub(crate) struct Interval {
    pub keep: f64,
    pub add: f64,
    pub bend: f64,
    /// `dA/dp` for each unknown.
    pub length_slope: [f64; UNKNOWNS],
    /// For `ln(Fs/Fc - 1)` and `ln vs`.
    pub add_slope: [f64; 2],
}

impl Interval {
    #[inline(always)]
    pub fn to_array(self) -> [f64; 8] {
        let ([a, b, c], [d, e]) = (self.length_slope, self.add_slope);
        [self.keep, self.add, self.bend, a, b, c, d, e]
    }

    #[inline(always)]
    pub fn from_array([keep, add, bend, a, b, c, d, e]: [f64; 8]) -> Self {
        Interval {
            keep,
            add,
            bend,
            length_slope: [a, b, c],
            add_slope: [d, e],
        }
    }
}

/// Two nodes with one division.
#[inline(always)]
pub(crate) fn nodes<const POWER: bool>(curve: &Curve, v: [Speed; 2]) -> [Node; 2] {
    let exponent = |v: Speed| at_least(curve.exponent::<POWER>(v), LOWEST_STRIBECK_EXPONENT);
    let exponents = [exponent(v[0]), exponent(v[1])];
    let falls = [
        curve.excess * exp(exponents[0]),
        curve.excess * exp(exponents[1]),
    ];
    let levels = [1.0 + falls[0], 1.0 + falls[1]];
    let inverse = 1.0 / (levels[0] * levels[1]);
    let node = |i: usize| {
        let over = levels[1 - i] * inverse;
        let slope = [falls[i], falls[i] * (-curve.exponent * exponents[i])];
        Node {
            g: levels[i],
            q: v[i].value * over,
            slope,
            relative: [slope[0] * over, slope[1] * over],
        }
    };
    [node(0), node(1)]
}

/// Two intervals with one division, each between two nodes; half steps in s.
#[inline(always)]
pub(crate) fn intervals(curve: &Curve, half: [f64; 2], ends: [[Node; 2]; 2]) -> [Interval; 2] {
    let scale = [half[0] * curve.rate, half[1] * curve.rate];
    let x = |i: usize| at_least(scale[i] * (ends[i][0].q + ends[i][1].q), LONGEST_DECAY);
    let x = [x(0), x(1)];
    let decays = decays(x);
    let interval = |i: usize| {
        let [a, b] = ends[i];
        let decay = decays[i];
        let fall = a.g - b.g;
        let length = |k: usize| scale[i] * fma(a.q, a.relative[k], b.q * b.relative[k]);
        Interval {
            keep: decay.keep,
            add: fma(fall, decay.mean, SUBNORMAL_GUARD),
            bend: -(fall * decay.slope),
            length_slope: [-x[i], length(0), length(1)],
            add_slope: [
                fma(a.slope[0] - b.slope[0], decay.mean, SUBNORMAL_GUARD),
                fma(a.slope[1] - b.slope[1], decay.mean, SUBNORMAL_GUARD),
            ],
        }
    };
    [interval(0), interval(1)]
}

/// What the recursion adds to `keep W`.
#[inline(always)]
pub(crate) fn slope_adds(w: f64, step: &Interval) -> [f64; UNKNOWNS] {
    let moved = fma(step.keep, w, step.bend);
    [
        fma(-moved, step.length_slope[0], SUBNORMAL_GUARD),
        fma(-moved, step.length_slope[1], step.add_slope[0]),
        fma(-moved, step.length_slope[2], step.add_slope[1]),
    ]
}

/// Columns that a trial makes: eta, what the micro-damping multiplies, and the derivatives of either.
pub const OWN: usize = 2 + 2 * UNKNOWNS;

/// The columns at a node with deviation `w` and its derivatives, in the direction of motion.
#[inline(always)]
pub(crate) fn columns(node: &Node, speed: f64, w: f64, w_slope: [f64; UNKNOWNS]) -> [f64; OWN] {
    let eta = w + node.g;
    let slope = [
        w_slope[0],
        w_slope[1] + node.slope[0],
        w_slope[2] + node.slope[1],
    ];
    let rate = |k: usize| node.q * fma(node.relative[k - 1], eta, -slope[k]);
    [
        eta,
        fma(-node.q, eta, speed),
        slope[0],
        slope[1],
        slope[2],
        -(node.q * slope[0]),
        rate(1),
        rate(2),
    ]
}
