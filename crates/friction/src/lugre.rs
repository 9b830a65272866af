//! The LuGre law itself; its steps are in `record` and `realtime`.

use crate::damping::{may_bite, passive_cap};
use crate::error::require;
use crate::{Damping, ParamError, Real, Stribeck};

/// The LuGre friction law, validated and immutable.
///
/// ```text
/// z' = v - sigma0 |v| z / g(v)            bristle deflection z, m (rad)
/// F  = sigma0 z + sigma1(v) z' + sigma2 v + F0
/// ```
/// Source: Canudas de Wit, Olsson, Astrom, Lischinsky 1995, doi 10.1109/9.376053, eqs. 1-3, with g in newtons.
/// Asymmetric: g and sigma2 per direction of motion, z continuous through reversal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LuGre<T> {
    stiffness: T,
    damping: Damping<T>,
    curve: Stribeck<T>,
    bound: T,
}

impl<T: Real> LuGre<T> {
    /// `stiffness` sigma0 in N/m (N m/rad), finite, > 0, and such that the largest deflection Fs/sigma0 is well within the
    /// range of the number type; the micro-damping; the steady curve with sigma2 and F0.
    pub fn new(stiffness: T, damping: Damping<T>, curve: Stribeck<T>) -> Result<Self, ParamError> {
        ParamError::positive("sigma0", stiffness)?;
        damping.validate()?;
        let bound = curve.largest_static_level() / stiffness;
        // Differences of two deflections must not overflow, nor deflections vanish.
        require(
            bound > T::ZERO && (bound * T::from_f64(4.0)).is_finite(),
            "sigma0",
            stiffness,
            "static/sigma0 within the range of the number type",
        )?;
        Ok(LuGre {
            stiffness,
            damping,
            curve,
            bound,
        })
    }

    /// Stiffness sigma0, N/m (N m/rad).
    pub fn stiffness(&self) -> T {
        self.stiffness
    }

    /// The micro-damping: its form and parameters.
    pub fn damping(&self) -> Damping<T> {
        self.damping
    }

    /// The steady curve.
    pub fn curve(&self) -> &Stribeck<T> {
        &self.curve
    }

    /// The largest |z| that any motion can lead to, `max(Fs+, Fs-)/sigma0`, m (rad).
    #[inline]
    pub fn bound(&self) -> T {
        self.bound
    }

    /// The same law with another micro-damping.
    pub fn with_damping(&self, damping: Damping<T>) -> Result<Self, ParamError> {
        Self::new(self.stiffness, damping, self.curve)
    }

    /// The same law in another number type; an error if a number does not survive the change.
    pub fn cast<U: Real>(&self) -> Result<LuGre<U>, ParamError> {
        LuGre::new(
            U::from_f64(self.stiffness.to_f64()),
            self.damping.cast(),
            self.curve.cast()?,
        )
    }

    /// `z'` in m/s (rad/s) at deflection `z` (m, rad) and velocity `v` (m/s, rad/s).
    #[inline]
    pub fn deflection_rate(&self, z: T, v: T) -> T {
        self.rate_at_level(z, v, self.curve.level(v))
    }

    /// Friction force in N (N m) at deflection `z` and velocity `v`, with `z'` from the state equation.
    #[inline]
    pub fn force(&self, z: T, v: T) -> T {
        let g = self.curve.level(v);
        self.force_of(
            z,
            self.rate_at_level(z, v, g),
            v,
            self.micro_damping_at_level(v, g),
        )
    }

    /// Friction force in N (N m) at deflection `z`, a given deflection rate (m/s, rad/s) and velocity `v`.
    #[inline]
    pub fn force_at_rate(&self, z: T, rate: T, v: T) -> T {
        self.force_of(z, rate, v, self.micro_damping(v))
    }

    /// sigma1 at velocity `v`, N s/m (N m s/rad).
    #[inline]
    pub fn micro_damping(&self, v: T) -> T {
        match self.damping {
            // Only the cap needs the level, and the level is an exponential.
            Damping::Capped(_) => self.micro_damping_at_level(v, self.curve.level(v)),
            _ => self.micro_damping_at_level(v, T::ONE),
        }
    }

    /// The largest sigma1, N s/m (N m s/rad), with which the law cannot release energy at velocity `v`.
    ///
    /// With `y = max(Fs+, Fs-)`: `(2g/|v|)(1 + sqrt(1 + sigma2|v|/g))` while a bristle can reach the worst force,
    /// else `(sigma2 + y^2/(g|v|))/(y/g - 1)`; unlimited (the largest number) at rest and where g is not below y.
    /// As v goes to infinity the limit for a symmetric law is `sigma2 Fc/(Fs - Fc)`, the condition of Olsson 1996.
    #[inline]
    pub fn passive_cap(&self, v: T) -> T {
        passive_cap(&self.curve, v, self.curve.level(v))
    }

    #[inline]
    pub(crate) fn rate_at_level(&self, z: T, v: T, g: T) -> T {
        v - v.abs() * (self.stiffness * z / g)
    }

    #[inline]
    pub(crate) fn micro_damping_at_level(&self, v: T, g: T) -> T {
        match self.damping {
            Damping::Constant(s1) => s1,
            Damping::Capped(s1) if !may_bite(s1, v, g) => s1,
            Damping::Capped(s1) => passive_cap(&self.curve, v, g).min(s1),
            Damping::Olsson { sigma1, velocity } => {
                let x = v / velocity;
                sigma1 * (-(x * x)).exp()
            }
        }
    }

    #[inline]
    pub(crate) fn force_of(&self, z: T, rate: T, v: T, s1: T) -> T {
        self.stiffness * z + s1 * rate + self.curve.direction(v).viscous * v + self.curve.offset()
    }
}
