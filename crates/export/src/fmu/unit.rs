//! Units as the standard describes them: a name with its exponents of the SI base units.

/// What a number of a compensator is measured in.
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
}

impl Unit {
    pub(super) const ALL: [Unit; 7] = [
        Unit::Time,
        Unit::Length,
        Unit::Speed,
        Unit::Force,
        Unit::Slew,
        Unit::Stiffness,
        Unit::Damping,
    ];

    /// Name, of a linear or a rotary axis; empty for none.
    pub(super) fn name(self, rotary: bool) -> &'static str {
        match (self, rotary) {
            (Unit::One, _) => "",
            (Unit::Time, _) => "s",
            (Unit::Length, false) => "m",
            (Unit::Length, true) => "rad",
            (Unit::Speed, false) => "m/s",
            (Unit::Speed, true) => "rad/s",
            (Unit::Force, false) => "N",
            (Unit::Force, true) => "N.m",
            (Unit::Slew, false) => "N/s",
            (Unit::Slew, true) => "N.m/s",
            (Unit::Stiffness, false) => "N/m",
            (Unit::Stiffness, true) => "N.m/rad",
            (Unit::Damping, false) => "N.s/m",
            (Unit::Damping, true) => "N.m.s/rad",
        }
    }

    /// Exponents of kg, m, s and rad.
    pub(super) fn base(self, rotary: bool) -> [i32; 4] {
        let (length, force) = if rotary {
            ([0, 0, 0, 1], [1, 2, -2, 0])
        } else {
            ([0, 1, 0, 0], [1, 1, -2, 0])
        };
        let time = [0, 0, 1, 0];
        let over = |a: [i32; 4], b: [i32; 4]| [0, 1, 2, 3].map(|i| a[i] - b[i]);
        match self {
            Unit::One => [0; 4],
            Unit::Time => time,
            Unit::Length => length,
            Unit::Speed => over(length, time),
            Unit::Force => force,
            Unit::Slew => over(force, time),
            Unit::Stiffness => over(force, length),
            Unit::Damping => over(force, over(length, time)),
        }
    }
}
