//! What turns the current, voltage or duty of a motor into its force.

use super::channel::Motion;
use super::servos::Servo;
use crate::findings::{Finding, Found};
use crate::{Dimension, Error, Kind};
use std::ops::RangeInclusive;
use stiction_formats::Scalar;
use stiction_number::short;

/// Force constants, N/A (N m/A).
pub const FORCE_CONSTANTS: RangeInclusive<f64> = 1e-9..=1e9;
/// Resistances of a winding, ohm.
pub const RESISTANCES: RangeInclusive<f64> = 1e-6..=1e9;
/// Back EMF constants, V s/m (V s/rad); 0 where the amplifier makes up for it.
pub const BACK_EMFS: RangeInclusive<f64> = 0.0..=1e9;
/// Supply voltages, V.
pub const SUPPLIES: RangeInclusive<f64> = 1e-6..=1e9;

/// A motor whose current i, voltage U or duty d is logged: `F = K i` with `i = (U - k v)/R` and `U = S d`.
///
/// The inductance of the winding is left out: at a millisecond and less of L/R the force follows the voltage well within what
/// friction does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// The axis that a motor of this force constant drives.
    pub motion: Motion,
    /// Force constant K, N/A (N m/A).
    pub force_constant: f64,
    /// Resistance R of the winding, ohm; for a voltage or a duty.
    pub resistance: Option<f64>,
    /// Back EMF constant k, V s/m (V s/rad).
    pub back_emf: f64,
    /// Voltage S of the supply, V; for a duty.
    pub supply: Option<f64>,
    /// The loop that makes the duty, if no column is a force.
    pub position_loop: Option<PositionLoop>,
}

/// The P loop in position of a servo's firmware: `duty = kp error_gain (reference - position)`, within the limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PositionLoop {
    /// P gain as the firmware counts it; that of the log, a number `kp`, or the usual one if `None`.
    pub kp: Option<f64>,
    /// Duty for each rad of following error and unit of the P gain, 1/rad.
    pub error_gain: f64,
    /// Largest duty, 0 to 1.
    pub duty_limit: f64,
    /// The servo of the library with the usual P gain and supply.
    pub servo: &'static Servo,
}

impl PositionLoop {
    /// Duty at a following error, rad.
    pub fn duty(&self, error: f64) -> f64 {
        let kp = self.kp.unwrap_or(self.servo.kp);
        (kp * self.error_gain * error).clamp(-self.duty_limit, self.duty_limit)
    }
}

/// How a column becomes the force: `constant * column - damping * velocity`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Gain {
    pub constant: f64,
    pub damping: f64,
}

impl Drive {
    /// With the P gain and the supply of a log that states them beside its columns, as BAM's do (`kp`, `vin`), or the usual ones, which
    /// is found then.
    pub(crate) fn of_log(mut self, scalars: &[Scalar]) -> (Self, Option<Finding>) {
        let stated = |name: &str| {
            let own = scalars.iter().find(|scalar| scalar.name == name);
            own.map(|scalar| scalar.value).filter(|x| *x > 0.0)
        };
        let Some(own) = &mut self.position_loop else {
            return (self, None);
        };
        own.kp = own.kp.or_else(|| stated("kp"));
        let of_file = || stated("vin").filter(|x| SUPPLIES.contains(x));
        self.supply = self.supply.or_else(of_file);
        let kp = own.kp.is_none().then_some(own.servo.kp);
        let supply = self.supply.is_none().then_some(own.servo.supply);
        (own.kp, self.supply) = (own.kp.or(kp), self.supply.or(supply));
        let assumed = kp.is_some() || supply.is_some();
        let found = Found::ServoAssumed { kp, supply };
        (self, assumed.then(|| Finding::warning(found)))
    }

