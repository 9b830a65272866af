//! How fast friction falls from its static to its Coulomb level.

use crate::error::require;
use crate::{ParamError, Real};

/// The weight `w(x)` in `g(v) = Fc + (Fs - Fc) w(|v|/vs)`: 1 at rest, falling to 0 with speed.
///
/// Gaussian is the form of Canudas de Wit et al. 1995 (doi 10.1109/9.376053, eq. 4) and the default in the field; the
/// others are in use for lubricated guides and gears (Olsson et al. 1998, doi 10.1016/S0947-3580(98)70113-X, section 2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape<T> {
    /// `exp(-x^2)`
    Gaussian,
    /// `exp(-x)`
    Exponential,
    /// `exp(-x^delta)`; the exponent delta is dimensionless, finite and > 0 (0.5 to 2 in practice).
    Power(T),
    /// `1/(1 + x^2)`
    Lorentzian,
}

impl<T: Real> Shape<T> {
    /// `exp(-x^delta)` in its simplest form: Gaussian for an exponent of 2, exponential for 1, else the power. The
    /// curve is the same; where the derivatives differ the simpler form is exact, since the power takes the
    /// derivative at rest as 0.
    pub fn with_exponent(delta: T) -> Self {
        if delta == T::from_f64(2.0) {
            Shape::Gaussian
        } else if delta == T::ONE {
            Shape::Exponential
        } else {
            Shape::Power(delta)
        }
    }

    /// The exponent delta of `exp(-x^delta)`, dimensionless; `None` for another form.
    pub fn exponent(self) -> Option<T> {
        match self {
            Shape::Gaussian => Some(T::from_f64(2.0)),
            Shape::Exponential => Some(T::ONE),
            Shape::Power(delta) => Some(delta),
            Shape::Lorentzian => None,
        }
    }

    /// Derivative of the weight with respect to the exponent delta, `-x^delta ln(x) w`; 0 for a form without exponent, and
    /// at rest and far from it, where the weight does not depend on the exponent.
    pub fn weight_by_exponent(self, x: T) -> T {
        let w = self.weight(x);
        if w == T::ZERO || x == T::ZERO {
            return T::ZERO;
        }
        let power = match self {
            Shape::Gaussian => x * x,
            Shape::Exponential => x,
            Shape::Power(delta) => x.powf(delta),
            Shape::Lorentzian => return T::ZERO,
        };
        -power * x.ln() * w
    }

    /// The weight at `x = |v|/vs >= 0`, in 0..=1, for any `x` up to infinity.
    #[inline(always)]
    pub fn weight(self, x: T) -> T {
        let exponent = match self {
            Shape::Gaussian => x * x,
            Shape::Exponential => x,
            Shape::Power(delta) => x.powf(delta),
            Shape::Lorentzian => return T::ONE / (T::ONE + x * x),
        };
        (-exponent).exp()
    }

    /// The weight and its derivative with respect to `x`.
    ///
    /// At `x = 0` the derivative is taken as 0 for `Power` (below an exponent of 1 it is infinite there).
    #[inline(always)]
    pub fn weight_and_slope(self, x: T) -> (T, T) {
        let two = T::from_f64(2.0);
        let w = self.weight(x);
        // A vanished weight has a vanished slope; computing it would be 0 times infinity.
        if w == T::ZERO {
            return (w, T::ZERO);
        }
        let slope = match self {
            Shape::Gaussian => -two * x * w,
            Shape::Exponential => -w,
            Shape::Power(_) if x == T::ZERO => T::ZERO,
            Shape::Power(delta) => -delta * x.powf(delta - T::ONE) * w,
            Shape::Lorentzian => -two * x * w * w,
        };
        (w, slope)
    }

    /// The same shape in another number type.
    pub fn cast<U: Real>(self) -> Shape<U> {
        match self {
            Shape::Gaussian => Shape::Gaussian,
            Shape::Exponential => Shape::Exponential,
            Shape::Power(delta) => Shape::Power(U::from_f64(delta.to_f64())),
            Shape::Lorentzian => Shape::Lorentzian,
        }
    }

    pub(crate) fn validate(self) -> Result<(), ParamError> {
        match self {
            Shape::Power(delta) => require(
                delta.is_finite() && delta > T::ZERO,
                "stribeck_exponent",
                delta,
                "finite and > 0",
            ),
            _ => Ok(()),
        }
    }
}
