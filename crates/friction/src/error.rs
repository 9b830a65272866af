//! The error of a parameter outside its range.

use crate::Real;
use core::fmt;

/// A parameter outside the range that a law allows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParamError {
    /// Which parameter: `sigma0`, `sigma1`, `sigma2`, `coulomb`, `static`, `stribeck_velocity`, `stribeck_exponent`,
    /// `offset`, ...; with `_pos` or `_neg` where the two directions of motion differ.
    pub name: &'static str,
    /// The value found, in the parameter's SI unit.
    pub value: f64,
    /// What is allowed, in words that complete "allowed: ...".
    pub allowed: &'static str,
}

impl ParamError {
    /// Describes a rejected `value` of the parameter `name`.
    pub fn new<T: Real>(name: &'static str, value: T, allowed: &'static str) -> Self {
        ParamError {
            name,
            value: value.to_f64(),
            allowed,
        }
    }

    /// `Ok` if `value` is finite and `> 0`.
    pub fn positive<T: Real>(name: &'static str, value: T) -> Result<(), Self> {
        require(
            value.is_finite() && value > T::ZERO,
            name,
            value,
            "finite and > 0",
        )
    }

    /// `Ok` if `value` is finite and `>= 0`.
    pub fn not_negative<T: Real>(name: &'static str, value: T) -> Result<(), Self> {
        require(
            value.is_finite() && value >= T::ZERO,
            name,
            value,
            "finite and >= 0",
        )
    }

    /// `Ok` if `value` is finite.
    pub fn finite<T: Real>(name: &'static str, value: T) -> Result<(), Self> {
        require(value.is_finite(), name, value, "finite")
    }
}

pub(crate) fn require<T: Real>(
    holds: bool,
    name: &'static str,
    value: T,
    allowed: &'static str,
) -> Result<(), ParamError> {
    if holds {
        Ok(())
    } else {
        Err(ParamError::new(name, value, allowed))
    }
}

impl fmt::Display for ParamError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.value.abs();
        // Very large and very small values with a power of ten, to avoid long runs of zeros.
        if size >= 1e9 || (size > 0.0 && size < 1e-6) {
            write!(f, "{} = {:e}", self.name, self.value)?;
        } else {
            write!(f, "{} = {}", self.name, self.value)?;
        }
        write!(f, "; allowed: {}", self.allowed)
    }
}

impl core::error::Error for ParamError {}
