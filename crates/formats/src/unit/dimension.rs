//! What is measured, as exponents of base quantities, and the factor of a unit to SI.

use std::fmt;

/// Exponents of metre, kilogram, second, ampere, kelvin, radian and encoder count.
///
/// Radian and count are kept as dimensions of their own: `rad/s` is not `Hz`, and `um/count` is not
/// a length.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Dimension {
    exponents: [i8; 7],
}

/// Largest exponent of a base quantity; beyond it a unit is a typing error.
const MAX_EXPONENT: i32 = 12;

/// Symbols of the base quantities, in the order of the exponents.
const BASE: [&str; 7] = ["m", "kg", "s", "A", "K", "rad", "count"];

const fn of(exponents: [i8; 7]) -> Dimension {
    Dimension { exponents }
}

impl Dimension {
    /// A plain number.
    pub const ONE: Self = of([0; 7]);
    /// Time, s.
    pub const TIME: Self = of([0, 0, 1, 0, 0, 0, 0]);
    /// Frequency or rate, Hz = 1/s.
    pub const FREQUENCY: Self = of([0, 0, -1, 0, 0, 0, 0]);
    /// Length, m.
    pub const LENGTH: Self = of([1, 0, 0, 0, 0, 0, 0]);
    /// Angle, rad.
    pub const ANGLE: Self = of([0, 0, 0, 0, 0, 1, 0]);
    /// Velocity, m/s.
    pub const LINEAR_VELOCITY: Self = of([1, 0, -1, 0, 0, 0, 0]);
    /// Angular velocity, rad/s.
    pub const ANGULAR_VELOCITY: Self = of([0, 0, -1, 0, 0, 1, 0]);
    /// Acceleration, m/s^2.
    pub const LINEAR_ACCELERATION: Self = of([1, 0, -2, 0, 0, 0, 0]);
    /// Angular acceleration, rad/s^2.
    pub const ANGULAR_ACCELERATION: Self = of([0, 0, -2, 0, 0, 1, 0]);
    /// Mass, kg.
    pub const MASS: Self = of([0, 1, 0, 0, 0, 0, 0]);
    /// Moment of inertia, kg m^2.
    pub const INERTIA: Self = of([2, 1, 0, 0, 0, 0, 0]);
    /// Force, N.
    pub const FORCE: Self = of([1, 1, -2, 0, 0, 0, 0]);
    /// Torque, N m.
    pub const TORQUE: Self = of([2, 1, -2, 0, 0, 0, 0]);
    /// Current, A.
    pub const CURRENT: Self = of([0, 0, 0, 1, 0, 0, 0]);
    /// Voltage, V.
    pub const VOLTAGE: Self = of([2, 1, -3, -1, 0, 0, 0]);
    /// Electrical resistance, ohm.
    pub const RESISTANCE: Self = of([2, 1, -3, -2, 0, 0, 0]);
    /// Inductance, H.
    pub const INDUCTANCE: Self = of([2, 1, -2, -2, 0, 0, 0]);
    /// Temperature, K.
    pub const TEMPERATURE: Self = of([0, 0, 0, 0, 1, 0, 0]);
    /// Encoder counts.
    pub const COUNTS: Self = of([0, 0, 0, 0, 0, 0, 1]);

    /// This dimension times another; `None` beyond any sensible exponent.
    pub fn times(self, other: Self) -> Option<Self> {
        self.combine(other, 1)
    }

    /// This dimension over another; `None` beyond any sensible exponent.
    pub fn per(self, other: Self) -> Option<Self> {
        self.combine(other, -1)
    }

    /// This dimension to an integer power; `None` beyond any sensible exponent.
    pub fn power(self, power: i32) -> Option<Self> {
        Self::ONE.combine(self, power)
    }

    fn combine(self, other: Self, power: i32) -> Option<Self> {
        let mut exponents = [0; 7];
        for (out, (a, b)) in exponents
            .iter_mut()
            .zip(self.exponents.iter().zip(other.exponents))
        {
            let sum = i32::from(b)
                .checked_mul(power)?
                .checked_add(i32::from(*a))?;
            *out = i8::try_from(sum)
                .ok()
                .filter(|_| sum.abs() <= MAX_EXPONENT)?;
        }
        Some(Self { exponents })
    }