    /// How the force follows from a column of this dimension.
    pub(crate) fn gain(&self, column: Dimension) -> Result<Gain, Error> {
        let volt = |supply: f64| {
            let resistance = self.resistance.ok_or_else(|| {
                lacks(
                    "resistance",
                    column,
                    "give the resistance of the winding, such as resistance = \"1.2 ohm\"",
                )
            })?;
            let per_volt = self.force_constant / resistance;
            Ok(Gain {
                constant: per_volt * supply,
                damping: per_volt * self.back_emf,
            })
        };
        match column {
            Dimension::CURRENT => Ok(Gain {
                constant: self.force_constant,
                damping: 0.0,
            }),
            Dimension::VOLTAGE => volt(1.0),
            Dimension::ONE => {
                let example =
                    "give the voltage of which the column is a part, such as supply = \"24 V\"";
                volt(
                    self.supply
                        .ok_or_else(|| lacks("supply", column, example))?,
                )
            }
            _ => {
                let found = format!("[drive] beside a force in {}", column.si_text());
                let allowed = "[drive] with a column in A, in V or as a part of the supply; without it where the force is known";
                Err(Error::new(Kind::Unit, found, allowed).of_setting("drive.force_constant"))
            }
        }
    }

    /// The formula with its numbers, for a column of this dimension.
    pub(crate) fn words(&self, column: Dimension) -> String {
        let (force, speed) = (
            self.motion.force().si_text(),
            self.motion.velocity().si_text(),
        );
        let constant = short(self.force_constant);
        if column == Dimension::CURRENT {
            return format!("force = current times {constant} {force}/A");
        }
        let voltage = match (
            self.supply.filter(|_| column == Dimension::ONE),
            self.position_loop,
        ) {
            (Some(supply), None) => format!("{} V times the duty", short(supply)),
            (Some(supply), Some(own)) => format!(
                "{} V times the duty, {} times {}/rad times (reference - position) within +-{},",
                short(supply),
                short(own.kp.unwrap_or(own.servo.kp)),
                short(own.error_gain),
                short(own.duty_limit)
            ),
            (None, _) => "voltage".into(),
        };
        let resistance = self.resistance.map(short).unwrap_or_default();
        let emf = short(self.back_emf);
        format!(
            "force = ({voltage} - {emf} V/({speed}) times the velocity) times {constant} {force}/A over {resistance} ohm"
        )
    }
}

/// What a column asks for and the axis file does not say.
fn lacks(key: &str, column: Dimension, example: &str) -> Error {
    let what = match column {
        Dimension::ONE => "a plain number".into(),
        _ => format!("in {}", column.si_text()),
    };
    let found = format!("the force column is {what}, and [drive] has no {key}");
    Error::new(Kind::Missing, found, example).of_setting(format!("drive.{key}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTOR: Drive = Drive {
        motion: Motion::Rotary,
        force_constant: 0.05,
        resistance: Some(2.0),
        back_emf: 0.04,
        supply: Some(24.0),
        position_loop: None,
    };

    #[test]
    fn a_current_a_voltage_and_a_duty_make_the_same_force() {
        // 3 A at 100 rad/s: 6 V over the resistance and 4 V of back EMF.
        let force = |column, x: f64| {
            let Gain { constant, damping } = MOTOR.gain(column).unwrap();
            constant * x - damping * 100.0
        };
        for (column, x) in [
            (Dimension::CURRENT, 3.0),
            (Dimension::VOLTAGE, 10.0),
            (Dimension::ONE, 10.0 / 24.0),
        ] {
            assert!((force(column, x) - 0.15).abs() < 1e-12, "{column:?}");
        }
    }

    #[test]
    fn what_a_column_asks_for_is_named() {
        let bare = Drive {
            resistance: None,
            supply: None,
            ..MOTOR
        };
        let message = |column| bare.gain(column).unwrap_err().to_string();
        assert!(message(Dimension::VOLTAGE).contains("resistance = \"1.2 ohm\""));
        assert!(message(Dimension::ONE).contains("supply = \"24 V\""));
        assert!(message(Dimension::TORQUE).contains("without it"));
        assert!(bare.gain(Dimension::CURRENT).is_ok());
    }
}
