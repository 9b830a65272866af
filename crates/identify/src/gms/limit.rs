//! The slip limit of every element as it falls with speed.
//!
//! `s(v)/s(0) = (1 + (r - 1) exp(-|v/vs|^delta)) / r` with `r = Fs/Fc`: one at rest, so that yield
//! deflections and stiffnesses are those of slow motion whatever the Stribeck curve is.

use crate::law::{Law, Layout};
use libm::{exp, fabs, pow};

/// The nonlinear unknowns that all elements share, unpacked.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curve {
    /// Limit at rest in each direction over that in the positive one.
    scale: [f64; 2],
    /// `r - 1` of each direction.
    excess: [f64; 2],
    inverse_velocity: [f64; 2],
    exponent: f64,
    /// Rate at which a slipping element follows the limit, 1/s.
    pub attraction: f64,
}

impl Curve {
    pub fn new(law: &Law, layout: &Layout, p: &[f64]) -> Self {
        let read = |index: Option<usize>| index.map(|i| exp(p[i]));
        Self {
            scale: [1.0, read(layout.ratio).unwrap_or(1.0)],
            excess: layout.excess.map(|i| read(i).unwrap_or(0.0)),
            inverse_velocity: layout.velocity.map(|i| read(i).map_or(0.0, |v| 1.0 / v)),
            exponent: law.exponent,
            attraction: read(layout.attraction).unwrap_or(0.0),
        }
    }
}

/// The limit at one velocity, and its derivatives by the first `K` nonlinear unknowns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limit<const K: usize> {
    pub value: f64,
    pub slope: [f64; K],
}

/// The limit of the direction `side` (0 positive, 1 negative) at a velocity.
#[inline(always)]
pub(super) fn limit<const K: usize>(
    curve: &Curve,
    layout: &Layout,
    v: f64,
    side: usize,
) -> Limit<K> {
    let x = fabs(v) * curve.inverse_velocity[side];
    let power = if curve.exponent == 2.0 {
        x * x
    } else {
        pow(x, curve.exponent)
    };
    let (scale, excess) = (curve.scale[side], curve.excess[side]);
    let fall = exp(-power);
    let inverse = 1.0 / (1.0 + excess);
    let value = scale * (1.0 + excess * fall) * inverse;
    let mut slope = [0.0; K];
    if K > 0 {
        if let Some(i) = layout.excess[side] {
            slope[i] = scale * excess * (fall - 1.0) * inverse * inverse;
        }
        if let Some(i) = layout.velocity[side] {
            // 0 * inf at extreme speeds is a limit that no longer depends on vs.
            slope[i] = if fall == 0.0 {
                0.0
            } else {
                scale * excess * fall * curve.exponent * power * inverse
            };
        }
        if side == 1
            && let Some(i) = layout.ratio
        {
            slope[i] = value;
        }
    }
    Limit { value, slope }
}
