//! Units that the page shows in place of SI: those in which machines are set up.

use serde::Serialize;
use std::f64::consts::PI;

/// A unit that is shown in place of that of SI.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Shown<'a> {
    /// The unit of SI.
    si: &'a str,
    /// The unit that is shown.
    pub unit: &'a str,
    /// Number of it in one of SI.
    by: f64,
    /// What is shown of 0 in SI.
    zero: f64,
}

/// All of them; any other unit is shown as it is.
pub const SHOWN: [Shown<'_>; 5] = [
    shown("m", "mm", 1e3, 0.0),
    shown("m/s", "mm/s", 1e3, 0.0),
    shown("rad", "deg", 180.0 / PI, 0.0),
    shown("rad/s", "deg/s", 180.0 / PI, 0.0),
    shown("K", "degC", 1.0, -273.15),
];

const fn shown<'a>(si: &'a str, unit: &'a str, by: f64, zero: f64) -> Shown<'a> {
    Shown { si, unit, by, zero }
}

impl<'a> Shown<'a> {
    /// The unit that is shown in place of this one.
    pub fn of(si: &'a str) -> Self {
        let found = SHOWN.into_iter().find(|own| own.si == si);
        found.unwrap_or(shown(si, si, 1.0, 0.0))
    }

    /// A number of SI in the unit that is shown.
    pub fn number(&self, si: f64) -> f64 {
        self.by * si + self.zero
    }
}

#[cfg(test)]
mod tests {
    use super::Shown;

    #[test]
    fn lengths_angles_and_temperatures_are_those_of_machines() {
        for (si, unit, number, wanted) in [
            ("m", "mm", 0.25, 250.0),
            ("rad/s", "deg/s", std::f64::consts::PI, 180.0),
            ("K", "degC", 293.15, 20.0),
            ("N*m", "N*m", 3.0, 3.0),
        ] {
            let shown = Shown::of(si);
            assert_eq!(shown.unit, unit);
            assert!((shown.number(number) - wanted).abs() < 1e-9, "{unit}");
        }
    }
}
