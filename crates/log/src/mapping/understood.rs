//! What became of every column of a file, and why, for people.

use super::channel::Role;
use super::complete::Part;
use super::enable::Enable;
use super::flags::{has_zeros, is_flag};
use super::names;
use super::still::{has_to_change, never_changes};
use super::{Mapping, describe, endings};
use crate::{Dimension, Table, Unit};

/// A column of the file and what became of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Understood {
    /// Its number, counted from 1, with its name in quotes where it has one: `2 "Position [mm]"`.
    pub column: String,
    /// What it is taken for; `None` where it is not used.
    pub role: Option<Role>,
    /// The unit its numbers are read in, with scale and sign: `A, scale 96 N/A, sign inverted`. Empty where it is not
    /// used.
    pub unit: String,
    /// Why it is taken for that, or why it is not used, and where the unit comes from.
    pub reason: String,
    /// Where nothing gave the unit: the unit that was assumed, and the line of the axis file that settles it.
    pub assumed: Option<Assumed>,
}

/// A unit that nothing gave.
#[derive(Clone, Debug, PartialEq)]
pub struct Assumed {
    /// The unit.
    pub unit: String,
    /// The line for `[columns]` of the axis file: `force = { column = "F", unit = "N" }`.
    pub line: String,
}

/// Every column of a table in order.
pub(super) fn all(table: &Table, given: &Mapping, parts: &[Part]) -> Vec<Understood> {
    let one = |column| match parts.iter().find(|part| part.column == column) {
        Some(part) => used(table, given, part),
        None => unused(table, given, parts, column),
    };
    (0..table.columns.len()).map(one).collect()
}

fn used(table: &Table, given: &Mapping, part: &Part) -> Understood {
    let Part { role, column, .. } = *part;
    let by = if given.channel(role).is_some() {
        "named in the axis file"
    } else if endings::hint(table, column).is_some_and(|hint| hint.role == role) {
        "by its name"
    } else if names::hint_of_axis(endings::stem(table, column))
        .is_some_and(|hint| hint.role == role)
    {
        "by the name of its axis"
    } else {
        "the only column in such a unit"
    };
    let unit = part.unit.as_ref().map(Unit::to_string).unwrap_or_default();
    let written = table.columns[column].unit.is_some();
    let from = match (&part.channel.unit, part.assumed, written) {
        (_, true, _) => "its unit is given nowhere and assumed",
        (Some(_), ..) => "its unit from the axis file",
        (None, _, true) => "its unit as the file has it",
        (None, ..) if endings::of_channel(table, column, &part.channel, role).is_some() => {
            "its unit from the ending of its name"
        }
        (None, ..) => "its unit from the scale",
    };
    let assumed = part.assumed.then(|| Assumed {
        line: describe::line_with(table, column, role, &format!("unit = \"{unit}\"")),
        unit: unit.clone(),
    });
    let mut read = unit;
    if let Some(scale) = &part.channel.scale {
        read.push_str(&format!(", scale {scale}"));
    }
    if part.channel.invert {
        read.push_str(", sign inverted");
    }
    Understood {
        column: describe::place(table, column),
        role: Some(role),
        unit: read,
        reason: format!("{by}; {from}"),
        assumed,
    }
}

/// A column that is what its name says no more than others are.
fn against(role: Role) -> String {
    format!("could be the {role}, but its unit or others speak against it")
}

/// A flag, and how rows where it is 0 are left out where there are such.
fn flag(table: &Table, column: usize) -> String {
    let disturbed = names::says_disturbed(&table.columns[column].name);
    let how = match (has_zeros(table, column), disturbed) {
        (true, Some(what)) => format!(
            "; if {what} where it is 1, leave out those rows: {} under [columns]",
            Enable::line(table, column, "0")
        ),
        (true, None) => format!(
            "; if the axis is enabled where it is 1, leave out the others: {} under [columns]",
            Enable::whole_line(table, column)
        ),
        (false, _) => String::new(),
    };
    format!("a flag: 0 and 1 alone{how}")
}

