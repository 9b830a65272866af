//! `[columns]`: which column is what.

use crate::axis::other::OtherFile;
use crate::axis::values::JoinedColumn;
use crate::config::{Given, Table};
use crate::error::Error;
use std::path::Path;
use stiction_formats::{Dimension, Unit, Value};
use stiction_log::mapping::SCALES;
use stiction_log::{Channel, Elsewhere, Enable, Mapping, Offset, Role, Selector, Sign};

/// The names under which the force may stand.
const FORCE_KEYS: [&str; 3] = ["force", "torque", "current"];

/// The columns of the log, and those of other files, which are named from a folder.
pub(super) fn columns(
    root: &Table<'_>,
    mapping: &mut Mapping,
    folder: &Path,
) -> Result<Vec<JoinedColumn>, Error> {
    let Some(table) = root.table("columns")? else {
        return Ok(Vec::new());
    };
    let joined = roles(&table, &Role::ALL, mapping, folder)?;
    mapping.enable = table
        .get("enable")
        .map(|given| enable(&given))
        .transpose()?;
    table.end()?;
    Ok(joined)
}

/// The columns of these roles in a table; those of other files are named from a folder.
pub(in crate::axis) fn roles(
    table: &Table<'_>,
    roles: &[Role],
    mapping: &mut Mapping,
    folder: &Path,
) -> Result<Vec<JoinedColumn>, Error> {
    let mut joined = Vec::new();
    let mut read = |given: &Given<'_>, role| -> Result<(), Error> {
        if given.as_text() == Some("none") && Role::OPTIONAL.contains(&role) {
            mapping.absent.push(role);
            return Ok(());
        }
        let (channel, from) = column(given, role, folder)?;
        joined.extend(from);
        mapping.set(role, channel);
        Ok(())
    };
    let others = roles.iter().filter(|role| **role != Role::Force);
    for &role in others {
        if let Some(given) = table.get(role.name()) {
            read(&given, role)?;
        }
    }
    // One column under any of three names.
    let mut taken: Option<Given<'_>> = None;
    let force = roles.contains(&Role::Force).then_some(FORCE_KEYS);
    for key in force.into_iter().flatten() {
        let Some(given) = table.get(key) else {
            continue;
        };
        if let Some(before) = &taken {
            let found = format!("a second column of the force, after {}", before.shown());
            return Err(given.refuse(found, "one of force, torque, current"));
        }
        read(&given, Role::Force)?;
        taken = Some(given);
    }
    Ok(joined)
}

/// A column of the log or, where it names a file, of another one.
fn column(
    given: &Given<'_>,
    role: Role,
    folder: &Path,
) -> Result<(Channel, Option<JoinedColumn>), Error> {
    let Some(table) = given.as_table() else {
        return Ok((channel(given)?, None));
    };
    let file = match role {
        Role::Time => None,
        _ => table.get("file"),
    };
    let own = of_table(&table)?;
    if let Some(sign) = table.find("sign").filter(|_| role != Role::Force) {
        let found = format!("a sign of the {role}");
        return Err(sign.refuse(
            found,
            "sign beside the force, where only its magnitude is logged",
        ));
    }
    let of_its_own = role != Role::Time && table.find("time").is_some();
    let Some(file) = file else {
        if of_its_own {
            return own_stamps(&table, own, role);
        }
        if let Some(offset) = table.find("offset").filter(|_| role != Role::Time) {
            let found = format!("{} without file", offset.shown());
            return Err(offset.refuse(
                found,
                "offset beside file = \"...\": it is of the clock of another file",
            ));
        }
        table.end()?;
        return Ok((own, None));
    };
    let time = table.get("time").map(|given| channel(&given)).transpose()?;
    let offset = table
        .get("offset")
        .map(|given| offset(&given))
        .transpose()?;
    let offset = offset.unwrap_or(Offset::Given(0.0));
    table.end()?;
    let joined = JoinedColumn {
        file: Some(OtherFile::given_from(folder, file.path("a recording")?)),
        from: Elsewhere { role, time, offset },
    };
    Ok((own, Some(joined)))
}

