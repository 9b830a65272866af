//! The micro-damping sigma1 and the velocity dependence that keeps it from creating energy.

use crate::error::ParamError;
use crate::{LuGre, Real, Stribeck};

/// Micro-damping sigma1(v), N s/m (N m s/rad).
///
/// A constant sigma1 makes the LuGre law active (not passive): bristles loaded at rest and then swept away at speed
/// push the axis forward. `Capped` is the default choice; `Constant` is what most published figures were made with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Damping<T> {
    /// sigma1 at every speed, >= 0.
    Constant(T),
    /// `min(sigma1, cap(v))` with the largest value that can never release energy, see [`LuGre::passive_cap`].
    ///
    /// [`LuGre::passive_cap`]: crate::LuGre::passive_cap
    Capped(T),
    /// `sigma1 exp(-(v/vd)^2)`, Olsson 1996. Releases no energy if `vd <= 9.33 Fc/sigma1`.
    Olsson {
        /// sigma1 at rest, >= 0.
        sigma1: T,
        /// Velocity vd over which it fades, > 0, m/s (rad/s).
        velocity: T,
    },
}

impl<T: Real> Damping<T> {
    /// sigma1 at rest, N s/m (N m s/rad).
    pub fn at_rest(&self) -> T {
        match *self {
            Damping::Constant(s1) | Damping::Capped(s1) | Damping::Olsson { sigma1: s1, .. } => s1,
        }
    }

    /// The same damping in another number type.
    pub fn cast<U: Real>(&self) -> Damping<U> {
        let to = |x: T| U::from_f64(x.to_f64());
        match *self {
            Damping::Constant(s1) => Damping::Constant(to(s1)),
            Damping::Capped(s1) => Damping::Capped(to(s1)),
            Damping::Olsson { sigma1, velocity } => Damping::Olsson {
                sigma1: to(sigma1),
                velocity: to(velocity),
            },
        }
    }

    pub(crate) fn validate(&self) -> Result<(), ParamError> {
        ParamError::not_negative("sigma1", self.at_rest())?;
        match *self {
            Damping::Olsson { velocity, .. } => ParamError::positive("damping_velocity", velocity),
            _ => Ok(()),
        }
    }
}

/// The largest sigma1 with which a bristle force of any size up to `y_max` dissipates at velocity `v`, where the level is `g`.
///
/// With the storage `y^2/(2 sigma0)`, `y = sigma0 z`, the law dissipates per unit of path
/// `y^2/g - sigma1 |v| y/g + (sigma1 + sigma2)|v|` when bristle and motion point the same way (otherwise more). The
/// parabola's minimum lies at `y = sigma1 |v|/2`: below `y_max` its discriminant decides, else its value at `y_max`.
/// A bristle may arrive loaded by the other direction, hence the larger of the two static levels as `y_max`.
pub(crate) fn passive_cap<T: Real>(curve: &Stribeck<T>, v: T, g: T) -> T {
    if v == T::ZERO {
        return T::MAX;
    }
    Cap::new(curve, v, g).value()
}

/// Intermediate values of [`passive_cap`] and its derivative at a velocity other than 0.
struct Cap<T> {
    speed: T,
    level: T,
    viscous: T,
    y_max: T,
    /// `sqrt(1 + sigma2 |v|/g)`
    inner: T,
}

impl<T: Real> Cap<T> {
    #[inline(always)]
    fn new(curve: &Stribeck<T>, v: T, g: T) -> Self {
        let (speed, viscous) = (v.abs(), curve.direction(v).viscous);
        Cap {
            speed,
            level: g,
            viscous,
            y_max: curve.largest_static_level(),
            inner: (T::ONE + viscous * speed / g).sqrt(),
        }
    }

    #[inline(always)]
    fn value(&self) -> T {
        let Cap {
            speed,
            level: g,
            viscous,
            y_max,
            inner,
        } = *self;
        let root = T::ONE + inner;
        if y_max >= g * root {
            T::from_f64(2.0) * g / speed * root
        } else if y_max > g {
            (viscous + y_max * (y_max / g) / speed) / (y_max / g - T::ONE)
        } else {
            T::MAX
        }
    }

    /// Derivative of the cap, whose value is `cap`, with respect to the speed; `g_slope` is the derivative of the
    /// level.
    #[inline(always)]
    fn slope(&self, cap: T, g_slope: T) -> T {
        let Cap {
            speed,
            level: g,
            viscous,
            y_max,
            inner,
        } = *self;
        let root = T::ONE + inner;
        if y_max >= g * root {
            let two = T::from_f64(2.0);
            let root_slope = (viscous - viscous * speed / g * g_slope) / (two * g * inner);
            (two * (g_slope * root + g * root_slope) - cap) / speed
        } else {
            let u = y_max / g;
            let falls = y_max * u / speed * (g_slope / g + T::ONE / speed);
            (cap * u * g_slope / g - falls) / (u - T::ONE)
        }
    }
}

/// sigma1 at velocity `v` and its derivative with respect to `v`, where the level is `g` with the derivative `g_slope`.
#[inline(always)]
pub(crate) fn micro_damping_and_slope<T: Real>(law: &LuGre<T>, v: T, g: T, g_slope: T) -> (T, T) {
    match law.damping() {
        Damping::Constant(s1) => (s1, T::ZERO),
        Damping::Capped(at_rest) if !may_bite(at_rest, v, g) => (at_rest, T::ZERO),
        _ => varied(law, v, g, g_slope),
    }
}

/// The same where sigma1 varies with velocity: a function of its own, so that it does not slow down every step.
#[inline(never)]
fn varied<T: Real>(law: &LuGre<T>, v: T, g: T, g_slope: T) -> (T, T) {
    match law.damping() {
        Damping::Constant(s1) => (s1, T::ZERO),
        Damping::Capped(at_rest) => {
            let limit = Cap::new(law.curve(), v, g);
            let cap = limit.value();
            if at_rest <= cap {
                return (at_rest, T::ZERO);
            }
            let sign = if v >= T::ZERO { T::ONE } else { -T::ONE };
            (cap, sign * limit.slope(cap, sign * g_slope))
        }
        Damping::Olsson { velocity, .. } => {
            let s1 = law.micro_damping_at_level(v, g);
            let x = v / velocity;
            (s1, -T::from_f64(2.0) * x / velocity * s1)
        }
    }
}

/// Whether the cap at the velocity `v`, level `g`, can be below `sigma1`: it is at least 4g/|v|, since u^2/(u - 1) is at
/// least 4 for u > 1.
#[inline(always)]
pub(crate) fn may_bite<T: Real>(sigma1: T, v: T, g: T) -> bool {
    sigma1 * v.abs() > T::from_f64(4.0) * g
}
