//! Refuses what no axis does: a travel, speed or force beyond all measure, for which a unit is wrong.

use super::Log;
use crate::findings::{extremes, short};
use crate::mapping::{RATES, Role, Source};
use crate::{Error, Kind, Table};
use std::ops::RangeInclusive;

/// Travels of a position (m, rad) and largest velocities, accelerations and forces that a log may have, in SI units: a thousandth
/// of the diameter of an atom to far more than any machine.
const SIZES: RangeInclusive<f64> = 1e-12..=1e12;
/// Rounding errors of the largest number up to which a signal counts as constant.
const CONSTANT_WITHIN: f64 = 8.0;

/// Refuses a log whose rate or one of whose columns cannot be that of an axis. A column that never changes is told elsewhere.
pub(super) fn check(log: &Log, table: &Table, sources: &[(Role, Source)]) -> Result<(), Error> {
    if let Some((_, source)) = sources.iter().find(|(role, _)| *role == Role::Time)
        && !RATES.contains(&log.rate_hz)
    {
        let found = format!("the median time step is {} s", short(1.0 / log.rate_hz));
        let steps = 1.0 / RATES.end()..=1.0 / RATES.start();
        return Err(refusal(table, Role::Time, source, found, &steps, "s"));
    }
    let force = log.force_unit.as_str();
    let units = [
        log.motion.position(),
        log.motion.velocity(),
        log.motion.acceleration(),
    ];
    let [length, speed, acceleration] = units.map(|dimension| dimension.si_text());
    for (role, values, unit) in [
        (Role::Position, &log.position, length.as_str()),
        (Role::Reference, &log.reference, &length),
        (Role::Velocity, &log.velocity, &speed),
        (Role::Acceleration, &log.acceleration, &acceleration),
        (Role::Force, &log.force, force),
    ] {
        let (Some((low, high)), Some((_, source))) = (
            values.as_deref().and_then(extremes),
            sources.iter().find(|(r, _)| *r == role),
        ) else {
            continue;
        };
        let largest = low.abs().max(high.abs());
        let travels = [Role::Position, Role::Reference].contains(&role);
        let size = if travels { high - low } else { largest };
        let constant = size <= CONSTANT_WITHIN * f64::EPSILON * if travels { largest } else { 0.0 };
        if constant || SIZES.contains(&size) {
            continue;
        }
        let found = match travels {
            true => format!("{role} travels {} {unit} in all", short(size)),
            false => format!("{role} is {} {unit} at most", short(size)),
        };
        return Err(refusal(table, role, source, found, &SIZES, unit));
    }
    Ok(())
}

fn refusal(
    table: &Table,
    role: Role,
    source: &Source,
    found: String,
    range: &RangeInclusive<f64>,
    unit: &str,
) -> Error {
    let allowed = format!(
        "allowed: from {:e} to {:e} {unit}; its unit ({}) or its scale is wrong: give the right one in axis.toml under [columns], as in: {}",
        range.start(),
        range.end(),
        source.unit,
        source.line(table, role),
    );
    Error::new(Kind::Value, found, allowed)
        .in_column(source.place(table))
        .of_setting(role.key("unit"))
}
