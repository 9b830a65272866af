//! One channel with its column found and its units settled: numbers of the file in, SI out.

use super::channel::{Channel, Motion, Role};
use super::limits::SCALES;
use super::select::select;
use super::{Mapping, counted, describe};
use crate::{Dimension, Error, Kind, Table, Unit};
use stiction_policy::signal;

/// The next larger unit for the numbers of a role that come out too small, the next smaller one where they are too large; with a
/// scale where there is none.
pub(crate) fn another_unit(
    own: &Unit,
    dimension: Dimension,
    role: Role,
    too_small: bool,
) -> (String, Option<f64>) {
    let rotary = Motion::Rotary;
    let angular = [rotary.position(), rotary.velocity(), rotary.acceleration()];
    let of_si = |si: String| [format!("m{si}"), si.clone(), format!("k{si}")];
    let known = |units: [&str; 3]| units.map(String::from);
    // From small to large.
    let units = match (role, angular.contains(&dimension)) {
        (Role::Time, _) => known(["us", "ms", "s"]),
        (Role::Position | Role::Reference, false) => known(["um", "mm", "m"]),
        (Role::Position | Role::Reference, true) => known(["deg", "rad", "rev"]),
        (Role::Velocity, false) => known(["um/s", "mm/s", "m/s"]),
        (Role::Velocity, true) => known(["deg/s", "rad/s", "rev/s"]),
        _ => match dimension.si_text() {
            si if si == "1" => known(["%", "%", "1"]),
            si => of_si(si),
        },
    };
    let own = own.to_string();
    let at = units.iter().position(|unit| *unit == own);
    let next = match (at, too_small) {
        (Some(at), true) => (at + 1).min(units.len() - 1),
        (Some(at), false) => at.saturating_sub(1),
        (None, true) => units.len() - 1,
        (None, false) => 1,
    };
    let scale = match (at == Some(next), too_small) {
        (false, _) => None,
        (true, true) => Some(1000.0),
        (true, false) => Some(0.001),
    };
    (units[next].clone(), scale)
}

/// A column and how its numbers become SI.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    /// Position of the column in the table.
    pub column: usize,
    /// Unit of its numbers.
    pub unit: Unit,
    /// Dimension after the scale.
    pub dimension: Dimension,
    scale: f64,
    scale_text: Option<String>,
    /// Numbers of a counter that was read without its sign, from half of which on they are below zero.
    unsigned: Option<f64>,
}

impl Source {
    /// A channel whose unit is known.
    pub fn new(
        table: &Table,
        column: usize,
        unit: &Unit,
        channel: &Channel,
        role: Role,
    ) -> Result<Self, Error> {
        let unit = &of_role(unit, role);
        let sign = if channel.invert { -1.0 } else { 1.0 };
        let unit_dimension = unit.dimension();
        let (scale, dimension) = match &channel.scale {
            None => (sign, Some(unit_dimension)),
            Some(value) => {
                let si = value.si();
                if !SCALES.contains(&si.abs()) {
                    let found = format!("the scale of {role} is {value}");
                    let (low, high) = (SCALES.start(), SCALES.end());
                    let allowed = format!("a size from {low:e} to {high:e} in SI units");
                    return Err(
                        Error::new(Kind::Value, found, allowed).of_setting(role.key("scale"))
                    );
                }
                (sign * si, unit_dimension.times(value.unit.dimension()))
            }
        };
        let scale_text = channel.scale.as_ref().map(ToString::to_string);
        let dimension = dimension.ok_or_else(|| {
            let found = format!("{role} in {unit} times its scale has no plausible dimension");
            Error::new(
                Kind::Unit,
                found,
                "a unit and a scale that make a force, a length or another quantity of the axis",
            )
            .in_column(describe::place(table, column))
            .of_setting(role.key("scale"))
        })?;
        Ok(Self {
            column,
            unit: unit.clone(),
            dimension,
            scale,
            scale_text,
            unsigned: None,
        })
    }

