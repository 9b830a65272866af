//! The two number types a law can be computed in.

use crate::exponential::{exp, expm1};
use core::fmt::{Debug, Display};
use core::ops::{Add, Div, Mul, Neg, Sub};

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// `f32` or `f64`. Sealed: no other type implements it.
///
/// Every transcendental function is Rust's own arithmetic (`libm`; the exponentials of `f64` are the crate's), never the
/// platform's C library, so that a law gives the same bits on a desktop, a drive and a web page.
pub trait Real:
    sealed::Sealed
    + Copy
    + PartialOrd
    + Default
    + Debug
    + Display
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Send
    + Sync
    + 'static
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// The largest finite number.
    const MAX: Self;
    /// Largest argument a for which `1 + expm1(-a)/a` is taken from its series: above it the subtraction keeps enough digits,
    /// up to it six terms are exact to rounding.
    const SERIES_BELOW: Self;

    /// The nearest number of this type.
    fn from_f64(value: f64) -> Self;
    /// The same value as `f64`, exactly.
    fn to_f64(self) -> f64;
    /// Magnitude.
    fn abs(self) -> Self;
    /// The larger of the two. If self is NaN the result is `other`; if `other` is NaN the result is NaN. This is one
    /// instruction; ignoring a NaN on either side would take six.
    fn max(self, other: Self) -> Self;
    /// The smaller of the two. If self is NaN the result is `other`; if `other` is NaN the result is NaN.
    fn min(self, other: Self) -> Self;
    /// Neither infinite nor NaN.
    fn is_finite(self) -> bool;
    /// The largest whole number that is not above self.
    fn floor(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// e to the power of self.
    fn exp(self) -> Self;
    /// `exp(self) - 1` without loss of digits near 0.
    fn expm1(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Sine of an angle in rad.
    fn sin(self) -> Self;
    /// Cosine of an angle in rad.
    fn cos(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Self to the power of `exponent`.
    fn powf(self, exponent: Self) -> Self;
}

macro_rules! real {
    ($t:ident, $series_below:literal, $floor:ident, $sqrt:ident, $exp:path, $expm1:path, $ln:ident, $sin:ident, $cos:ident, $tanh:ident, $pow:ident) => {
        impl Real for $t {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const MAX: Self = $t::MAX;
            const SERIES_BELOW: Self = $series_below;

            #[inline]
            fn from_f64(value: f64) -> Self {
                value as $t
            }
            #[inline]
            fn to_f64(self) -> f64 {
                self as f64
            }
            #[inline]
            fn abs(self) -> Self {
                $t::abs(self)
            }
            #[inline]
            fn max(self, other: Self) -> Self {
                if self > other { self } else { other }
            }
            #[inline]
            fn min(self, other: Self) -> Self {
                if self < other { self } else { other }
            }
            #[inline]
            fn is_finite(self) -> bool {
                $t::is_finite(self)
            }
            #[inline]
            fn floor(self) -> Self {
                libm::$floor(self)
            }
            #[inline]
            fn sqrt(self) -> Self {
                libm::$sqrt(self)
            }
            #[inline(always)]
            fn exp(self) -> Self {
                $exp(self)
            }
            #[inline(always)]
            fn expm1(self) -> Self {
                $expm1(self)
            }
            #[inline]
            fn ln(self) -> Self {
                libm::$ln(self)
            }
            #[inline]
            fn sin(self) -> Self {
                libm::$sin(self)
            }
            #[inline]
            fn cos(self) -> Self {
                libm::$cos(self)
            }
            #[inline]
            fn tanh(self) -> Self {
                libm::$tanh(self)
            }
            #[inline]
            fn powf(self, exponent: Self) -> Self {
                libm::$pow(self, exponent)
            }
        }
    };
}

real!(
    f32,
    0.2,
    floorf,
    sqrtf,
    libm::expf,
    libm::expm1f,
    logf,
    sinf,
    cosf,
    tanhf,
    powf
);
real!(f64, 0.01, floor, sqrt, exp, expm1, log, sin, cos, tanh, pow);
