//! What a simulated axis needs of a law, whatever its state is.

use crate::{Damping, ElastoPlastic, Elements, Gms, LuGre, Real, Stribeck};

/// A time step of an axis, as far as it matters to friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace<T> {
    /// Length of the step, > 0, s.
    pub h: T,
    /// Velocity at its beginning, m/s (rad/s).
    pub start: T,
    /// Mass of the axis, > 0, kg (kg m^2).
    pub mass: T,
}

/// A law that is stepped at a velocity held constant over the step, with the mean force over the step: what an implicit
/// simulation of an axis needs.
///
/// The mean force takes the mean of the spring forces at both ends and their change over the step as their rate.
pub trait Held<T: Real>: Copy {
    /// What the law remembers; its default is unloaded.
    type State: Copy + Default + core::fmt::Debug + PartialEq;

    /// The steady curve, with sigma2 and the offset.
    fn curve(&self) -> &Stribeck<T>;

    /// The state after `h > 0` seconds at the velocity `v` (m/s, rad/s).
    fn hold(&self, from: Self::State, h: T, v: T) -> Self::State;

    /// Mean friction force, N (N m), over `h > 0` seconds at the velocity `v` that led from one state to another.
    fn mean_force(&self, from: Self::State, to: Self::State, h: T, v: T) -> T;

    /// Mean friction force, N (N m), over a step at the mean velocity `v`, and its derivative with respect to `v`
    /// (N s/m, N m s/rad), accurate enough for Newton's method. LuGre takes the curvature of the deflection within the step
    /// into account, see [`Sweep`](crate::Sweep); the other laws take the mean of both ends.
    fn mean_force_slope(&self, from: Self::State, pace: &Pace<T>, v: T) -> (T, T);

    /// Friction force, N (N m), at a state and the velocity `v` (m/s, rad/s).
    fn force_now(&self, state: Self::State, v: T) -> T;

    /// Force of the deflections alone, N (N m), after `h > 0` seconds at the velocity `v`, and its derivative with respect to `v`
    /// (N s/m, N m s/rad).
    fn spring_slope(&self, from: Self::State, h: T, v: T) -> (T, T);

    /// Force of the deflections alone, N (N m).
    fn spring(&self, state: Self::State) -> T;

    /// Upper bound of the mean force over `h > 0` seconds, without the viscous part and the offset, N (N m).
    fn reach(&self, h: T) -> T;
}

impl<T: Real> LuGre<T> {
    /// The mean force over `h > 0` seconds at the velocity `v`, level `g`, from the deflection `from` to `end`, which comes
    /// with its derivative with respect to `v`; and the derivative of that force.
    #[inline]
    pub(crate) fn mean_force_from_end(&self, from: T, end: (T, T), h: T, v: T, g: T) -> (T, T) {
        let (end, end_slope) = end;
        let s1 = self.micro_damping_at_level(v, g);
        // Where sigma1 has its value at rest the cap is not active, and there is nothing to differentiate.
        let s1_slope = if s1 == self.damping().at_rest() {
            T::ZERO
        } else {
            damping_slope(self, v)
        };
        let half = T::from_f64(0.5);
        let rate = (end - from) / h;
        let slope = end_slope * (half * self.stiffness() + s1 / h)
            + rate * s1_slope
            + self.curve().direction(v).viscous;
        (self.force_of(half * (from + end), rate, v, s1), slope)
    }
}

impl<T: Real> Held<T> for LuGre<T> {
    type State = T;

    fn curve(&self) -> &Stribeck<T> {
        LuGre::curve(self)
    }

    #[inline]
    fn hold(&self, from: T, h: T, v: T) -> T {
        self.step_held(from, h, v)
    }

    #[inline]
    fn mean_force(&self, from: T, to: T, h: T, v: T) -> T {
        self.force_at_rate(T::from_f64(0.5) * (from + to), (to - from) / h, v)
    }

    #[inline]
    fn mean_force_slope(&self, from: T, pace: &Pace<T>, v: T) -> (T, T) {
        let sweep = self.sweeps(pace.h, pace.mass).at(v);
        sweep.mean_force(from, pace.start)
    }

    fn force_now(&self, state: T, v: T) -> T {
        self.force(state, v)
    }

