//! How fast a bristle approaches its steady deflection: the function alpha, and the motion at a held velocity.
//!
//! With `e = 1 - z/z_ss` and the path in units of `g/sigma0` as the variable `a`, the state equation reads
//! `de/da = -(1 - alpha (1 - e)) = -m(e) e`. The pull m is 1/e in the elastic range (`e >= 1 - breakaway`), 1 beyond the
//! steady deflection (`e <= 0`), continuous, and never below 1: e keeps its sign and only shrinks. LuGre is m = 1.

use crate::Real;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plasticity<T> {
    /// `1 - breakaway`: the e at which slip begins.
    pub width: T,
    /// `pi/2` over the width.
    turn: T,
}

impl<T: Real> Plasticity<T> {
    pub fn new(breakaway: T) -> Self {
        let width = T::ONE - breakaway;
        Plasticity {
            width,
            turn: T::from_f64(core::f64::consts::FRAC_PI_2) / width,
        }
    }

    /// alpha at `e`: Dupont's `sin(...)/2 + 1/2` is `1 - sin^2(turn e)`.
    #[inline]
    pub fn share(&self, e: T) -> T {
        if e >= self.width {
            T::ZERO
        } else if e <= T::ZERO {
            T::ONE
        } else {
            let s = (self.turn * e).sin();
            T::ONE - s * s
        }
    }

    /// The pull m at `e`.
    #[inline]
    pub fn pull(&self, e: T) -> T {
        if e >= self.width {
            T::ONE / e
        } else if e <= T::ZERO {
            T::ONE
        } else {
            let s = (self.turn * e).sin();
            T::ONE + (T::ONE - e) * s * (s / e)
        }
    }

    /// The pull and its derivative with respect to `e`.
    #[inline]
    fn pull_and_slope(&self, e: T) -> (T, T) {
        if e >= self.width {
            (T::ONE / e, -T::ONE / (e * e))
        } else if e <= T::ZERO {
            (T::ONE, T::ZERO)
        } else {
            let s = (self.turn * e).sin();
            let c = (T::ONE - s * s).max(T::ZERO).sqrt();
            let r = s / e;
            let rest = T::ONE - e;
            (
                T::ONE + rest * s * r,
                r * (T::from_f64(2.0) * self.turn * rest * c - r),
            )
        }
    }

    /// `e` after the path `a`, and its derivative; the arguments are pairs of a value and its derivative.
    ///
    /// The end of the elastic range is computed exactly; in the rest `ln e` takes one classical Runge-Kutta step,
    /// fourth order. Its weights are positive and so is m: the result lies between 0 and `e` for every path.
    pub fn held(&self, e: (T, T), a: (T, T)) -> (T, T) {
        let ((mut e, mut e_slope), (mut a, mut a_slope)) = (e, a);
        if e > self.width {
            if e - a >= self.width {
                return (e - a, e_slope - a_slope);
            }
            a = a - (e - self.width);
            a_slope = a_slope - e_slope;
            (e, e_slope) = (self.width, T::ZERO);
        }
        // e after a part of the path at the pull m, and its derivative.
        let after = |part: T, m: (T, T)| {
            let fall = (-(part * a * m.0)).exp();
            // Where e is 0 so is its derivative; computing it could be 0 times infinity.
            if fall == T::ZERO {
                return (T::ZERO, T::ZERO);
            }
            let exponent_slope = part * (a_slope * m.0 + a * m.1);
            (e * fall, fall * (e_slope - e * exponent_slope))
        };
        let at = |(e, slope): (T, T)| {
            let (m, by_e) = self.pull_and_slope(e);
            (m, by_e * slope)
        };
        let half = T::from_f64(0.5);
        let m1 = at((e, e_slope));
        let m2 = at(after(half, m1));
        let m3 = at(after(half, m2));
        let m4 = at(after(T::ONE, m3));
        after(
            T::ONE,
            (mean(m1.0, m2.0, m3.0, m4.0), mean(m1.1, m2.1, m3.1, m4.1)),
        )
    }
}

/// The mean of the four stages of a classical Runge-Kutta step.
#[inline]
pub(super) fn mean<T: Real>(m1: T, m2: T, m3: T, m4: T) -> T {
    (m1 + T::from_f64(2.0) * (m2 + m3) + m4) / T::from_f64(6.0)
}
