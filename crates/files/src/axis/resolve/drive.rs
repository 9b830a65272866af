//! `[drive]` and `servo`: the motor that makes the force of the current, voltage or duty that is logged, and the loop that makes the duty.

use crate::config::Table;
use crate::error::Error;
use stiction_formats::Dimension;
use stiction_log::mapping::{
    self, BACK_EMFS, FORCE_CONSTANTS, PositionLoop, RESISTANCES, SERVOS, SUPPLIES, Servo,
};
use stiction_log::{Drive, Mapping, Motion};

/// P gains of a servo's firmware.
const GAINS: std::ops::RangeInclusive<f64> = 1e-6..=1e6;

/// Reads the motor into a mapping; a servo turns.
pub(super) fn drive(root: &Table<'_>, mapping: &mut Mapping) -> Result<(), Error> {
    let servo = servo(root)?;
    mapping.drive = motor(root, servo)?;
    if servo.is_some() && mapping.motion.is_none() {
        mapping.motion = Some(Motion::Rotary);
    }
    Ok(())
}

/// The servo of the library that is named.
fn servo(root: &Table<'_>) -> Result<Option<&'static Servo>, Error> {
    let Some(given) = root.get("servo") else {
        return Ok(None);
    };
    let names: Vec<&str> = SERVOS.iter().map(|servo| servo.name).collect();
    let found = given.as_text().and_then(mapping::servo);
    let allowed = || {
        format!(
            "{}; of others the motor under [drive], with the duty, voltage or current as force",
            names.join(", ")
        )
    };
    found.map(Some).ok_or_else(|| given.refused(&allowed()))
}

/// A servo of the library as it is.
fn usual(servo: &'static Servo) -> Drive {
    Drive {
        motion: Motion::Rotary,
        force_constant: servo.torque_constant,
        resistance: Some(servo.resistance),
        back_emf: servo.back_emf,
        supply: None,
        position_loop: Some(PositionLoop {
            kp: None,
            error_gain: servo.error_gain,
            duty_limit: servo.duty_limit,
            servo,
        }),
    }
}

fn motor(root: &Table<'_>, servo: Option<&'static Servo>) -> Result<Option<Drive>, Error> {
    let usual = servo.map(usual);
    let Some(table) = root.table("drive")? else {
        return Ok(usual);
    };
    let per = |a: Dimension, b: Dimension| a.per(b).unwrap_or(a);
    let constant = |motion: Motion| per(motion.force(), Dimension::CURRENT);
    let (linear, rotary) = (constant(Motion::Linear), constant(Motion::Rotary));
    let given = table.get("force_constant");
    let given = given.map(|given| given.among(&[linear, rotary], &FORCE_CONSTANTS));
    let example = "the force of one ampere, such as \"96 N/A\" or \"0.05 N m/A\"";
    let own = usual.map(|own| (own.force_constant, rotary));
    let (force_constant, dimension) =
        table.required("force_constant", given.transpose()?.or(own), example)?;
    let motion = match dimension == linear {
        true => Motion::Linear,
        false => Motion::Rotary,
    };
    let emf = table.not_negative("back_emf", per(Dimension::VOLTAGE, motion.velocity()))?;
    if emf.is_some_and(|emf| !BACK_EMFS.contains(&emf)) {
        return Err(table.refused("back_emf", &format!("at most {:e}", BACK_EMFS.end())));
    }
    let mut position_loop = usual.and_then(|own| own.position_loop);
    if let Some(own) = &mut position_loop {
        own.kp = number(&table, "kp", GAINS)?;
        own.error_gain = number(&table, "error_gain", GAINS)?.unwrap_or(own.error_gain);
        own.duty_limit = number(&table, "duty_limit", 0.01..=1.0)?.unwrap_or(own.duty_limit);
    }
    let resistance = table.among("resistance", Dimension::RESISTANCE, &RESISTANCES)?;
    let drive = Drive {
        motion,
        force_constant,
        resistance: resistance.or(usual.and_then(|own| own.resistance)),
        // The power that a motor gives is the one that it takes: both constants are one number in SI.
        back_emf: emf.unwrap_or(usual.map_or(force_constant, |own| own.back_emf)),
        supply: table.among("supply", Dimension::VOLTAGE, &SUPPLIES)?,
        position_loop,
    };
    table.end()?;
    Ok(Some(drive))
}

/// A plain number within a range.
fn number(
    table: &Table<'_>,
    key: &'static str,
    range: std::ops::RangeInclusive<f64>,
) -> Result<Option<f64>, Error> {
    let given = table.get(key);
    let read = |given: crate::config::Given<'_>| {
        let allowed = || {
            format!(
                "a number without quotes, {:e} to {:e}",
                range.start(),
                range.end()
            )
        };
        let number = given.as_number().filter(|x| range.contains(x));
        number.ok_or_else(|| given.refused(&allowed()))
    };
    given.map(read).transpose()
}