/// A column of the log that has time stamps of its own.
fn own_stamps(
    table: &Table<'_>,
    own: Channel,
    role: Role,
) -> Result<(Channel, Option<JoinedColumn>), Error> {
    let time = table.get("time").map(|given| channel(&given)).transpose()?;
    let offset = table
        .get("offset")
        .map(|given| offset(&given))
        .transpose()?;
    table.end()?;
    let from = Elsewhere {
        role,
        time,
        offset: offset.unwrap_or(Offset::Given(0.0)),
    };
    Ok((own, Some(JoinedColumn { file: None, from })))
}

/// What is added to the time stamps of another file.
fn offset(given: &Given<'_>) -> Result<Offset, Error> {
    match given.as_text() {
        Some("estimate") => Ok(Offset::Estimated),
        Some(text) if !text.contains(|c: char| c.is_ascii_digit()) => Err(given.refused(
            "a time of either sign with its unit, such as \"12 ms\", or \"estimate\": it is then found from what the two files \
             share",
        )),
        _ => given.signed(Dimension::TIME).map(Offset::Given),
    }
}

/// A column by name, by number, or with all that is known of it.
fn channel(given: &Given<'_>) -> Result<Channel, Error> {
    let Some(table) = given.as_table() else {
        let allowed = "a column name, a column number from 1, or a table with column and, where needed, unit, scale and \
                       invert, such as { column = \"qm\", unit = \"m\" }";
        return Ok(Channel {
            column: selector(given, allowed)?,
            ..Channel::index(0)
        });
    };
    let channel = of_table(&table)?;
    table.end()?;
    Ok(channel)
}

/// The keys of a column that say how its numbers are read.
fn of_table(table: &Table<'_>) -> Result<Channel, Error> {
    let column = table.get("column");
    let column = table.required("column", column, "a column name or a column number from 1")?;
    let unit = table.get("unit").map(|given| {
        let text = given.text()?;
        Unit::parse(text).map_err(|e| given.refuse(e.found, &e.allowed))
    });
    let scale = table.get("scale").map(|given| scale(&given));
    Ok(Channel {
        column: selector(&column, "a column name or a column number from 1")?,
        unit: unit.transpose()?,
        scale: scale.transpose()?,
        invert: table.flag("invert")?.unwrap_or(false),
        sign: table.get("sign").map(|given| sign(&given)).transpose()?,
    })
}

/// Where a magnitude has its sign from.
fn sign(given: &Given<'_>) -> Result<Sign, Error> {
    if given.as_text() == Some("following-error") {
        return Ok(Sign::FollowingError);
    }
    let allowed = "\"following-error\", or a column whose sign the force has";
    selector(given, allowed).map(Sign::Column)
}

/// A column that says in which rows the axis is enabled.
fn enable(given: &Given<'_>) -> Result<Enable, Error> {
    let Some(table) = given.as_table() else {
        let allowed = "a column name, a column number from 1, or for a column of modes a table such as { column = \"mode\", \
                       equals = 8 }";
        return Ok(Enable {
            column: selector(given, allowed)?,
            equals: None,
            mask: None,
        });
    };
    let column = table.get("column");
    let column = table.required("column", column, "a column name or a column number from 1")?;
    let equals = table.get("equals").map(|given| match given.as_number() {
        Some(number) if number.is_finite() => Ok(number),
        _ => Err(given.refused("the number in the rows that are kept, without quotes, such as 8")),
    });
    let mask = table.get("mask");
    let bits = mask.as_ref().map(|given| {
        let bits = given.as_whole().and_then(|bits| u32::try_from(bits).ok());
        let allowed = "the bits that count, a whole number from 1 to 0xffffffff such as 0x6f";
        bits.filter(|bits| *bits > 0)
            .ok_or_else(|| given.refused(allowed))
    });
    let enable = Enable {
        column: selector(&column, "a column name or a column number from 1")?,
        equals: equals.transpose()?,
        mask: bits.transpose()?,
    };
    if let (Some(mask), Some(given)) = (enable.mask, table.get("equals"))
        && enable.counted(enable.kept()) != enable.kept()
    {
        let found = format!(
            "{} has bits that mask = 0x{mask:x} leaves out",
            enable.shown(enable.kept())
        );
        return Err(given.refuse(found, "equals with bits of mask alone, else no row is kept"));
    }
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
