//! EXPLIN: the step for recorded velocities.

use crate::{LuGre, Real};

impl<T: Real> LuGre<T> {
    /// Deflection at the end of an interval of `h` seconds over which the velocity went from `va` to `vb` (m/s, rad/s),
    /// starting from `z` (m, rad).
    ///
    /// Second order, one pass, unconditionally bounded. In path length `s` the law reads `dz/ds = sgn v - sigma0 z/g`;
    /// the step takes the exponential of the interval's mean `A = integral of sigma0|v|/g` and lets the steady
    /// deflection run linearly from its value at `va` to that at `vb`. The result is a convex combination of `z` and
    /// these two, so `|z| <= bound()` is kept for every stiffness and step; nothing is clamped. Where the velocity
    /// changes sign the interval is split at its zero.
    ///
    /// `h <= 0` leaves `z` as it is; a NaN in `va` or `vb` gives NaN (records have to be cleaned before).
    #[inline]
    pub fn step_record(&self, z: T, h: T, va: T, vb: T) -> T {
        let rises = va < T::ZERO && vb > T::ZERO;
        if rises || (va > T::ZERO && vb < T::ZERO) {
            // Each part has its own quotient: `1 - theta` would lose digits where the second part is short.
            let theta = va / (va - vb);
            let turn = self.one_way(!rises, z, theta * h, va.abs(), T::ZERO);
            self.one_way(rises, turn, vb / (vb - va) * h, T::ZERO, vb.abs())
        } else {
            self.one_way(va > T::ZERO || vb > T::ZERO, z, h, va.abs(), vb.abs())
        }
    }

    #[inline]
    fn one_way(&self, positive: bool, z: T, h: T, speed_a: T, speed_b: T) -> T {
        // This also avoids 0 times infinity in the exponent.
        if h <= T::ZERO {
            return z;
        }
        let curve = self.curve();
        let ga = curve.level_on(positive, speed_a);
        let gb = curve.level_on(positive, speed_b);
        let a = h * (self.stiffness() * (T::from_f64(0.5) * (speed_a / ga + speed_b / gb)));
        let steady = |g: T| {
            if positive {
                g / self.stiffness()
            } else {
                -g / self.stiffness()
            }
        };
        let (za, zb) = (steady(ga), steady(gb));
        let e = (-a).expm1();
        // As an increment: for small a the sum of weighted terms would lose the digits that matter.
        z + ((z - za) * e + (zb - za) * one_plus_ratio(a, e))
    }
}

/// `1 + e/a` for `e = expm1(-a)`, `a >= 0`: the fraction of the linear course that the deflection follows, in 0..1.
#[inline]
pub(crate) fn one_plus_ratio<T: Real>(a: T, e: T) -> T {
    if a >= T::SERIES_BELOW {
        return T::ONE + e / a;
    }
    let c = |x: f64| T::from_f64(x);
    let tail = c(1.0 / 24.0) - a * (c(1.0 / 120.0) - a * (c(1.0 / 720.0) - a * c(1.0 / 5040.0)));
    a * (c(0.5) - a * (c(1.0 / 6.0) - a * tail))
}

#[cfg(test)]
mod tests {
    use super::one_plus_ratio;

    /// Against 1 + (exp(-a) - 1)/a in sixty decimal digits (Python's `decimal`), on both sides of either type's switch to
    /// the series.
    #[test]
    fn ratio_keeps_its_digits() {
        let exact: [(f64, f64); 8] = [
            (1e-9, 4.999999998333334e-10),
            (1e-4, 4.999833337499917e-05),
            (0.0099, 0.004933705349207228),
            (0.0101, 0.005033041175970429),
            (0.19, 0.08925859970190693),
            (0.21, 0.09802021890565285),
            (1.0, 0.36787944117144233),
            (30.0, 0.9666666666666698),
        ];
        for (a, r) in exact {
            let got = one_plus_ratio(a, libm::expm1(-a));
            assert!((got / r - 1.0).abs() < 1e-13, "{a}: {got} {r}");
            let small = a as f32;
            let got = one_plus_ratio(small, libm::expm1f(-small));
            assert!(
                (f64::from(got) / r - 1.0).abs() < 3e-6,
                "f32 {a}: {got} {r}"
            );
        }
    }
}
