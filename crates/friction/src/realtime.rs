//! The step that runs on the drive, 1 to 20 kHz.

use crate::{Damping, LuGre, Real};

/// Margin above 1 from which on the passive cap is certainly not active, relative: above the rounding of `f32`, 6e-8, in the
/// terms of the quotient.
const QUOTIENT_MARGIN: f64 = 1e-6;

/// The state of a running law between samples. Start from [`LuGre::rest`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State<T> {
    /// Bristle deflection, m (rad).
    pub z: T,
    /// The force last returned, N (N m).
    pub force: T,
}

impl<T: Real> LuGre<T> {
    /// The state at rest: no deflection, the offset as force.
    pub fn rest(&self) -> State<T> {
        State {
            z: T::ZERO,
            force: self.curve().offset(),
        }
    }

    /// Deflection after `h` seconds at the velocity `v` (m/s, rad/s), exact for a held velocity; `|z| <= bound()`.
    ///
    /// `h <= 0` leaves `z` as it is, within the bound.
    #[inline]
    pub fn step_held(&self, z: T, h: T, v: T) -> T {
        self.clamp(z + self.held_change(z, h, v, self.curve().level(v)))
    }

    /// [`step_held`](Self::step_held) without the clamp, and its derivative with respect to `v` (s): what an implicit
    /// simulation needs. `h > 0`.
    #[inline]
    pub fn step_held_slope(&self, z: T, h: T, v: T) -> (T, T) {
        let (g, g_slope) = self.curve().level_and_slope(v);
        let sign = if v >= T::ZERO { T::ONE } else { -T::ONE };
        let per_speed = h * self.stiffness() / g;
        let a = per_speed * v.abs();
        let e = (-a).expm1();
        let lag = z - sign * g / self.stiffness();
        let a_slope = sign * per_speed - a * g_slope / g;
        let slope = -(sign * g_slope / self.stiffness()) * e - lag * (T::ONE + e) * a_slope;
        (z + lag * e, slope)
    }

    /// One sample of the law in real time: advances `state` by `h` seconds at the velocity `v` (m/s, rad/s) and returns
    /// the friction force, N (N m), with the deflection's mean rate over the sample.
    ///
    /// The force is finite whatever comes in: a sample whose `v` or `h` is not finite, whose `h` is negative, or whose
    /// force would overflow, leaves the deflection as it is and returns the force of the sample before (the offset, if
    /// there was none). `h = 0` gives the force at the present deflection. The deflection is held within `bound()`, a
    /// deflection that is not a number becomes 0.
    ///
    /// With [`Damping::Capped`] no sample creates energy, at any `h`: sigma1 is further limited where the sampled law
    /// would otherwise release energy that the law in continuous time does not.
    #[inline(always)]
    pub fn step(&self, state: &mut State<T>, h: T, v: T) -> T {
        let within = state.z.abs() <= self.bound();
        if !within {
            state.z = if state.z.is_finite() {
                self.clamp(state.z)
            } else {
                T::ZERO
            };
        }
        if !state.force.is_finite() {
            state.force = self.curve().offset();
        }
        if v.is_finite() && h >= T::ZERO && h <= T::MAX {
            let g = self.curve().level(v);
            let change = self.held_change(state.z, h, v, g);
            let rate = if h > T::ZERO {
                change / h
            } else {
                self.rate_at_level(state.z, v, g)
            };
            let z = self.clamp(state.z + change);
            let mut s1 = self.micro_damping_at_level(v, g);
            if let Damping::Capped(_) = self.damping() {
                s1 = self.sampled_cap(s1, state.z, z, rate, v);
            }
            let force = self.force_of(z, rate, v, s1);
            if force.is_finite() {
                *state = State { z, force };
            }
        }
        state.force
    }

    /// The largest sigma1 up to `s1` with which a sample from `z` to `end` at the deflection rate `rate` creates no energy.
    ///
    /// [`passive_cap`](Self::passive_cap) is the bound in continuous time. A sample holds the force at its end over
    /// its whole length, and where a bristle unloads that is the smallest force within the sample: the work done on
    /// the law would be too small by up to 13 % of Fs |v| h. So the energy balance of the sample itself is enforced:
    /// work done on the law >= growth of sigma0 z^2/2.
    #[inline]
    pub(crate) fn sampled_cap(&self, s1: T, z: T, end: T, rate: T, v: T) -> T {
        let returned = -(rate * v);
        if returned <= T::ZERO {
            return s1;
        }
        let taken = (self.stiffness() * end + self.curve().direction(v).viscous * v) * v;
        let stored = self.stiffness() * (T::from_f64(0.5) * (z + end)) * rate;
        let left = taken - stored;
        // The quotient is hardly ever below s1. Where it is above by more than rounding it need not be computed.
        if left > T::from_f64(1.0 + QUOTIENT_MARGIN) * (s1 * returned) {
            return s1;
        }
        (left / returned).min(s1)
    }

    #[inline]
    fn held_change(&self, z: T, h: T, v: T, g: T) -> T {
        if h <= T::ZERO || v == T::ZERO {
            return T::ZERO;
        }
        let a = h * (self.stiffness() * (v.abs() / g));
        let steady = if v < T::ZERO {
            -g / self.stiffness()
        } else {
            g / self.stiffness()
        };
        (z - steady) * (-a).expm1()
    }

    #[inline]
    pub(crate) fn clamp(&self, z: T) -> T {
        z.max(-self.bound()).min(self.bound())
    }
}
