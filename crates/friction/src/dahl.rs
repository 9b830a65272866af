//! Dahl's law, a special case of LuGre.

use crate::{Damping, Direction, LuGre, ParamError, Real, Shape, Stribeck};

/// Dahl's law with exponent 1: `z' = v - sigma0 |v| z/Fc`, `F = sigma0 z + F0`.
///
/// Hysteresis in presliding and Coulomb friction in sliding, no Stribeck effect. Source: Dahl 1976,
/// doi 10.2514/3.61511. It is LuGre with Fs = Fc and sigma1 = 0, and [`law`](Self::law) gives it as such: all steps are
/// those of [`LuGre`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dahl<T>(LuGre<T>);

impl<T: Real> Dahl<T> {
    /// `stiffness` sigma0 > 0 in N/m (N m/rad), Coulomb levels `[v >= 0, v < 0]`, > 0, and `offset` in N (N m).
    pub fn new(stiffness: T, coulomb: [T; 2], offset: T) -> Result<Self, ParamError> {
        let side = |level: T| Direction {
            coulomb: level,
            static_friction: level,
            stribeck_velocity: T::ONE,
            viscous: T::ZERO,
        };
        let curve = Stribeck::new(
            Shape::Lorentzian,
            side(coulomb[0]),
            side(coulomb[1]),
            offset,
        )?;
        LuGre::new(stiffness, Damping::Constant(T::ZERO), curve).map(Dahl)
    }

    /// The law as a [`LuGre`], which has the step functions.
    pub fn law(&self) -> &LuGre<T> {
        &self.0
    }
}
