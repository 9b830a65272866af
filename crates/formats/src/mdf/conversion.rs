//! From what is stored to the quantity: the conversions of a channel that numbers have.

use super::source::{Block, bad};
use crate::Error;

/// What a number that is stored becomes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Conversion {
    /// Itself.
    None,
    /// An offset, and a factor of it.
    Linear(f64, f64),
    /// The quotient of two polynomials of degree 2, from the square down to the constant, the divisor last.
    Rational([f64; 6]),
}

impl Conversion {
    /// What a block says; why its channel is left out where that is no formula for numbers.
    pub(super) fn new(block: &Block) -> Result<Result<Self, &'static str>, Error> {
        if block.mark != *b"CC" {
            return Err(bad(block.at, "a link to a conversion that is none"));
        }
        let numbers = usize::from(block.half(6));
        let value = |number: usize| block.float(24 + 8 * number);
        let needs = |count: usize| match numbers >= count {
            true => Ok(()),
            false => Err(bad(
                block.at,
                format!("a conversion with {numbers} numbers that needs {count}"),
            )),
        };
        Ok(match block.byte(0) {
            0 => Ok(Conversion::None),
            1 => {
                needs(2)?;
                Ok(Conversion::Linear(value(0), value(1)))
            }
            2 => {
                needs(6)?;
                Ok(Conversion::Rational(std::array::from_fn(value)))
            }
            3 => Err("its conversion is a formula in text"),
            4..=6 => Err("its conversion is a table"),
            7..=11 => Err("its conversion is to or from text"),
            _ => Err("its conversion is of an unknown kind"),
        })
    }

    /// Converts numbers in place.
    pub(super) fn apply(self, values: &mut [f64]) {
        match self {
            Conversion::None => {}
            // A sum with 0 would take the sign of a zero.
            Conversion::Linear(0.0, factor) => values.iter_mut().for_each(|x| *x *= factor),
            Conversion::Linear(offset, factor) => {
                values.iter_mut().for_each(|x| *x = *x * factor + offset);
            }
            Conversion::Rational([a, b, c, d, e, f]) => values.iter_mut().for_each(|x| {
                let square = *x * *x;
                *x = (a * square + b * *x + c) / (d * square + e * *x + f);
            }),
        }
    }
}
