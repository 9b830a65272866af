//! Laws without memory.

use crate::{ParamError, Real, Stribeck};

/// Coulomb and viscous friction: `F = sgn(v) Fc + sigma2 v + F0`; at rest F0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoulombViscous<T> {
    coulomb: [T; 2],
    viscous: [T; 2],
    offset: T,
}

impl<T: Real> CoulombViscous<T> {
    /// The same in both directions: `coulomb` Fc >= 0 in N (N m), `viscous` sigma2 >= 0 in N s/m (N m s/rad), `offset`
    /// F0 in N (N m).
    pub fn symmetric(coulomb: T, viscous: T, offset: T) -> Result<Self, ParamError> {
        ParamError::not_negative("coulomb", coulomb)?;
        ParamError::not_negative("sigma2", viscous)?;
        ParamError::finite("offset", offset)?;
        Ok(CoulombViscous {
            coulomb: [coulomb; 2],
            viscous: [viscous; 2],
            offset,
        })
    }

    /// Separate numbers for each direction, each pair `[v >= 0, v < 0]`; units and ranges as for `symmetric`.
    pub fn new(coulomb: [T; 2], viscous: [T; 2], offset: T) -> Result<Self, ParamError> {
        ParamError::not_negative("coulomb_pos", coulomb[0])?;
        ParamError::not_negative("coulomb_neg", coulomb[1])?;
        ParamError::not_negative("sigma2_pos", viscous[0])?;
        ParamError::not_negative("sigma2_neg", viscous[1])?;
        ParamError::finite("offset", offset)?;
        Ok(CoulombViscous {
            coulomb,
            viscous,
            offset,
        })
    }

    /// Coulomb levels `[v >= 0, v < 0]`, N (N m).
    pub fn coulomb(&self) -> [T; 2] {
        self.coulomb
    }

    /// Viscous coefficients `[v >= 0, v < 0]`, N s/m (N m s/rad).
    pub fn viscous(&self) -> [T; 2] {
        self.viscous
    }

    /// Force at rest F0, N (N m).
    pub fn offset(&self) -> T {
        self.offset
    }

    /// Friction force at velocity `v` (m/s, rad/s), N (N m).
    pub fn force(&self, v: T) -> T {
        if v > T::ZERO {
            self.coulomb[0] + self.viscous[0] * v + self.offset
        } else if v < T::ZERO {
            -self.coulomb[1] + self.viscous[1] * v + self.offset
        } else {
            self.offset
        }
    }
}

/// A Stribeck curve made continuous through zero: `F = g(v) tanh(v/vt) + sigma2 v + F0`.
///
/// Smooth enough for a solver that cannot take a jump, at the price that it creeps under any load: it cannot stick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TanhRegularised<T> {
    curve: Stribeck<T>,
    velocity: T,
}

impl<T: Real> TanhRegularised<T> {
    /// The curve to smooth, and the velocity vt > 0 (m/s, rad/s) over which the jump is smoothed, well below vs.
    pub fn new(curve: Stribeck<T>, velocity: T) -> Result<Self, ParamError> {
        ParamError::positive("regularisation_velocity", velocity)?;
        Ok(TanhRegularised { curve, velocity })
    }

    /// The curve that is approached at speed.
    pub fn curve(&self) -> &Stribeck<T> {
        &self.curve
    }

    /// The velocity vt, m/s (rad/s).
    pub fn velocity(&self) -> T {
        self.velocity
    }

    /// Friction force at velocity `v` (m/s, rad/s), N (N m).
    pub fn force(&self, v: T) -> T {
        self.curve.level(v) * (v / self.velocity).tanh()
            + self.curve.direction(v).viscous * v
            + self.curve.offset()
    }
}
