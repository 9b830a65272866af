//! Columns of a log, and what a user corrects of them: written into the axis file, as he would type it.

use super::Column;
use crate::refused::Refused;
use crate::workspace::Workspace;
use serde::Deserialize;
use std::path::Path;
use stiction::Axis;
use stiction::commands::axis::{Addition, extend};
use stiction::commands::{check, recording, table, visible, write_atomic};

/// Columns that are told of.
const MOST: usize = 256;

/// A correction, as the page sends it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Correction {
    pub log: String,
    pub axis: String,
    /// `time`, `position`, `force`; `kind` for the kind of motion.
    pub role: String,
    /// Number of the column, from 1.
    pub column: Option<usize>,
    /// The name of the column where no other column has it.
    pub name: Option<String>,
    pub unit: Option<String>,
    pub scale: Option<String>,
    #[serde(default)]
    pub invert: bool,
}

/// A column that was understood.
pub fn understood(column: &recording::Understood) -> Column {
    let (number, name) = column
        .column
        .split_once(' ')
        .unwrap_or((&column.column, ""));
    Column {
        number: number.parse().unwrap_or(0),
        name: name.trim_matches('"').into(),
        role: column.role.map(|role| role.to_string()),
        unit: column.unit.clone(),
        reason: column.reason.clone(),
        assumed: column.assumed.is_some(),
    }
}

/// The columns of a file that is not understood, with those that are clear by themselves.
pub fn unread(path: &Path, axis: &Axis) -> Result<Vec<Column>, Refused> {
    let table = table(path, axis)?;
    let clear = recording::Mapping::clear_columns(&table);
    let columns = table.columns.iter().enumerate().take(MOST);
    let one = |(at, column): (usize, &stiction::Column)| {
        let number = table.number(at);
        let is = |channel: &&recording::Channel| match &channel.column {
            recording::Selector::Name(name) => *name == column.name,
            recording::Selector::Index(own) => *own == number,
        };
        let mut roles = recording::Role::ALL.into_iter();
        let role = roles.find(|role| clear.channel(*role).filter(is).is_some());
        Column {
            number,
            name: column.name.clone(),
            role: role.map(|role| role.to_string()),
            unit: column.unit.clone().unwrap_or_default(),
            reason: match role {
                Some(_) => "clear by itself".into(),
                None => "not clear".into(),
            },
            assumed: false,
        }
    };
    Ok(columns.map(one).collect())
}

/// Names under which a role stands in an axis file.
fn names(role: &str) -> Option<&'static [&'static str]> {
    Some(match role {
        "time" => &["time"],
        "position" => &["position"],
        "velocity" => &["velocity"],
        "acceleration" => &["acceleration"],
        "force" => &["force", "torque", "current"],
        "reference" => &["reference"],
        "temperature" => &["temperature"],
        "load" => &["load"],
        "external" => &["external"],
        _ => return None,
    })
}

/// Writes a correction into the axis file, which is begun as `stiction check --init` begins it where there is none; what changed.
pub fn correct(workspace: &Workspace, asked: &Correction) -> Result<Vec<String>, Refused> {
    let log = workspace.file(&asked.log)?;
    let file = workspace.place(&asked.axis)?;
    let text = match file.is_file() {
        true => std::fs::read_to_string(&file)?,
        false => check::init(&log, None)?.text,
    };
    let quoted = |text: &str| serde_json::Value::from(text).to_string();
    let addition = if asked.role == "kind" {
        Addition {
            table: "",
            names: &["kind"],
            value: quoted(asked.unit.as_deref().unwrap_or_default()),
            why: "chosen on the page".into(),
            replaces: true,
        }
    } else {
        let names = names(&asked.role)
            .ok_or_else(|| Refused::bad(format!("{}: no column is that", asked.role)))?;
        let selector = match (&asked.name, asked.column) {
            (Some(name), _) if !name.is_empty() => quoted(name),
            (_, Some(number)) => number.to_string(),
            _ => return Err(Refused::bad("which column?")),
        };
        let mut value = format!("{{ column = {selector}");
        for (key, given) in [("unit", &asked.unit), ("scale", &asked.scale)] {
            if let Some(given) = given.as_ref().filter(|given| !given.trim().is_empty()) {
                value.push_str(&format!(", {key} = {}", quoted(given.trim())));
            }
        }
        if asked.invert {
            value.push_str(", invert = true");
        }
        value.push_str(" }");
        Addition {
            table: "columns",
            names,
            value,
            why: "chosen on the page".into(),
            replaces: true,
        }
    };
    let value = addition.value.clone();
    let (next, changes) = extend(&text, &[addition]);
    if changes
        .iter()
        .any(|change| change.starts_with("to write by hand"))
    {
        // What is wrong with it is said best by the reader of the file.
        let alone = match asked.role.as_str() {
            "kind" => format!("kind = {value}\n"),
            role => format!("[columns]\n{role} = {value}\n"),
        };
        Axis::parse(&alone)?;
        return Err(Refused::conflict(format!(
            "{}: the line cannot be placed; write it by hand: {}",
            asked.axis,
            changes.join("; ")
        )));
    }
    write_atomic(&file, visible::toml(next).as_bytes())?;
    Ok(changes)
}
