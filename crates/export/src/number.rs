//! Numbers as they are written in code: the shortest text that reads back as the same number.

use stiction_friction::Real;

/// A number type that can be written.
pub(crate) trait Literal: Real {
    /// As in C, with the suffix of its type.
    fn c(self) -> String;
    /// As in IEC 61131-3: always with a point, exponent `E`.
    fn st(self) -> String;
}

impl Literal for f64 {
    fn c(self) -> String {
        format!("{self:?}")
    }
    fn st(self) -> String {
        iec(format!("{self:?}"))
    }
}

impl Literal for f32 {
    fn c(self) -> String {
        format!("{self:?}f")
    }
    fn st(self) -> String {
        iec(format!("{self:?}"))
    }
}

/// Four digits: enough to read.
pub(crate) fn short(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

/// A number in as few digits as read back the same, as it would be typed: `20`, `1e-40`.
pub fn shortest(x: f64) -> String {
    let plain = format!("{x:?}");
    let plain = plain.strip_suffix(".0").unwrap_or(&plain);
    let powers = format!("{x:e}");
    // Few read how many zeros there are.
    if x.abs() >= 1e7 && powers.len() < plain.len() {
        powers
    } else {
        plain.into()
    }
}

fn iec(text: String) -> String {
    match text.split_once('e') {
        None => text,
        Some((digits, exponent)) if digits.contains('.') => format!("{digits}E{exponent}"),
        Some((digits, exponent)) => format!("{digits}.0E{exponent}"),
    }
}

#[cfg(test)]
mod tests {
    use super::{Literal, shortest};

    #[test]
    fn numbers_are_as_typed() {
        let typed = [
            "20",
            "1000000",
            "2e7",
            "123456789",
            "1e-40",
            "0.0035",
            "-3",
            "1e300",
            "inf",
        ];
        for text in typed {
            assert_eq!(shortest(text.parse().unwrap()), text);
        }
    }

    #[test]
    fn literals_have_a_point_or_an_exponent() {
        assert_eq!(1e-5_f64.c(), "1e-5");
        assert_eq!(1e-5_f64.st(), "1.0E-5");
        assert_eq!(2e6_f64.c(), "2000000.0");
        assert_eq!(f64::MAX.st(), "1.7976931348623157E308");
        assert_eq!(f32::MAX.c(), "3.4028235e38f");
    }
}
