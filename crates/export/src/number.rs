//! Numbers as they are written in code: the shortest text that reads back as the same number.

use stiction_friction::Real;

/// A number type that can be written.
pub(crate) trait Literal: Real {
    /// As in C, with the suffix of its type.
    fn c(self) -> String;
    /// As in IEC 61131-3: always with a point, exponent `E`.
    fn st(self) -> String;
    /// As in YAML 1.1 and later: always with a point, and with a sign in the exponent.
    fn yaml(self) -> String {
        let text = self.st();
        match text.split_once('E') {
            Some((digits, power)) if !power.starts_with('-') => format!("{digits}e+{power}"),
            _ => text.replace('E', "e"),
        }
    }
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

/// Four digits, for messages.
pub(crate) fn short(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
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
    use super::Literal;

    #[test]
    fn literals_have_a_point_or_an_exponent() {
        assert_eq!(1e-5_f64.c(), "1e-5");
        assert_eq!(1e-5_f64.st(), "1.0E-5");
        assert_eq!(2e6_f64.c(), "2000000.0");
        assert_eq!(1e-5_f64.yaml(), "1.0e-5");
        assert_eq!(1e16_f64.yaml(), "1.0e+16");
        assert_eq!(f64::MAX.st(), "1.7976931348623157E308");
        assert_eq!(f32::MAX.c(), "3.4028235e38f");
    }
}
