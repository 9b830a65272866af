//! Steps at a held velocity, evaluated before the deflection is known.

use crate::damping::micro_damping_and_slope;
use crate::{Direction, LuGre, Real, Shape};

/// A step of `h > 0` seconds at a mean velocity, for any deflection z and velocity at its beginning. An implicit
/// simulation can evaluate this ahead, before it knows them, and so waits less for the exponentials.
///
/// The deflection follows the solution at a held velocity w. Its mean over the step, from which the mean force follows, is that
/// of the trapezoidal rule with end corrections (Euler-Maclaurin), with the rate at the ends from the derivatives of z' at w and
/// at the mean deflection:
/// ```text
/// (z + z+)/2 - c h/12 [(v+ - v) dz'/dv + (z+ - z) dz'/dz],   c = 1/(1 + sigma0 h^2/(12 M))
/// ```
/// The first part acts as if the mass M were smaller by sigma0 h^2/12 while the bristles stick; the factor c keeps it positive.
/// In a step that is long for the bristles (large `a = sigma0 |w| h/g`) the correction must vanish: the first part fades as
/// `1/(1 + a^2)` and is at most g/4, the second fades as `1/(1 + a^2/60)`, as the mean of an exponential requires.
/// The correction is limited so that it never returns more energy than the bristles store.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sweep<T> {
    velocity: T,
    /// Distance travelled, m (rad).
    path: T,
    /// Steady deflection at the velocity.
    steady: T,
    /// `exp(-a) - 1`, minus the fraction of the approach to the steady deflection.
    decay: T,
    /// Derivative of the change of the deflection with respect to velocity: per distance from the steady deflection, and at it.
    change_slope: [T; 2],
    /// Force per deflection; force per change of the deflection over the step, with its derivative; the latter
    /// without the correction.
    stiffness: T,
    by_change: (T, T),
    by_rate: T,
    /// Force without deflection, with its derivative.
    rest: (T, T),
    /// Correction of the force for half the change of velocity, linear in the deflection; and its bound, N (N m).
    bend: [T; 2],
    most: T,
    /// Force without the correction, linear in the deflection.
    plain: [T; 2],
}

/// Steps of one length at held velocities: everything that does not depend on the velocity is computed once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sweeps<T> {
    law: LuGre<T>,
    h: T,
    /// `1/h`, `1/sigma0`
    per_time: T,
    compliance: T,
    /// sigma0 h, N s/m (N m s/rad)
    swept: T,
    /// Coefficients of the correction: 5 c sigma0, N/m (N m/rad), and c sigma0 h/6, N s/m (N m s/rad).
    relaxed: T,
    bend: T,
    /// `|v|/vs` beyond which the level is the Coulomb level to rounding.
    flat: T,
    /// `1/vs` and `Fs - Fc` in the positive and the negative direction.
    per_velocity: [T; 2],
    drop: [T; 2],
}

impl<T: Real> LuGre<T> {
    /// Steps of `h > 0` seconds of an axis with the mass `mass` > 0, kg (kg m^2).
    pub fn sweeps(&self, h: T, mass: T) -> Sweeps<T> {
        let sides = [self.curve().positive(), self.curve().negative()];
        let swept = h * self.stiffness();
        let twelve = T::from_f64(12.0);
        let corrected = self.stiffness() / (T::ONE + swept * h / (twelve * mass));
        Sweeps {
            law: *self,
            h,
            per_time: T::ONE / h,
            compliance: T::ONE / self.stiffness(),
            swept,
            relaxed: T::from_f64(5.0) * corrected,
            bend: corrected * h / T::from_f64(6.0),
            flat: match self.curve().shape() {
                // There w < 2^-64.
                Shape::Gaussian => T::from_f64(6.7),
                Shape::Exponential => T::from_f64(44.5),
                Shape::Power(_) | Shape::Lorentzian => T::MAX,
            },
            per_velocity: sides.map(|side| T::ONE / side.stribeck_velocity),
            drop: sides.map(|side| side.static_friction - side.coulomb),
        }
    }
}

impl<T: Real> Sweeps<T> {
    /// Length of the steps, s.
    #[inline]
    pub fn h(&self) -> T {
        self.h
    }

