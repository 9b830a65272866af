//! Numbers that the dynamics are computed with: `f64`, and a dual number for exact derivatives.

use std::ops::{Add, AddAssign, Mul, Neg, Sub};

/// A number of the dynamics.
pub trait Scalar:
    Copy
    + Add<Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + From<f64>
{
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
}

impl Scalar for f64 {
    fn sin_cos(self) -> (f64, f64) {
        libm::sincos(self)
    }
}

/// A value and its derivative with respect to one variable (forward-mode differentiation).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dual {
    /// Value.
    pub value: f64,
    /// Derivative.
    pub slope: f64,
}

impl From<f64> for Dual {
    fn from(value: f64) -> Self {
        Self { value, slope: 0.0 }
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: self.slope + other.slope,
        }
    }
}

impl AddAssign for Dual {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            slope: self.value * other.slope + self.slope * other.value,
        }
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            value: -self.value,
            slope: -self.slope,
        }
    }
}

impl Scalar for Dual {
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = libm::sincos(self.value);
        let dual = |value, slope| Self { value, slope };
        (dual(sin, cos * self.slope), dual(cos, -sin * self.slope))
    }
}
