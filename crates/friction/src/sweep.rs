//! What a step at a held velocity takes of the law before the deflection is known.

use crate::damping::micro_damping_and_slope;
use crate::{Direction, LuGre, Real};

/// A step of `h > 0` seconds at a held velocity, whatever the deflection z that it begins with: the end of the step and
/// its mean force are linear in z. An implicit simulation may have this ready before it knows z, and so wait less for
/// the exponentials.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sweep<T> {
    velocity: T,
    /// Deflection that the velocity leads to, with its derivative in velocity.
    steady: (T, T),
    /// `exp(-a) - 1`, the share of the way there with its sign reversed, and the derivative of a.
    decay: T,
    a_slope: T,
    /// Force for a deflection, for its change over the step, and without either.
    stiffness: T,
    by_change: (T, T),
    rest: (T, T),
}

/// Steps of one length at held velocities: what they have in common is computed once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sweeps<T> {
    law: LuGre<T>,
    h: T,
    /// `1/h`, `1/sigma0`
    per_time: T,
    compliance: T,
    /// sigma0 h, N s/m (N m s/rad)
    swept: T,
    /// `1/vs` and `Fs - Fc` in the positive and the negative direction.
    per_velocity: [T; 2],
    drop: [T; 2],
}

impl<T: Real> LuGre<T> {
    /// Steps of `h > 0` seconds.
    pub fn sweeps(&self, h: T) -> Sweeps<T> {
        let sides = [self.curve().positive(), self.curve().negative()];
        Sweeps {
            law: *self,
            h,
            per_time: T::ONE / h,
            compliance: T::ONE / self.stiffness(),
            swept: h * self.stiffness(),
            per_velocity: sides.map(|side| T::ONE / side.stribeck_velocity),
            drop: sides.map(|side| side.static_friction - side.coulomb),
        }
    }

    /// The step of `h > 0` seconds at the velocity `v`, m/s (rad/s).
    #[inline]
    pub fn sweep(&self, h: T, v: T) -> Sweep<T> {
        self.sweeps(h).at(v)
    }
}

impl<T: Real> Sweeps<T> {
    /// Length of the steps, s.
    #[inline]
    pub fn h(&self) -> T {
        self.h
    }

    /// The step at the velocity `v`, m/s (rad/s).
    #[inline(always)]
    pub fn at(&self, v: T) -> Sweep<T> {
        // Each way its own code: the branch is foreseen, and the numbers of a side are there before the velocity is.
        if v >= T::ZERO {
            self.towards(v, 0, self.law.curve().positive(), T::ONE)
        } else {
            self.towards(v, 1, self.law.curve().negative(), -T::ONE)
        }
    }

    #[inline(always)]
    fn towards(&self, v: T, i: usize, side: &Direction<T>, sign: T) -> Sweep<T> {
        let law = &self.law;
        let curve = law.curve();
        let (per_velocity, drop) = (self.per_velocity[i], self.drop[i]);
        let (weight, falls) = curve.shape().weight_and_slope(v.abs() * per_velocity);
        let g = side.coulomb + drop * weight;
        let g_slope = sign * (drop * per_velocity) * falls;
        let per_level = T::ONE / g;
        // Of the way there exp(-a) is left.
        let per_speed = self.swept * per_level;
        let a = per_speed * v.abs();
        let a_slope = sign * per_speed - a * g_slope * per_level;
        let (s1, s1_slope) = micro_damping_and_slope(law, v, g, g_slope);
        let viscous = side.viscous;
        Sweep {
            velocity: v,
            steady: (sign * g * self.compliance, sign * g_slope * self.compliance),
            decay: (-a).expm1(),
            a_slope,
            stiffness: law.stiffness(),
            by_change: (
                T::from_f64(0.5) * law.stiffness() + s1 * self.per_time,
                s1_slope * self.per_time,
            ),
            rest: (viscous * v + curve.offset(), viscous),
        }
    }
}

impl<T: Real> Sweep<T> {
    /// The velocity, m/s (rad/s).
    #[inline]
    pub fn velocity(&self) -> T {
        self.velocity
    }

    /// Change of the deflection `z` over the step, m (rad), and its derivative with respect to the velocity, s.
    #[inline]
    pub fn change(&self, z: T) -> (T, T) {
        let off = z - self.steady.0;
        let by_decay = -(off * self.a_slope);
        (
            off * self.decay,
            (by_decay - self.steady.1) * self.decay + by_decay,
        )
    }

    /// Mean force over the step from the deflection `z`, and its derivative with respect to the velocity, N and N s/m
    /// (N m, N m s/rad).
    #[inline]
    pub fn mean_force(&self, z: T) -> (T, T) {
        // Both linear in the exponential, which is known last.
        let off = z - self.steady.0;
        let by_decay = -(off * self.a_slope) * self.by_change.0;
        let steady = off * self.by_change.1 - self.steady.1 * self.by_change.0;
        (
            self.decay * (off * self.by_change.0) + (self.stiffness * z + self.rest.0),
            self.decay * (by_decay + steady) + (by_decay + self.rest.1),
        )
    }
}
