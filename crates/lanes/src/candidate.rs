//! The parameters that a search tries.

use crate::Error;
use stiction_friction::{Damping, Direction, LuGre, ParamError, Shape, Stribeck};

/// A symmetric LuGre law with constant micro-damping, as plain numbers: N, m/s (N m, rad/s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// sigma0, > 0, N/m (N m/rad).
    pub stiffness: f64,
    /// sigma1, >= 0, N s/m (N m s/rad).
    pub micro_damping: f64,
    /// sigma2, >= 0, N s/m (N m s/rad).
    pub viscous: f64,
    /// Fc, > 0, N (N m).
    pub coulomb: f64,
    /// Fs >= Fc, N (N m).
    pub static_friction: f64,
    /// vs, > 0, m/s (rad/s).
    pub stribeck_velocity: f64,
    /// delta in `exp(-|v/vs|^delta)`, > 0; 2 costs one exponential less than any other.
    pub exponent: f64,
}

impl Candidate {
    /// From `[sigma0, sigma1, sigma2, Fc, Fs, vs]`, with the exponent 2.
    pub fn gaussian([s0, s1, s2, fc, fs, vs]: [f64; 6]) -> Self {
        Candidate {
            stiffness: s0,
            micro_damping: s1,
            viscous: s2,
            coulomb: fc,
            static_friction: fs,
            stribeck_velocity: vs,
            exponent: 2.0,
        }
    }

    /// The law itself; an error names the parameter that is out of its range.
    pub fn law(&self) -> Result<LuGre<f64>, ParamError> {
        let shape = Shape::with_exponent(self.exponent);
        let both = Direction {
            coulomb: self.coulomb,
            static_friction: self.static_friction,
            stribeck_velocity: self.stribeck_velocity,
            viscous: self.viscous,
        };
        let curve = Stribeck::symmetric(shape, both, 0.0)?;
        LuGre::new(self.stiffness, Damping::Constant(self.micro_damping), curve)
    }
}

/// An error for the first candidate with a parameter out of its range.
pub(crate) fn check(candidates: &[Candidate]) -> Result<(), Error> {
    for (index, candidate) in candidates.iter().enumerate() {
        candidate
            .law()
            .map_err(|source| Error::Candidate { index, source })?;
    }
    Ok(())
}