    /// Reads numbers below zero that were written without their sign, 65535 for -1, with it; the bits of their counter, where there
    /// are such numbers.
    pub fn restore_sign(&mut self, table: &Table) -> Option<u32> {
        let bits = unsigned_bits(&table.columns[self.column].values)?;
        self.unsigned = Some((1_u64 << bits) as f64);
        Some(bits)
    }

    /// The source of a role in a mapping that is complete; `None` where it has none.
    pub fn of(mapping: &Mapping, table: &Table, role: Role) -> Result<Option<Self>, Error> {
        let Some(channel) = mapping.channel(role) else {
            return Ok(None);
        };
        let column = select(table, &channel.column, role)?;
        let unit = channel
            .unit
            .clone()
            .unwrap_or_else(|| Unit::si(Dimension::ONE));
        Self::new(table, column, &unit, channel, role).map(Some)
    }

    /// One number of the file in SI; what is no measurement becomes NaN, a missing sample.
    pub fn si(&self, number: f64) -> f64 {
        let signed = match self.unsigned {
            Some(whole) if number >= 0.5 * whole => number - whole,
            _ => number,
        };
        let si = self.unit.to_si(signed) * self.scale;
        if si.abs() <= signal::MAX_MEASURED {
            si
        } else {
            f64::NAN
        }
    }

    /// The column as the place of an error.
    pub fn place(&self, table: &Table) -> String {
        describe::place(table, self.column)
    }

    /// The line of the axis file that gives it another unit: a larger one for numbers that come out too small.
    pub fn line(&self, table: &Table, role: Role, too_small: bool) -> String {
        let (unit, scale) = another_unit(&self.unit, self.dimension, role, too_small);
        let scale = scale.map_or(String::new(), |scale| format!(", scale = {scale}"));
        let with = format!("unit = \"{unit}\"{scale}");
        describe::line_with(table, self.column, role, &with)
    }

    /// A difference of two numbers of the file in SI.
    pub fn si_difference(&self, difference: f64) -> f64 {
        (self.unit.to_si(difference) - self.unit.to_si(0.0)) * self.scale
    }

    /// Refuses a dimension that the role cannot have.
    pub fn check(&self, table: &Table, role: Role, motion: Motion) -> Result<(), Error> {
        let ok = match role {
            Role::Time => self.dimension == Dimension::TIME,
            Role::Position | Role::Reference => self.dimension == motion.position(),
            Role::Velocity => self.dimension == motion.velocity(),
            Role::Acceleration => self.dimension == motion.acceleration(),
            Role::Force | Role::External => is_force(self.dimension),
            Role::Temperature => self.dimension == Dimension::TEMPERATURE,
            Role::Load => true,
        };
        if ok {
            return Ok(());
        }
        let wanted = match role {
            Role::Position | Role::Reference => motion.position(),
            Role::Velocity => motion.velocity(),
            Role::Acceleration => motion.acceleration(),
            Role::Force | Role::External => motion.force(),
            Role::Temperature => Dimension::TEMPERATURE,
            Role::Time | Role::Load => Dimension::TIME,
        };
        let text = wanted.si_text();
        let unit = self.unit.text();
        let under = if unit.contains(['/', '*', ' ']) {
            format!("({unit})")
        } else {
            unit.into()
        };
        let found = match &self.scale_text {
            None => format!(
                "{role} is in {unit}, which measures {}",
                self.dimension.name()
            ),
            Some(scale) => {
                let result = self.dimension.si_text();
                format!("{role} in {unit} times its scale {scale} is in {result}")
            }
        };
        let kind = match role {
            Role::Position | Role::Reference | Role::Velocity | Role::Acceleration => {
                format!("a {motion} axis needs")
            }
            _ => "it has to be".to_string(),
        };
        let also = match (role, motion) {
            (Role::Force | Role::External, _) => ", A, V or %",
            (Role::Acceleration, Motion::Linear) => ", or g and mg of standard gravity",
            _ => "",
        };
        let is_counted = self.unit.dimension() == Dimension::COUNTS;
        let how = match (is_counted, &self.scale_text) {
            (true, None) => format!(
                "give the size of a count, as in: {}",
                counted::lines(table, self.column, role, Some(motion))
            ),
            (true, Some(_)) => format!(
                "give the size of a count, such as scale = \"{}\"",
                counted::size(role, &table.columns[self.column].name, motion)
            ),
            (false, _) => format!("give the unit, or a scale such as \"2.5 {text}/{under}\""),
        };
        let allowed = format!("{kind} {} ({text}{also}); {how}", wanted.name());
        // Without a scale the unit is what is wrong; it may stand in the recording.
        let key = role.key(if self.scale_text.is_some() {
            "scale"
        } else {
            "unit"
        });
        let error = Error::new(Kind::Unit, found, allowed);
        Err(error
            .in_column(describe::place(table, self.column))
            .of_setting(key))
    }
}

