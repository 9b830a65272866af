//! Numbers that carry their derivatives with respect to the nonlinear unknowns.

use crate::exponential::expm1;
use std::ops::{Add, Div, Mul, Sub};

/// A number and its derivatives with respect to `K` unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Dual<const K: usize> {
    pub value: f64,
    pub slope: [f64; K],
}

impl<const K: usize> Dual<K> {
    pub fn constant(value: f64) -> Self {
        Self {
            value,
            slope: [0.0; K],
        }
    }

    /// A number that depends on one unknown, if on any.
    pub fn new(value: f64, unknown: Option<usize>, slope: f64) -> Self {
        let mut out = Self::constant(value);
        if let Some(d) = unknown.and_then(|i| out.slope.get_mut(i)) {
            *d = slope;
        }
        out
    }

    #[inline(always)]
    fn with(self, value: f64, slope: impl Fn(usize) -> f64) -> Self {
        Self {
            value,
            slope: std::array::from_fn(slope),
        }
    }

    /// A function of this number: its value and derivative here.
    #[inline(always)]
    pub fn mapped(self, value: f64, derivative: f64) -> Self {
        self.with(value, |k| derivative * self.slope[k])
    }

    /// The same value, which depends on `on` with this derivative too.
    #[inline(always)]
    pub fn moved(self, on: Self, derivative: f64) -> Self {
        self.with(self.value, |k| self.slope[k] + derivative * on.slope[k])
    }

    #[inline(always)]
    pub fn scaled(self, by: f64) -> Self {
        self.mapped(self.value * by, by)
    }

    /// The number, or the constant `most` where it is larger.
    #[inline(always)]
    pub fn limited(self, most: f64) -> Self {
        if self.value < most {
            self
        } else {
            Self::constant(most)
        }
    }

    /// `exp(-a) - 1` of this number `a >= 0`, and `1 - (1 - exp(-a))/a`: the shares of a step and of a
    /// ramp that an exponential approach follows.
    #[inline(always)]
    pub fn relaxation(self) -> (Self, Self) {
        let a = self.value;
        let e = expm1(-a);
        let (follows, slope) = if a < 1e-2 {
            (
                a * (0.5 - a * (1.0 / 6.0 - a * (1.0 / 24.0 - a * (1.0 / 120.0 - a / 720.0)))),
                0.5 - a * (1.0 / 3.0 - a * (0.125 - a * (1.0 / 30.0 - a / 144.0))),
            )
        } else {
            let phi = -e / a;
            (1.0 - phi, (phi - (1.0 + e)) / a)
        };
        (self.mapped(e, -(1.0 + e)), self.mapped(follows, slope))
    }
}

impl<const K: usize> Add for Dual<K> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.with(self.value + other.value, |k| self.slope[k] + other.slope[k])
    }
}

impl<const K: usize> Sub for Dual<K> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.with(self.value - other.value, |k| self.slope[k] - other.slope[k])
    }
}

impl<const K: usize> Mul for Dual<K> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.scaled(other.value).moved(other, self.value)
    }
}

impl<const K: usize> Div for Dual<K> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let inverse = 1.0 / other.value;
        let value = self.value / other.value;
        self.with(value, |k| {
            (self.slope[k] - value * other.slope[k]) * inverse
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Dual;

    /// Derivatives against central differences, on both sides of the switch to the series.
    #[test]
    fn derivatives_match_differences() {
        for a in [1e-6, 3e-3, 9.9e-3, 1.01e-2, 0.3, 2.0, 40.0] {
            let at = |a: f64| {
                let x = Dual::<1>::new(a, Some(0), 1.0);
                let (e, follows) = x.relaxation();
                [e, follows, x / (Dual::constant(2.0) + x), x * x - x]
            };
            let h = 1e-6 * a;
            for (i, d) in at(a).iter().enumerate() {
                let numeric = (at(a + h)[i].value - at(a - h)[i].value) / (2.0 * h);
                let scale = numeric.abs().max(1e-6);
                assert!(
                    (d.slope[0] - numeric).abs() < 1e-5 * scale,
                    "{a} {i}: {numeric}"
                );
            }
        }
        let limited = Dual::<1>::new(3.0, Some(0), 1.0).limited(2.0);
        assert_eq!((limited.value, limited.slope), (2.0, [0.0]));
    }

    /// The share for a ramp against values with thirty digits (Python's `decimal`).
    #[test]
    fn a_short_relaxation_keeps_its_digits() {
        for (a, exact) in [
            (1e-9, 4.999999998333334e-10),
            (0.0099, 0.004933705349207228),
            (0.0101, 0.005033041175970429),
            (1.0, 0.36787944117144233),
        ] {
            let follows = Dual::<0>::constant(a).relaxation().1.value;
            assert!((follows / exact - 1.0).abs() < 1e-13, "{a}: {follows}");
        }
    }
}
