//! The exponentials of the laws, inlined: those of the friction crate.

use stiction_friction::Real;

/// `exp(x)`.
#[inline(always)]
pub(crate) fn exp(x: f64) -> f64 {
    Real::exp(x)
}

/// `exp(x) - 1`.
#[inline(always)]
pub(crate) fn expm1(x: f64) -> f64 {
    Real::expm1(x)
}