/// What a column is where it comes again further on under the same name: those that are joined by time stamps stand behind the
/// others.
fn joined_from<'a>(table: &Table, parts: &'a [Part], column: usize) -> Option<&'a Part> {
    let own = &table.columns[column];
    parts.iter().find(|part| {
        let other = &table.columns[part.column];
        part.column > column && (&other.name, &other.unit) == (&own.name, &own.unit)
    })
}

/// The line of the axis file for a force that acts beside that of the motor.
fn beside(table: &Table, column: usize, what: &str) -> String {
    let line = describe::line(table, column, Role::External);
    format!("if it is {what}: {line} under [columns]")
}

/// Whether the unit of a column is one of force or torque.
fn is_force_by_unit(table: &Table, column: usize) -> bool {
    let unit = table.columns[column].unit.as_ref();
    let unit = unit.and_then(|unit| Unit::parse(unit).ok());
    unit.is_some_and(|unit| [Dimension::FORCE, Dimension::TORQUE].contains(&unit.dimension()))
}

fn unused(table: &Table, given: &Mapping, parts: &[Part], column: usize) -> Understood {
    let name = &table.columns[column].name;
    let hint = endings::hint(table, column);
    let taken = hint.and_then(|hint| parts.iter().find(|part| part.role == hint.role));
    let named = Role::ALL.iter().any(|role| given.channel(*role).is_some());
    let enables = matches!(Enable::of(given, table), Ok(Some(own)) if own == column);
    let kept = given
        .enable
        .as_ref()
        .map_or_else(String::new, Enable::kept_words);
    if let Some(part) = joined_from(table, parts, column) {
        return Understood {
            column: describe::place(table, column),
            role: None,
            unit: String::new(),
            reason: format!(
                "comes again as column {}, which is the {}",
                describe::place(table, part.column),
                part.role
            ),
            assumed: None,
        };
    }
    let reason = match (hint, taken) {
        _ if enables => {
            format!("named in the axis file as enable: rows where it is not {kept} are left out")
        }
        _ if is_flag(table, column) => flag(table, column),
        (Some(hint), _) if has_to_change(hint.role) && never_changes(table, column) => {
            format!("could be the {}, but never changes", hint.role)
        }
        (_, Some(part)) => format!(
            "could be the {} too, which is column {}{}",
            part.role,
            describe::place(table, part.column),
            match part.role == Role::Force && given.external.is_none() {
                true => format!("; {}", beside(table, column, "a second motor of the axis")),
                false => String::new(),
            }
        ),
        (Some(hint), None) if hint.role == Role::Time && given.rate_hz.is_some() => {
            "could be the time, which the rate of the axis file is taken for".into()
        }
        (Some(hint), _) if given.absent.contains(&hint.role) => {
            format!("{} = \"none\" in the axis file", hint.role)
        }
        (Some(hint), None) if Role::OPTIONAL.contains(&hint.role) => against(hint.role),
        _ if named => "not named in the axis file".into(),
        _ if names::says_mode(name) => format!(
            "a mode or a state by its name; to leave out rows where it is another than 8: enable = {{ column = {}, equals = 8 \
             }} under [columns]",
            describe::line(table, column, "").trim_start_matches(" = ")
        ),
        _ if names::passed_over(name) => "an error, a limit or a state by its name".into(),
        (Some(hint), None) => against(hint.role),
        (None, None) if name.is_empty() => "has no name".into(),
        (None, None) if never_changes(table, column) => {
            "its name says nothing known, and it never changes".into()
        }
        (None, None) if is_force_by_unit(table, column) => format!(
            "its name says nothing known; {}",
            beside(
                table,
                column,
                "a force on the axis beside that of the motor"
            )
        ),
        (None, None) => "its name says nothing known".into(),
    };
    Understood {
        column: describe::place(table, column),
        role: None,
        unit: String::new(),
        reason,
        assumed: None,
    }
}
