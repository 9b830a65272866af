//! Units as the standard describes them: a name with its exponents of the SI base units.

/// Units of the numbers of a compensator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    /// No unit.
    One,
    Time,
    Length,
    Speed,
    Force,
    /// Force a second.
    Slew,
    /// Force per length.
    Stiffness,
    /// Force per speed.
    Damping,
    /// Force per acceleration.
    Inertia,
    Acceleration,
    /// Thermodynamic.
    Temperature,
}

impl Unit {
    pub(super) const ALL: [Unit; 10] = [
        Unit::Time,
        Unit::Length,
        Unit::Speed,
        Unit::Force,
        Unit::Slew,
        Unit::Stiffness,
        Unit::Damping,
        Unit::Inertia,
        Unit::Acceleration,
        Unit::Temperature,
    ];

    /// Its name for a linear or rotary axis whose force is in `force`; empty without unit.
    pub(super) fn name(self, rotary: bool, force: &str) -> String {
        let length = if rotary { "rad" } else { "m" };
        // A product as the standard's examples write it.
        let force = match force {
            "p.u." => "pu".into(),
            force => force.replace(' ', "."),
        };
        match self {
            Unit::One => String::new(),
            Unit::Time => "s".into(),
            Unit::Length => length.into(),
            Unit::Speed => format!("{length}/s"),
            Unit::Force => force,
            Unit::Slew => format!("{force}/s"),
            Unit::Stiffness => format!("{force}/{length}"),
            Unit::Damping => format!("{force}.s/{length}"),
            Unit::Inertia => format!("{force}.s2/{length}"),
            Unit::Acceleration => format!("{length}/s2"),
            Unit::Temperature => "K".into(),
        }
    }

    /// Exponents of kg, m, s, A, rad and K.
    pub(super) fn base(self, rotary: bool, force: &str) -> [i32; 6] {
        let length = if rotary {
            [0, 0, 0, 0, 1, 0]
        } else {
            [0, 1, 0, 0, 0, 0]
        };
        let force = match force {
            "N" => [1, 1, -2, 0, 0, 0],
            "N m" => [1, 2, -2, 0, 0, 0],
            "A" => [0, 0, 0, 1, 0, 0],
            "V" => [1, 2, -3, -1, 0, 0],
            _ => [0; 6],
        };
        let time = [0, 0, 1, 0, 0, 0];
        let over = |a: [i32; 6], b: [i32; 6]| [0, 1, 2, 3, 4, 5].map(|i| a[i] - b[i]);
        match self {
            Unit::One => [0; 6],
            Unit::Time => time,
            Unit::Length => length,
            Unit::Speed => over(length, time),
            Unit::Force => force,
            Unit::Slew => over(force, time),
            Unit::Stiffness => over(force, length),
            Unit::Damping => over(force, over(length, time)),
            Unit::Inertia => over(force, over(over(length, time), time)),
            Unit::Acceleration => over(over(length, time), time),
            Unit::Temperature => [0, 0, 0, 0, 0, 1],
        }
    }
}
