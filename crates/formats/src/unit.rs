//! Units at the edges: text such as `mm/s`, `N m` or `35.15 N/V` becomes a factor to SI and a
//! [`Dimension`]; everything inside stiction is plain `f64` in SI.
//!
//! A unit is a product of symbols with powers, written as people write it: `N m`, `N*m`, `N·m`,
//! `N-m`, `Nm`, `kg m2`, `kg*m^2`, `m/s²`, `m s-1`, `V/(m/s)`. Rules that keep it unambiguous:
//!
//! * Case counts. `mN` is a thousandth of a newton, `MN` a million; `Mm` and `NM` are unknown, and
//!   the error lists what is near.
//! * The longest known symbol wins: `min` is a minute, `mm` a millimetre, `m` alone a metre.
//! * A force or mass symbol directly before a length is a product (`Nm`, `mNm`, `kgcm2`); nothing
//!   else runs together, so `Nms` is refused and `N m s` is understood.
//! * After a division, a further factor needs an operator or brackets: `N/m s` is refused, `N s/m` and
//!   `N/(m s)` are understood, `a/b/c` divides twice.
//! * `1/min`, `min-1`, `U/min` and `r/min` are revolutions a minute, as drives mean them; `1/s` is
//!   a plain rate, not a speed.
//! * Angle and encoder counts are dimensions of their own, so a torque over a velocity is not
//!   mistaken for something linear, and `1 um/count` says what it says.
//! * `Arms` and `Apk` are amperes with a note: rms and peak differ by sqrt(2), and a
//!   torque constant must use the same convention.

mod dimension;
mod near;
mod parse;
mod symbol;
mod value;

use crate::Error;
pub use crate::text::unit::is_known;
pub use dimension::Dimension;
use dimension::Factor;
pub use near::nearest;
use std::fmt;
pub use value::Value;

/// Longest text of a unit in characters; longer ones are refused.
pub const MAX_UNIT_CHARS: usize = 64;

/// A unit of measurement: how it was written, its dimension and its factor to SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    text: String,
    dimension: Dimension,
    factor: Factor,
    offset: f64,
    note: Option<&'static str>,
}

impl Unit {
    /// Reads a unit such as `mm`, `N*m/A` or `1/min`.
    ///
    /// # Errors
    /// [`Kind::Unit`](crate::Kind::Unit) with near matches where a symbol is unknown, and with a
    /// clearer spelling where the text is ambiguous.
    pub fn parse(text: &str) -> Result<Self, Error> {
        parse::unit(text)
    }

    /// The coherent SI unit of a dimension (`N*m/A`, `rad/s`); its factor is one.
    pub fn si(dimension: Dimension) -> Self {
        Self {
            text: dimension.si_text(),
            dimension,
            factor: Factor::ONE,
            offset: 0.0,
            note: None,
        }
    }

    /// The unit as it was written, without surrounding blanks.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// What is measured.
    pub fn dimension(&self) -> Dimension {
        self.dimension
    }

    /// SI value of one of this unit (for `degC`: of a difference of one).
    pub fn factor(&self) -> f64 {
        self.factor.apply(1.0)
    }

    /// A number in this unit as a number in SI; decimal prefixes cost one rounding.
    pub fn to_si(&self, number: f64) -> f64 {
        self.factor.apply(number) + self.offset
    }

    /// What a reader should know about this unit, such as an amplitude convention.
    pub fn note(&self) -> Option<&'static str> {
        self.note
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl std::str::FromStr for Unit {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        Self::parse(text)
    }
}
