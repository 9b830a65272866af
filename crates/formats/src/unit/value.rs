//! A number with its unit: `35.15065188 N/V`, `100 Hz`, `-5 mm/s`.

use super::{Dimension, Unit};
use crate::{Error, Kind};
use std::fmt;

/// A number and the unit it was written in.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// The number as written, in `unit`; finite.
    pub number: f64,
    /// The unit as written; the plain number one where none was written.
    pub unit: Unit,
}

impl Value {
    /// Reads a number and a unit with or without a blank between them.
    ///
    /// # Errors
    /// [`Kind::Value`] where no finite number leads the text (a decimal comma is named as such),
    /// [`Kind::Unit`] where the rest is not a unit.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let text = text.trim();
        let length = number_length(text);
        let number = text[..length].parse::<f64>().ok().filter(|x| x.is_finite());
        let rest = text[length..].trim_start();
        let shown: String = text.chars().take(80).collect();
        let Some(number) = number else {
            let found = format!("{shown:?} does not begin with a finite number");
            return Err(Error::new(Kind::Value, found, EXAMPLE));
        };
        if rest.starts_with(',') {
            let found = format!("{shown:?} has a comma in its number");
            return Err(Error::new(Kind::Value, found, "write a decimal point"));
        }
        let unit = if rest.is_empty() {
            Unit::si(Dimension::ONE)
        } else {
            Unit::parse(rest)?
        };
        Ok(Self { number, unit })
    }

    /// The value in SI.
    pub fn si(&self) -> f64 {
        self.unit.to_si(self.number)
    }

    /// The value in SI, if it measures what is wanted.
    ///
    /// # Errors
    /// [`Kind::Unit`] naming both dimensions.
    pub fn si_of(&self, wanted: Dimension) -> Result<f64, Error> {
        if self.unit.dimension() == wanted {
            return Ok(self.si());
        }
        let found = format!("{self} is {}", article(self.unit.dimension()));
        let allowed = format!(
            "{} is needed here, as in {}",
            article(wanted),
            example(wanted)
        );
        Err(Error::new(Kind::Unit, found, allowed))
    }
}

const EXAMPLE: &str = "write a number and a unit, as in 35.15 N/V or 100 Hz";

fn article(dimension: Dimension) -> String {
    let name = dimension.name();
    let vowel = name.starts_with(['a', 'e', 'i', 'o', 'u']);
    format!("{} {name}", if vowel { "an" } else { "a" })
}

fn example(wanted: Dimension) -> String {
    if wanted == Dimension::ONE {
        "2.5".to_string()
    } else {
        format!("2.5 {}", wanted.si_text())
    }
}

/// Bytes of the decimal number that leads the text.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| {
        let run = bytes
            .iter()
            .skip(from)
            .take_while(|b| b.is_ascii_digit())
            .count();
        from + run
    };
    let mut end = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    end = digits(end);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let after = digits(end + 1 + sign);
        if after > end + 1 + sign {
            end = after;
        }
    }
    end
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.number.abs();
        if size == 0.0 || (1e-5..1e16).contains(&size) {
            write!(f, "{}", self.number)?;
        } else {
            write!(f, "{:e}", self.number)?;
        }
        if self.unit.text() == "1" {
            Ok(())
        } else {
            write!(f, " {}", self.unit)
        }
    }
}

impl std::str::FromStr for Value {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        Self::parse(text)
    }
}