/// The unit that is meant in a role: `g` is a gram, but no acceleration is measured in grams; there it is the standard
/// acceleration of gravity, `gn`, and `mg` a thousandth of it.
pub(super) fn of_role(unit: &Unit, role: Role) -> Unit {
    let meant = match (role, unit.text()) {
        (Role::Acceleration, "g") => Unit::parse("gn").ok(),
        (Role::Acceleration, "mg") => Unit::parse("mgn").ok(),
        _ => None,
    };
    meant.unwrap_or_else(|| unit.clone())
}

/// Whether a friction identification can take this as a force.
pub(super) fn is_force(dimension: Dimension) -> bool {
    [
        Dimension::FORCE,
        Dimension::TORQUE,
        Dimension::CURRENT,
        Dimension::VOLTAGE,
        Dimension::ONE,
    ]
    .contains(&dimension)
}

/// Counters of drives, bits.
const COUNTERS: [u32; 2] = [16, 32];

/// The bits of a counter whose numbers below zero were read without their sign: all are whole, some in its lowest quarter, some in
/// its highest, and none between. What a drive measures does not jump there.
fn unsigned_bits(values: &[f64]) -> Option<u32> {
    let bits_of = |bits: &u32| {
        let whole = (1_u64 << *bits) as f64;
        let (mut low, mut high) = (0, 0);
        for number in values.iter().filter(|number| !number.is_nan()) {
            let is_count = (0.0..whole).contains(number) && number.fract() == 0.0;
            if !is_count || (0.25 * whole..0.75 * whole).contains(number) {
                return false;
            }
            *(if *number < 0.5 * whole {
                &mut low
            } else {
                &mut high
            }) += 1;
        }
        low.min(high) >= signal::MIN_EACH_SIGN
    };
    COUNTERS.into_iter().find(bits_of)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_below_zero_without_their_sign_are_told_from_others() {
        let swing = |k: usize| libm::round(300.0 * libm::sin(0.1 * k as f64));
        let signed: Vec<f64> = (0..200).map(swing).collect();
        let without =
            |whole: f64| -> Vec<f64> { signed.iter().map(|x| x.rem_euclid(whole)).collect() };
        assert_eq!(unsigned_bits(&without(65536.0)), Some(16));
        assert_eq!(unsigned_bits(&without(4294967296.0)), Some(32));
        assert_eq!(unsigned_bits(&signed), None);
        let mut broken = without(65536.0);
        broken[7] += 0.5;
        assert_eq!(unsigned_bits(&broken), None);
        // A counter that runs through all its numbers, a flag beside a code, and no number at all.
        let counter: Vec<f64> = (0..200).map(|k| 400.0 * f64::from(k) % 65536.0).collect();
        assert_eq!(unsigned_bits(&counter), None);
        assert_eq!(unsigned_bits(&[0.0, 65535.0, 0.0]), None);
        assert_eq!(unsigned_bits(&[]), None);
    }
}