    fn spring_slope(&self, from: T, h: T, v: T) -> (T, T) {
        let (end, slope) = self.step_held_slope(from, h, v);
        (self.stiffness() * end, self.stiffness() * slope)
    }

    fn spring(&self, state: T) -> T {
        self.stiffness() * state
    }

    fn reach(&self, h: T) -> T {
        let swing = T::from_f64(2.0) * self.bound();
        // The force of the largest deflection and the largest amount that the correction within a step adds to it.
        T::from_f64(3.0) * self.stiffness() * self.bound() + self.damping().at_rest() * swing / h
    }
}

impl<T: Real> Held<T> for ElastoPlastic<T> {
    type State = T;

    fn curve(&self) -> &Stribeck<T> {
        self.bristle().curve()
    }

    #[inline]
    fn hold(&self, from: T, h: T, v: T) -> T {
        self.step_held(from, h, v)
    }

    #[inline]
    fn mean_force(&self, from: T, to: T, h: T, v: T) -> T {
        self.bristle().mean_force(from, to, h, v)
    }

    #[inline]
    fn mean_force_slope(&self, from: T, &Pace { h, .. }: &Pace<T>, v: T) -> (T, T) {
        let end = self.step_held_slope(from, h, v);
        let g = Held::curve(self).level(v);
        self.bristle().mean_force_from_end(from, end, h, v, g)
    }

    fn force_now(&self, state: T, v: T) -> T {
        self.force(state, v)
    }

    fn spring_slope(&self, from: T, h: T, v: T) -> (T, T) {
        let (end, slope) = self.step_held_slope(from, h, v);
        let stiffness = self.bristle().stiffness();
        (stiffness * end, stiffness * slope)
    }

    fn spring(&self, state: T) -> T {
        self.bristle().spring(state)
    }

    fn reach(&self, h: T) -> T {
        self.bristle().reach(h)
    }
}

impl<T: Real, const N: usize> Held<T> for Gms<T, N> {
    type State = Elements<T, N>;

    fn curve(&self) -> &Stribeck<T> {
        Gms::curve(self)
    }

    fn hold(&self, from: Elements<T, N>, h: T, v: T) -> Elements<T, N> {
        self.step_held(from, h, v)
    }

    fn mean_force(&self, from: Elements<T, N>, to: Elements<T, N>, h: T, v: T) -> T {
        let (begin, end) = (from.total(), to.total());
        self.force_at_rate(T::from_f64(0.5) * (begin + end), (end - begin) / h, v)
    }

    fn mean_force_slope(&self, from: Elements<T, N>, &Pace { h, .. }: &Pace<T>, v: T) -> (T, T) {
        let (end, end_slope) = self.total_held_slope(&from, h, v);
        let begin = from.total();
        let half = T::from_f64(0.5);
        let force = self.force_at_rate(half * (begin + end), (end - begin) / h, v);
        let slope = end_slope * (half + self.damping() / (self.stiffness() * h))
            + Gms::curve(self).direction(v).viscous;
        (force, slope)
    }

    fn force_now(&self, state: Elements<T, N>, v: T) -> T {
        self.force(&state, v)
    }

    fn spring_slope(&self, from: Elements<T, N>, h: T, v: T) -> (T, T) {
        self.total_held_slope(&from, h, v)
    }

    fn spring(&self, state: Elements<T, N>) -> T {
        state.total()
    }

    fn reach(&self, h: T) -> T {
        let swing = T::from_f64(2.0) * self.bound();
        self.bound() + self.damping() * (swing / self.stiffness()) / h
    }
}

/// Step of the finite difference in [`damping_slope`], relative to the velocity, and the least velocity used there,
/// in Stribeck velocities: small against the scale on which sigma1 changes, large against rounding.
const RELATIVE_STEP: f64 = 1e-6;

/// Derivative of sigma1 with respect to velocity; a difference is enough, since it only guides Newton's method.
fn damping_slope<T: Real>(law: &LuGre<T>, v: T) -> T {
    match law.damping() {
        Damping::Constant(_) => T::ZERO,
        _ => {
            let part = T::from_f64(RELATIVE_STEP);
            let vs = law.curve().direction(v).stribeck_velocity;
            let d = part * v.abs().max(part * vs);
            (law.micro_damping(v + d) - law.micro_damping(v - d)) / (T::from_f64(2.0) * d)
        }
    }
}
