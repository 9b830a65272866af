//! The step for recorded velocities, with the events inside it.

use super::{Element, Elements, Gms};
use crate::Real;
use crate::record::one_plus_ratio;

impl<T: Real, const N: usize> Gms<T, N> {
    /// The elements at the end of an interval of `h` seconds over which the velocity went linearly from `va` to `vb`
    /// (m/s, rad/s).
    ///
    /// Second order, one pass, bounded: no element exceeds its share of the static level. An element that sticks moves by
    /// exactly `k_i h (va + vb)/2`; where it reaches its limit (taken as linear in time) it slips for the rest of the
    /// interval, by the exponential of the interval's `integral of C/g` with its limit running linearly. Where the
    /// velocity changes sign the interval is split at its zero, and there all elements stick. Exact for a held velocity.
    ///
    /// `h <= 0` leaves the elements as they are; a NaN in `va` or `vb` gives NaN (records have to be cleaned before).
    pub fn step_record(&self, from: Elements<T, N>, h: T, va: T, vb: T) -> Elements<T, N> {
        if h <= T::ZERO {
            return from;
        }
        let rises = va < T::ZERO && vb > T::ZERO;
        if rises || (va > T::ZERO && vb < T::ZERO) {
            let theta = va / (va - vb);
            let turn = self.one_way(!rises, from, theta * h, va.abs(), T::ZERO);
            self.one_way(rises, turn, vb / (vb - va) * h, T::ZERO, vb.abs())
        } else {
            self.one_way(va > T::ZERO || vb > T::ZERO, from, h, va.abs(), vb.abs())
        }
    }

    pub(super) fn one_way(
        &self,
        forward: bool,
        mut at: Elements<T, N>,
        h: T,
        speed_a: T,
        speed_b: T,
    ) -> Elements<T, N> {
        let rests = speed_a == T::ZERO && speed_b == T::ZERO;
        if rests || at.forward != forward {
            at.slips = [false; N];
        }
        if rests || h <= T::ZERO {
            return at;
        }
        at.forward = forward;
        let run = Run {
            h,
            speed: (speed_a, speed_b),
            level: (
                self.curve.level_on(forward, speed_a),
                self.curve.level_on(forward, speed_b),
            ),
            attraction: self.attraction,
        };
        for i in 0..N {
            let along = if forward { at.force[i] } else { -at.force[i] };
            let (end, slips) = run.element(&self.elements[i], along, at.slips[i]);
            at.force[i] = if forward { end } else { -end };
            // At rest every element sticks.
            at.slips[i] = slips && speed_b != T::ZERO;
        }
        at
    }
}

/// A stretch of motion in one direction: the same for all elements.
struct Run<T> {
    h: T,
    /// Speed at the beginning and the end.
    speed: (T, T),
    /// Friction level at the beginning and the end.
    level: (T, T),
    attraction: T,
}

impl<T: Real> Run<T> {
    /// Force of an element at the end, counted in the direction of motion, and whether it slips there.
    #[inline]
    fn element(&self, element: &Element<T>, force: T, slips: bool) -> (T, bool) {
        if slips {
            return (self.slip(element, force, T::ZERO), true);
        }
        match self.breaks(element, force) {
            Err(end) => (end, false),
            Ok(theta) => {
                // It may start beyond its limit: where the limit has fallen, or where the other direction has the
                // higher level.
                let limit = element.share * self.level_at(theta);
                let start = if theta > T::ZERO { limit } else { force };
                (self.slip(element, start, theta), true)
            }
        }
    }

    #[inline]
    fn level_at(&self, theta: T) -> T {
        self.level.0 + theta * (self.level.1 - self.level.0)
    }

    /// The part of the interval after which a sticking element reaches its limit, or else its force at the end.
    #[inline]
    fn breaks(&self, element: &Element<T>, force: T) -> Result<T, T> {
        let half = T::from_f64(0.5);
        let missing = element.share * self.level.0 - force;
        if missing <= T::ZERO {
            return Ok(T::ZERO);
        }
        let end = force + element.stiffness * (self.h * (half * (self.speed.0 + self.speed.1)));
        if end < element.share * self.level.1 {
            return Err(end);
        }
        // a theta^2 + b theta = missing
        let a = element.stiffness * (self.h * (half * (self.speed.1 - self.speed.0)));
        let b = element.stiffness * (self.h * self.speed.0)
            - element.share * (self.level.1 - self.level.0);
        let root = (b * b + T::from_f64(4.0) * a * missing).max(T::ZERO).sqrt();
        let theta = if b > T::ZERO {
            T::from_f64(2.0) * missing / (b + root)
        } else {
            (root - b) / (T::from_f64(2.0) * a)
        };
        // A theta that is not finite counts as slip from the start; rounding may put theta slightly outside 0..=1.
        Ok(if theta.is_finite() {
            theta.max(T::ZERO).min(T::ONE)
        } else {
            T::ZERO
        })
    }

    /// Force at the end of an element that slips from the part `theta` on.
    #[inline]
    fn slip(&self, element: &Element<T>, force: T, theta: T) -> T {
        let rest = (T::ONE - theta) * self.h;
        // This also avoids 0 times infinity in the exponent.
        if rest <= T::ZERO {
            return force;
        }
        let level = self.level_at(theta);
        let pull = self.attraction / level + self.attraction / self.level.1;
        let a = rest * (T::from_f64(0.5) * pull);
        let e = (-a).expm1();
        let limit = element.share * level;
        let rise = element.share * (self.level.1 - level);
        force + ((force - limit) * e + rise * one_plus_ratio(a, e))
    }
}