    /// The step at the mean velocity `v`, m/s (rad/s).
    #[inline(always)]
    pub fn at(&self, v: T) -> Sweep<T> {
        // Separate code for each direction: the branch is predicted, and the parameters of a side are loaded before the
        // velocity is known.
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
        let half = T::from_f64(0.5);
        let (per_velocity, drop) = (self.per_velocity[i], self.drop[i]);
        let x = v.abs() * per_velocity;
        let (weight, falls) = if x > self.flat {
            (T::ZERO, T::ZERO)
        } else {
            curve.shape().weight_and_slope(x)
        };
        let g = side.coulomb + drop * weight;
        let g_slope = sign * (drop * per_velocity) * falls;
        let per_level = T::ONE / g;
        // After the step exp(-a) of the distance to the steady deflection is left.
        let per_speed = self.swept * per_level;
        let a = per_speed * v.abs();
        let a_slope = sign * per_speed - a * g_slope * per_level;
        let (s1, s1_slope) = micro_damping_and_slope(law, v, g, g_slope);
        let viscous = side.viscous;
        let decay = (-a).expm1();
        let steady = sign * g * self.compliance;
        let steady_slope = sign * g_slope * self.compliance;

        // Both parts of the correction with one division; a is limited against overflow, and at 1e6 both parts have
        // vanished.
        let long = a.min(T::from_f64(1e6));
        let sixty = T::from_f64(60.0) + long * long;
        let fades = T::ONE + long * long;
        let per_both = T::ONE / (sixty * fades);
        let relaxes = long * (fades * per_both);
        let by_rate = half * law.stiffness() + s1 * self.per_time;

        // dz'/dv = 1 - q z with q = (1 - v g'/g)/steady, at the mean of the ends.
        let gain = self.bend * (sixty * per_both);
        let q = (sign * law.stiffness() * per_level) * (T::ONE - (g_slope * v) * per_level);
        let bent = gain * q;
        let half_decay = half * decay;
        let bend = [
            gain + bent * (half_decay * steady),
            -(bent + bent * half_decay),
        ];
        let by_change = (by_rate + self.relaxed * relaxes, s1_slope * self.per_time);
        let by_off = decay * by_change.0;
        let change_slope = [-a_slope - a_slope * decay, -(steady_slope * decay)];
        let rest = (viscous * v + curve.offset(), viscous);
        Sweep {
            velocity: v,
            path: v * self.h,
            steady,
            decay,
            change_slope,
            stiffness: law.stiffness(),
            by_change,
            by_rate,
            rest,
            bend,
            most: T::from_f64(0.25) * g,
            plain: [rest.0 - steady * by_off, law.stiffness() + by_off],
        }
    }
}

impl<T: Real> Sweep<T> {
    /// The mean velocity, m/s (rad/s).
    #[inline]
    pub fn velocity(&self) -> T {
        self.velocity
    }

    /// Change of the deflection `z` over the step, m (rad), and its derivative with respect to the velocity, s.
    #[inline]
    pub fn change(&self, z: T) -> (T, T) {
        let off = z - self.steady;
        let slope = off * self.change_slope[0] + self.change_slope[1];
        (off * self.decay, slope)
    }

    /// The force of [`mean_force`](Self::mean_force) at `z` where its correction is within bounds, and what it falls by per
    /// velocity `start` below the mean: accurate enough to predict a velocity.
    #[inline]
    pub fn likely_force(&self, z: T) -> (T, T) {
        (
            self.plain[0] + self.plain[1] * z,
            self.bend[0] + self.bend[1] * z,
        )
    }

    /// Mean force over the step from the deflection `z` and the velocity `start` (m/s, rad/s), and its derivative with
    /// respect to the mean velocity, N and N s/m (N m, N m s/rad). The derivative leaves out the change of the correction's
    /// coefficients, which is of the order of `sigma0 h^2/(12 M)`: accurate enough for Newton's method.
    #[inline]
    pub fn mean_force(&self, z: T, start: T) -> (T, T) {
        let (change, change_slope) = self.change(z);
        let by_rise = self.bend[0] + self.bend[1] * z;
        let bends = (self.velocity - start) * by_rise;
        let bristle = self.stiffness * z + change * self.by_change.0 - bends;
        // Work done on the bristles, and the part of it that they store.
        let kept = self.stiffness * (z + T::from_f64(0.5) * change) * change;
        let (bristle, slope) = if bends.abs() <= self.most && bristle * self.path >= kept {
            let slope = change_slope * self.by_change.0 + change * self.by_change.1 - by_rise;
            (bristle, slope)
        } else {
            self.bounded(z, by_rise, bends)
        };
        (bristle + self.rest.0, slope + self.rest.1)
    }

    /// The force of the bristles where the correction exceeds its bound.
    #[cold]
    #[inline(never)]
    fn bounded(&self, z: T, by_rise: T, bends: T) -> (T, T) {
        let (change, change_slope) = self.change(z);
        let least = -self.most;
        let (bends, by_rise) = if bends > self.most {
            (self.most, T::ZERO)
        } else if bends < least {
            (least, T::ZERO)
        } else {
            (bends, by_rise)
        };
        let of_change = |by_change: T| {
            (
                self.stiffness * z + change * by_change,
                change_slope * by_change + change * self.by_change.1,
            )
        };
        let (force, slope) = of_change(self.by_change.0);
        let corrected = (force - bends, slope - by_rise);
        let mean = z + T::from_f64(0.5) * change;
        let kept = self.stiffness * mean * change;
        if corrected.0 * self.path >= kept {
            return corrected;
        }
        // Where sigma1 is not capped the law itself may release energy: that property of the law is kept.
        let plain = of_change(self.by_rate);
        let enough = kept / self.path;
        let kept_slope = self.stiffness * change_slope * (mean + T::from_f64(0.5) * change);
        let enough = (enough, kept_slope / self.path - enough / self.velocity);
        let less = |a: (T, T), b: (T, T)| a.0 * self.path < b.0 * self.path;
        let allowed = if less(plain, enough) { plain } else { enough };
        if less(corrected, allowed) {
            allowed
        } else {
            corrected
        }
    }
}
