//! Units at the end of names: `Zeit_ms`, `J3_q_act_deg`, `position, mm`, `Weg / mm`, `Weg/mm`, `speed in mm/s`.

use super::channel::{Channel, Motion, Role};
use super::choose::allows;
use super::convert::of_role;
use super::names::{self, Hint};
use crate::{Dimension, Table, Unit};
use stiction_formats::unit::is_known;

/// The endings that are units. Those of one letter are other things too: a motor, a phase, an axis, a sample.
const UNITS: &[&str] = &[
    "ms", "us", "ns", "s", "deg", "rad", "mm", "um", "m", "Nm", "N", "mA", "A",
];

/// What sets a unit apart from the name before it, whatever unit it is.
const MARKS: [&str; 3] = [", ", " / ", " in "];

/// A name and the unit at its end.
struct Apart<'a> {
    stem: &'a str,
    ending: &'a str,
    /// Whether a mark says that it is a unit; behind `_` it may be a motor, a phase, an axis or a sample.
    marked: bool,
}

/// Most names with a stroke that are looked at.
const MOST_STROKES: usize = 64;

/// A quantity over its unit, as DIN 1313 and ISO 80000 write it: `t/s`, `v/(mm/s)`.
fn over(name: &str) -> Option<(&str, &str)> {
    let (stem, unit) = name.split_once('/')?;
    let bare = unit
        .strip_prefix('(')
        .and_then(|unit| unit.strip_suffix(')'));
    let unit = bare.unwrap_or(unit);
    is_known(unit).then_some((stem, unit))
}

/// Whether strokes in the names of a table stand between quantities and units: in a path, `arm/position`, or where but one name has
/// one, `motor/A`, they are something else.
fn strokes_are_over_units(table: &Table) -> bool {
    let columns = table.columns.iter();
    let mut strokes = columns
        .filter(|column| column.name.contains('/'))
        .take(MOST_STROKES);
    let mut count = 0;
    strokes.all(|column| {
        count += 1;
        let name = column.name.trim();
        // A unit in brackets, `v/(mm/s)`, the file has set apart already.
        let is_apart = name.ends_with('/') && column.unit.is_some();
        is_apart || over(name).is_some()
    }) && count > 1
}

/// The name of a column without the unit at its end, and that; `None` where it ends in none.
fn apart(table: &Table, index: usize) -> Option<Apart<'_>> {
    let name = table.columns[index].name.trim();
    let mut marked = MARKS.into_iter().filter_map(|mark| name.rsplit_once(mark));
    let marked = marked.find(|(_, ending)| is_known(ending));
    let marked = marked.or_else(|| over(name).filter(|_| strokes_are_over_units(table)));
    let (stem, ending) = match marked {
        Some((stem, ending)) => (stem.trim_end(), ending.trim()),
        None => name
            .rsplit_once('_')
            .filter(|(_, ending)| UNITS.contains(ending))?,
    };
    (!stem.is_empty()).then_some(Apart {
        stem,
        ending,
        marked: marked.is_some(),
    })
}

/// Whether the ending of a name is one of several letters that tell columns apart: `pos_m` and `pos_l`, motor and load.
fn counts_columns(table: &Table, index: usize, stem: &str) -> bool {
    let others = table
        .columns
        .iter()
        .enumerate()
        .filter(|(i, _)| *i != index);
    let mut others = others.filter_map(|(_, other)| other.name.trim().rsplit_once('_'));
    others.any(|(other, ending)| other == stem && !UNITS.contains(&ending))
}

/// What a name without its ending says of the role that the unit fits, if anything; `None` where the ending is no unit.
fn read(table: &Table, index: usize) -> Option<(&str, Unit, Option<Hint>)> {
    let column = &table.columns[index];
    if column.unit.as_deref().is_some_and(|u| !u.trim().is_empty()) {
        return None;
    }
    let Apart {
        stem,
        ending,
        marked,
    } = apart(table, index)?;
    let unit = Unit::parse(ending).ok()?;
    let hint = names::hint(stem);
    let one_letter = ending.len() == 1;
    let fits = match hint {
        // Where it speaks against the name, that is to be seen.
        Some(_) if marked => true,
        Some(hint) => {
            let dimension = of_role(&unit, hint.role).dimension();
            // An angle in metres: the letter is that of a motor.
            let angle = names::motion(stem) == Some(Motion::Rotary);
            let turned = angle && dimension == Dimension::LENGTH;
            allows(hint.role, dimension) && !turned && !(ending == "m" && hint.weak)
        }
        None => !one_letter,
    };
    let told_apart = one_letter && !marked && counts_columns(table, index, stem);
    (fits && !told_apart).then_some((stem, unit, hint))
}

/// The unit at the end of a column's name, where nothing else gives one.
pub(super) fn unit(table: &Table, index: usize) -> Option<Unit> {
    read(table, index).map(|(_, unit, _)| unit)
}

/// The unit of a column, as the file or the ending of its name has it.
pub(super) fn unit_of(table: &Table, index: usize) -> Option<Unit> {
    let written = table.columns[index].unit.as_ref();
    let written = written.and_then(|unit| Unit::parse(unit).ok());
    written.or_else(|| unit(table, index))
}

/// The name of a column without the unit at its end.
pub(super) fn stem(table: &Table, index: usize) -> &str {
    match read(table, index) {
        Some((stem, ..)) => stem,
        None => &table.columns[index].name,
    }
}

/// What a column's name says.
pub(super) fn hint(table: &Table, index: usize) -> Option<Hint> {
    match read(table, index) {
        Some((.., hint)) => hint,
        None => names::hint(&table.columns[index].name),
    }
}

/// The unit at the end of the name of a column that has a role.
pub(super) fn of_channel(
    table: &Table,
    index: usize,
    channel: &Channel,
    role: Role,
) -> Option<Unit> {
    let unit = unit(table, index).or_else(|| {
        // Whoever gave the role said what the letter could be; metres may be a motor still.
        let Apart {
            stem,
            ending,
            marked,
        } = apart(table, index)?;
        let open = names::hint(stem).is_none() && ending != "m";
        let open = marked || open && !counts_columns(table, index, stem);
        Unit::parse(ending).ok().filter(|_| open)
    })?;
    let own = of_role(&unit, role).dimension();
    let scaled = match &channel.scale {
        None => Some(own),
        Some(scale) => own.times(scale.unit.dimension()),
    };
    let fits = |dimension: Dimension| allows(role, dimension) || role == Role::Load;
    scaled.is_some_and(fits).then_some(unit)
}
