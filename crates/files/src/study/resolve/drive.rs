//! The drive of an axis: delay, current loop and limits; `voltage`, what a command in volts becomes.

use super::dimensions::Dimensions;
use crate::config::Table;
use crate::config::machine::LEAST_BANDWIDTH;
use crate::error::Error;
use stiction_formats::Dimension;
use stiction_servo::drive::Drive;

/// Keys that a motor on an amplifier that gives a voltage does not have beside it, and what is there instead.
const OF_A_CURRENT: [(&str, &str); 2] = [
    (
        "current_loop",
        "the current follows from resistance and inductance",
    ),
    (
        "peak_force",
        "the largest force follows from the limit of the voltage",
    ),
];

/// The drive of an axis at a control rate in Hz.
pub(super) fn drive(table: &Table<'_>, is: &Dimensions, rate: f64) -> Result<Drive, Error> {
    let motor = voltage(table, is)?;
    let current_lag = match table.get("current_loop").map(|g| g.or_word(&["none"])) {
        None | Some((_, Some(_))) => motor.current_lag,
        Some((given, None)) => {
            let (bandwidth, _) = given.positive(&[Dimension::FREQUENCY])?;
            if bandwidth < LEAST_BANDWIDTH {
                return Err(given.refused(&format!("at least {LEAST_BANDWIDTH} Hz, or \"none\"")));
            }
            1.0 / (2.0 * std::f64::consts::PI * bandwidth)
        }
    };
    let peak = table.positive("peak_force", is.force)?;
    let peak = peak.unwrap_or(f64::INFINITY) / motor.force_constant;
    let drive = Drive {
        peak_current: motor.peak_current.min(peak),
        current_lag,
        delay: table
            .not_negative("delay", Dimension::TIME)?
            .unwrap_or(1.0 / rate),
        ..motor
    };
    drive.validate(1.0 / rate).map_err(|e| table.together(&e))?;
    Ok(drive)
}

/// Motor and amplifier as `voltage` says, without delay; one newton for a newton where there is none.
fn voltage(axis: &Table<'_>, is: &Dimensions) -> Result<Drive, Error> {
    let Some(table) = axis.table("voltage")? else {
        return Ok(Drive::ideal());
    };
    let per = Dimensions::per;
    let constant = table.positive("force_constant", per(is.force, Dimension::CURRENT))?;
    let constant = table.required("force_constant", constant, "one such as \"96 N/A\"")?;
    let gain = per(Dimension::CURRENT, Dimension::VOLTAGE);
    let gain = table.positive("amplifier_gain", gain)?;
    let resistance = table.positive("resistance", Dimension::RESISTANCE)?;
    let motor = match (gain, resistance) {
        (Some(amplifier_gain), None) => Drive {
            force_constant: constant,
            amplifier_gain,
            ..Drive::ideal()
        },
        (None, Some(resistance)) => {
            let emf = table.not_negative("back_emf", per(Dimension::VOLTAGE, is.speed))?;
            let inductance = table.not_negative("inductance", Dimension::INDUCTANCE)?;
            for (key, instead) in OF_A_CURRENT {
                if axis.get(key).is_some() {
                    let found = "stands beside a voltage with a resistance".into();
                    return Err(axis.refuse(key, found, &format!("leave it out: {instead}")));
                }
            }
            // The power that the motor gives is the one that it takes: both constants are one number in SI.
            let emf = emf.unwrap_or(constant);
            Drive::voltage(constant, emf, resistance, inductance.unwrap_or(0.0))
        }
        (None, None) => {
            let allowed = "give the resistance of the motor, such as \"2.4 ohm\", or an amplifier_gain such as \"1.8 A/V\"";
            return Err(table.refuse("resistance", "is missing".into(), allowed));
        }
        (Some(_), Some(_)) => {
            let allowed =
                "an amplifier that makes a current of its command, or a motor on a voltage";
            let found = "stands beside resistance".into();
            return Err(table.refuse("amplifier_gain", found, allowed));
        }
    };
    let limit = table.positive("limit", Dimension::VOLTAGE)?;
    table.end()?;
    Ok(Drive {
        peak_current: limit.unwrap_or(f64::INFINITY) * motor.amplifier_gain,
        ..motor
    })
}
