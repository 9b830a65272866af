//! `[columns]`: which column is what.

use crate::config::{Given, Table};
use crate::error::Error;
use stiction_log::mapping::SCALES;
use stiction_log::{Channel, Dimension, Enable, Mapping, Selector, Unit, Value};

pub(super) fn columns(root: &Table<'_>, mapping: &mut Mapping) -> Result<(), Error> {
    let Some(table) = root.table("columns")? else {
        return Ok(());
    };
    let channel = |key| table.get(key).map(|given| channel(&given)).transpose();
    mapping.time = channel("time")?;
    mapping.position = channel("position")?;
    mapping.velocity = channel("velocity")?;
    mapping.acceleration = channel("acceleration")?;
    mapping.reference = channel("reference")?;
    mapping.temperature = channel("temperature")?;
    mapping.load = channel("load")?;
    mapping.external = channel("external")?;
    mapping.enable = table
        .get("enable")
        .map(|given| enable(&given))
        .transpose()?;
    // One column under any of three names.
    let mut taken: Option<Given<'_>> = None;
    for key in ["force", "torque", "current"] {
        let Some(given) = table.get(key) else {
            continue;
        };
        if let Some(before) = &taken {
            let found = format!("a second column of the force, after {}", before.shown());
            return Err(given.refuse(found, "one of force, torque, current"));
        }
        mapping.force = Some(self::channel(&given)?);
        taken = Some(given);
    }
    table.end()
}

/// A column by name, by number, or with all that is known of it.
fn channel(given: &Given<'_>) -> Result<Channel, Error> {
    let Some(table) = given.as_table() else {
        let allowed = "a column name, a column number from 1, or a table with column and, where needed, unit, scale and \
                       invert, such as { column = \"qm\", unit = \"m\" }";
        return Ok(Channel {
            column: selector(given, allowed)?,
            unit: None,
            scale: None,
            invert: false,
        });
    };
    let column = table.get("column");
    let column = table.required("column", column, "a column name or a column number from 1")?;
    let unit = table.get("unit").map(|given| {
        let text = given.text()?;
        Unit::parse(text).map_err(|e| given.refuse(e.found, &e.allowed))
    });
    let scale = table.get("scale").map(|given| scale(&given));
    let channel = Channel {
        column: selector(&column, "a column name or a column number from 1")?,
        unit: unit.transpose()?,
        scale: scale.transpose()?,
        invert: table.flag("invert")?.unwrap_or(false),
    };
    table.end()?;
    Ok(channel)
}

/// A column that says in which rows the axis is enabled.
fn enable(given: &Given<'_>) -> Result<Enable, Error> {
    let Some(table) = given.as_table() else {
        let allowed = "a column name, a column number from 1, or for a column of modes a table such as { column = \"mode\", \
                       equals = 8 }";
        return Ok(Enable {
            column: selector(given, allowed)?,
            equals: None,
        });
    };
    let column = table.get("column");
    let column = table.required("column", column, "a column name or a column number from 1")?;
    let equals = table.get("equals").map(|given| match given.as_number() {
        Some(number) if number.is_finite() => Ok(number),
        _ => Err(given.refused("the number in the rows that are kept, without quotes, such as 8")),
    });
    let enable = Enable {
        column: selector(&column, "a column name or a column number from 1")?,
        equals: equals.transpose()?,
    };
    table.end()?;
    Ok(enable)
}

fn selector(given: &Given<'_>, allowed: &str) -> Result<Selector, Error> {
    if let Some(name) = given.as_text() {
        return Ok(Selector::Name(name.to_string()));
    }
    match given.as_whole().map(usize::try_from) {
        Some(Ok(number)) if number > 0 => Ok(Selector::Index(number)),
        Some(_) => Err(given.refuse(
            format!("column number {}", given.shown()),
            "columns count from 1",
        )),
        None => Err(given.refused(allowed)),
    }
}

/// A scale with its unit, or a plain number; of either sign.
fn scale(given: &Given<'_>) -> Result<Value, Error> {
    let scale = match (given.as_text(), given.as_number()) {
        (Some(_), _) => given.quantity("\"35.15 N/V\"")?,
        (None, Some(number)) => Value {
            number,
            unit: Unit::si(Dimension::ONE),
        },
        (None, None) => {
            return Err(given.refused("a scale such as \"35.15 N/V\", or a plain number"));
        }
    };
    if SCALES.contains(&scale.si().abs()) {
        return Ok(scale);
    }
    let (low, high) = (SCALES.start(), SCALES.end());
    let allowed = format!("a size from {low:e} to {high:e} in SI units, of either sign");
    Err(given.refused(&allowed))
}
