//! What a parameter may be.

/// The values that a parameter may have, in SI units; every one is finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Allowed {
    /// Any finite number.
    Any,
    /// 0 or above.
    NotNegative,
    /// Above 0.
    Positive,
    /// Above 0 and below 1.
    Share,
    /// An exponent of the Stribeck curve, .1 to 10: 2 is the Gaussian curve, .5 to 2 are met in practice.
    Exponent,
    /// A delay of either sign, -1 s to 1 s: far beyond any drive.
    Delay,
}

impl Allowed {
    /// Smallest and largest exponent of a Stribeck curve.
    pub const EXPONENTS: std::ops::RangeInclusive<f64> = 0.1..=10.0;
    /// Smallest and largest delay, s.
    pub const DELAYS: std::ops::RangeInclusive<f64> = -1.0..=1.0;

    /// Whether a value is among them.
    pub fn admits(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Allowed::Any => true,
                Allowed::NotNegative => value >= 0.0,
                Allowed::Positive => value > 0.0,
                Allowed::Share => value > 0.0 && value < 1.0,
                Allowed::Exponent => Self::EXPONENTS.contains(&value),
                Allowed::Delay => Self::DELAYS.contains(&value),
            }
    }

    /// Whether nothing below 0 is among them.
    pub fn is_never_negative(self) -> bool {
        !matches!(self, Allowed::Any | Allowed::Delay)
    }

    /// Them in words that complete "allowed: ...".
    pub fn words(self) -> &'static str {
        match self {
            Allowed::Any => "any number",
            Allowed::NotNegative => "not negative",
            Allowed::Positive => "above 0",
            Allowed::Share => "above 0 and below 1",
            Allowed::Exponent => "from 0.1 to 10",
            Allowed::Delay => "from -1 s to 1 s",
        }
    }
}