    /// The coherent SI unit as text that [`Unit::parse`](crate::Unit::parse) reads: `N*m/A`.
    pub fn si_text(self) -> String {
        if let Some((_, symbol, _)) = NAMED.iter().find(|(d, _, _)| *d == self) {
            return (*symbol).to_string();
        }
        for (above, over, _) in NAMED {
            for (below, under, _) in NAMED.iter().filter(|(d, ..)| *d != Self::ONE) {
                if above.per(*below) == Some(self) {
                    let simple = under.chars().all(char::is_alphabetic);
                    return if simple {
                        format!("{over}/{under}")
                    } else {
                        format!("{over}/({under})")
                    };
                }
            }
        }
        let factors = self.exponents.iter().zip(BASE).filter(|(e, _)| **e != 0);
        let text: Vec<_> = factors
            .map(|(e, base)| {
                if *e == 1 {
                    base.to_string()
                } else {
                    format!("{base}^{e}")
                }
            })
            .collect();
        text.join("*")
    }

    /// The quantity in words where it has a name (`torque`), else its SI unit.
    pub fn name(self) -> String {
        match NAMED.iter().find(|(d, _, _)| *d == self) {
            Some((_, _, name)) => (*name).to_string(),
            None => self.si_text(),
        }
    }
}

impl fmt::Debug for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.si_text())
    }
}

/// Dimensions with a name of their own; ratios of any two are found from these, first match first.
const NAMED: &[(Dimension, &str, &str)] = &[
    (Dimension::ONE, "1", "plain number"),
    (Dimension::TIME, "s", "time"),
    (Dimension::FREQUENCY, "1/s", "rate"),
    (Dimension::LENGTH, "m", "length"),
    (Dimension::ANGLE, "rad", "angle"),
    (Dimension::LINEAR_VELOCITY, "m/s", "velocity"),
    (Dimension::ANGULAR_VELOCITY, "rad/s", "angular velocity"),
    (Dimension::MASS, "kg", "mass"),
    (Dimension::INERTIA, "kg*m^2", "inertia"),
    (Dimension::FORCE, "N", "force"),
    (Dimension::TORQUE, "N*m", "torque"),
    (Dimension::CURRENT, "A", "current"),
    (Dimension::VOLTAGE, "V", "voltage"),
    (Dimension::RESISTANCE, "ohm", "resistance"),
    (Dimension::INDUCTANCE, "H", "inductance"),
    (Dimension::TEMPERATURE, "K", "temperature"),
    (Dimension::COUNTS, "count", "encoder counts"),
    (of([0, 1, -2, 0, 0, 0, 0]), "N/m", "stiffness"),
    (
        of([2, 1, -2, 0, 0, -1, 0]),
        "N*m/rad",
        "torsional stiffness",
    ),
    (of([0, 1, -1, 0, 0, 0, 0]), "N*s/m", "viscous friction"),
    (
        of([2, 1, -1, 0, 0, -1, 0]),
        "N*m*s/rad",
        "rotary viscous friction",
    ),
    (Dimension::LINEAR_ACCELERATION, "m/s^2", "acceleration"),
    (
        Dimension::ANGULAR_ACCELERATION,
        "rad/s^2",
        "angular acceleration",
    ),
];

/// A factor to SI, kept as `up / down` with a power of ten on one side, so that `242.2 uN` becomes
/// the same double as 242.2 divided by a million: one rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Factor {
    up: f64,
    down: f64,
}

impl Factor {
    pub(super) const ONE: Self = Self { up: 1.0, down: 1.0 };

    /// `mantissa * 10^exponent`; `None` where that is no finite positive number.
    pub(super) fn new(mantissa: f64, exponent: i32) -> Option<Self> {
        // The decimal reader of the standard library rounds correctly; powi need not.
        let power: f64 = format!("1e{}", exponent.unsigned_abs()).parse().ok()?;
        let (up, down) = if exponent < 0 {
            (mantissa, power)
        } else {
            (mantissa * power, 1.0)
        };
        let sane = |x: f64| x.is_finite() && x > 0.0;
        (sane(up) && sane(down) && sane(up / down)).then_some(Self { up, down })
    }

    pub(super) fn apply(self, number: f64) -> f64 {
        number * self.up / self.down
    }
}
