//! The step that runs on the drive, and what a simulation needs.

use super::ElastoPlastic;
use super::record::Way;
use crate::{Damping, Real, State};

impl<T: Real> ElastoPlastic<T> {
    /// The state at rest: no deflection, the offset as force.
    pub fn rest(&self) -> State<T> {
        self.bristle.rest()
    }

    /// Deflection after `h` seconds at the velocity `v` (m/s, rad/s); `|z| <= bound()`.
    ///
    /// Exact below break-away and beyond the steady deflection, fourth order between. `h <= 0` leaves `z` as it is,
    /// within the bound.
    #[inline]
    pub fn step_held(&self, z: T, h: T, v: T) -> T {
        let g = self.bristle.curve().level(v);
        self.bristle.clamp(z + self.held_change(z, h, v, g))
    }

    /// Deflection after `h > 0` seconds at the velocity `v`, without the clamp, and its derivative with respect to `v`
    /// (s): what an implicit simulation needs. Where `v` changes sign the derivative is that from above.
    pub fn step_held_slope(&self, z: T, h: T, v: T) -> (T, T) {
        let (g, g_slope) = self.bristle.curve().level_and_slope(v);
        let sign = if v >= T::ZERO { T::ONE } else { -T::ONE };
        let stiffness = self.bristle.stiffness();
        // All in units of the steady deflection, counted in the direction of motion.
        let bend = g_slope / g;
        let place = sign * (stiffness * z / g);
        let per_speed = h * stiffness / g;
        let path = per_speed * v.abs();
        let (e, e_slope) = self.plasticity.held(
            (T::ONE - place, place * bend),
            (path, sign * per_speed - path * bend),
        );
        if e >= self.plasticity.width {
            return (z + h * v, h);
        }
        let steady = sign * g / stiffness;
        (
            steady * (T::ONE - e),
            steady * (bend * (T::ONE - e) - e_slope),
        )
    }

    /// One sample of the law in real time: advances `state` by `h` seconds at the velocity `v` (m/s, rad/s) and returns
    /// the friction force, N (N m), with the deflection's mean rate over the sample.
    ///
    /// The force is finite whatever comes in, as with [`LuGre::step`](crate::LuGre::step), and with
    /// [`Damping::Capped`] no sample creates energy: bristles that do not creep store less, and where alpha is 1 the law
    /// is LuGre's.
    #[inline]
    pub fn step(&self, state: &mut State<T>, h: T, v: T) -> T {
        let law = &self.bristle;
        state.z = if state.z.is_finite() {
            law.clamp(state.z)
        } else {
            T::ZERO
        };
        if !state.force.is_finite() {
            state.force = law.curve().offset();
        }
        if v.is_finite() && h >= T::ZERO && h <= T::MAX {
            let g = law.curve().level(v);
            let change = self.held_change(state.z, h, v, g);
            let z = law.clamp(state.z + change);
            let rate = if h > T::ZERO {
                change / h
            } else {
                self.rate_at_level(state.z, v, g)
            };
            let mut s1 = law.micro_damping_at_level(v, g);
            if let Damping::Capped(_) = law.damping() {
                s1 = law.sampled_cap(s1, state.z, z, rate, v);
            }
            let force = law.force_of(z, rate, v, s1);
            if force.is_finite() {
                *state = State { z, force };
            }
        }
        state.force
    }

    #[inline]
    fn held_change(&self, z: T, h: T, v: T, g: T) -> T {
        if h <= T::ZERO || v == T::ZERO {
            return T::ZERO;
        }
        let stiffness = self.bristle.stiffness();
        let steady = g / stiffness;
        let way = Way {
            path: h * v.abs(),
            stretched: h * (stiffness * (v.abs() / g)),
            from: steady,
            to: steady,
        };
        if v > T::ZERO {
            self.along(z, way)
        } else {
            -self.along(-z, way)
        }
    }
}
