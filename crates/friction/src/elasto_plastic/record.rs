//! The step for recorded velocities: EXPLIN with the pull of the elasto-plastic law.

use super::ElastoPlastic;
use super::plasticity::mean;
use crate::Real;
use crate::record::one_plus_ratio;

impl<T: Real> ElastoPlastic<T> {
    /// Deflection at the end of an interval of `h` seconds over which the velocity went from `va` to `vb` (m/s, rad/s),
    /// starting from `z` (m, rad).
    ///
    /// Second order, one pass, unconditionally bounded. Below break-away the deflection moves by exactly the path
    /// `h (|va| + |vb|)/2`, and the end of that range is placed inside the interval. Beyond, the law is LuGre's in a path
    /// stretched by the pull of the bristle, whose mean over the interval comes from four stages; each stage, and the
    /// result, is a convex combination of `z` and the steady deflections at both ends, so `|z| <= bound()` is kept for
    /// every stiffness and step. Where the velocity changes sign the interval is split at its zero.
    ///
    /// `h <= 0` leaves `z` as it is; a NaN in `va` or `vb` gives NaN (records have to be cleaned before).
    #[inline]
    pub fn step_record(&self, z: T, h: T, va: T, vb: T) -> T {
        let rises = va < T::ZERO && vb > T::ZERO;
        if rises || (va > T::ZERO && vb < T::ZERO) {
            let theta = va / (va - vb);
            let turn = self.one_way(!rises, z, theta * h, va.abs(), T::ZERO);
            self.one_way(rises, turn, vb / (vb - va) * h, T::ZERO, vb.abs())
        } else {
            self.one_way(va > T::ZERO || vb > T::ZERO, z, h, va.abs(), vb.abs())
        }
    }

    #[inline]
    fn one_way(&self, positive: bool, z: T, h: T, speed_a: T, speed_b: T) -> T {
        if h <= T::ZERO {
            return z;
        }
        let half = T::from_f64(0.5);
        let curve = self.bristle.curve();
        let stiffness = self.bristle.stiffness();
        let ga = curve.level_on(positive, speed_a);
        let gb = curve.level_on(positive, speed_b);
        let way = Way {
            path: h * (half * speed_a + half * speed_b),
            stretched: h * (stiffness * (half * (speed_a / ga + speed_b / gb))),
            from: ga / stiffness,
            to: gb / stiffness,
        };
        if positive {
            z + self.along(z, way)
        } else {
            z - self.along(-z, way)
        }
    }

    /// Change of the deflection over a distance, both counted in the direction of motion.
    #[inline]
    pub(super) fn along(&self, start: T, mut way: Way<T>) -> T {
        // A speed beyond any machine's may take it to infinity, which times a pull of 0 is no number.
        way.stretched = way.stretched.min(T::MAX);
        let (begin, end) = (self.breakaway * way.from, self.breakaway * way.to);
        let mut z = start;
        if z <= begin {
            if z + way.path <= end {
                return way.path;
            }
            // Both z and its limit run linearly along the path.
            let part = (begin - z) / (way.path - (end - begin));
            way.from = way.from + part * (way.to - way.from);
            way.stretched = (T::ONE - part) * way.stretched;
            z = self.breakaway * way.from;
        }
        if z >= way.from && way.to <= way.from {
            // Beyond the steady deflection throughout: LuGre, the pull would be 1 in every stage.
            return (z - start) + way.change(z, T::ONE, T::ONE);
        }
        let half = T::from_f64(0.5);
        // The pull after a part of the distance, if it was `m` on that part.
        let pull = |part: T, m: T| {
            let steady = way.from + part * (way.to - way.from);
            let z = z + way.change(z, part, m);
            self.plasticity.pull((steady - z) / steady)
        };
        let m1 = pull(T::ZERO, T::ONE);
        let m2 = pull(half, m1);
        let m3 = pull(half, m2);
        let m4 = pull(T::ONE, m3);
        (z - start) + way.change(z, T::ONE, mean(m1, m2, m3, m4))
    }
}

/// A stretch of motion in one direction.
#[derive(Clone, Copy)]
pub(super) struct Way<T> {
    /// Its length, m (rad).
    pub path: T,
    /// The integral of `sigma0 |v|/g`.
    pub stretched: T,
    /// Steady deflection at its beginning, m (rad).
    pub from: T,
    /// Steady deflection at its end, m (rad).
    pub to: T,
}

impl<T: Real> Way<T> {
    /// Change of the deflection over a part of the distance at the pull `m`.
    #[inline]
    fn change(&self, z: T, part: T, m: T) -> T {
        // This also avoids 0 times infinity in the exponent.
        if part == T::ZERO {
            return T::ZERO;
        }
        let a = part * self.stretched * m;
        let e = (-a).expm1();
        (z - self.from) * e + part * (self.to - self.from) * one_plus_ratio(a, e)
    }
}
