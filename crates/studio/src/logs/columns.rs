//! Columns of a log, and what a user corrects of them: written into the axis file, as he would type it.

use super::{Column, Logs};
use crate::named::read_as;
use crate::refused::Refused;
use crate::workspace::Workspace;
use serde::Deserialize;
use stiction_files::Axis;
use stiction_files::axis::{Addition, extend};
use stiction_files::{visible, write_atomic};
use stiction_log as recording;
use stiction_workflows::check;
use stiction_workflows::source::load;

/// Columns that are told of.
const MOST: usize = 256;

/// A correction, as the page sends it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Correction {
    pub log: String,
    pub axis: String,
    /// `time`, `position`, `force`; `kind` for the kind of motion, `rate` for that of a log without time.
    pub role: String,
    /// Number of the column, from 1.
    pub column: Option<usize>,
    /// The name of the column where no other column has it.
    pub name: Option<String>,
    /// The unit of the column; the kind or the rate itself.
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
        range: None,
    }
}

/// The columns of a file that is not understood, with those that are clear by themselves.
pub fn unread(table: &recording::Table) -> Vec<Column> {
    let clear = recording::Mapping::clear_columns(table);
    let columns = table.columns.iter().enumerate().take(MOST);
    let one = |(at, column): (usize, &stiction_log::Column)| {
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
            range: range(&column.values),
        }
    };
    columns.map(one).collect()
}

/// Refuses a number that makes a force of a current or voltage without saying of which unit.
fn has_unit(scale: &str, unit: &str) -> Result<(), Refused> {
    let electric = ["A", "mA", "V", "mV"].contains(&unit);
    match electric && scale.parse::<f64>().is_ok() {
        true => Err(Refused::bad(format!(
            "times {scale}: of which unit? Write it too, such as {scale} N/{unit} or {scale} N*m/{unit}"
        ))),
        false => Ok(()),
    }
}

/// Lowest and highest of the numbers.
fn range(values: &[f64]) -> Option<(f64, f64)> {
    let finite = values.iter().filter(|value| value.is_finite());
    finite.fold(None, |range, value| {
        let (low, high) = range.unwrap_or((*value, *value));
        Some((low.min(*value), high.max(*value)))
    })
}

/// What a role that is no column is called in an axis file.
fn key(role: &str) -> Option<&'static [&'static str]> {
    match role {
        "kind" => Some(&["kind"]),
        "rate" => Some(&["rate"]),
        _ => None,
    }
}

/// Lines with the units that were assumed of other columns than this one.
fn assumed(columns: &[Column], but: &str) -> Vec<Addition> {
    let others = columns.iter().filter(|column| column.assumed);
    let line = |column: &Column| {
        let role = column.role.as_deref().filter(|role| *role != but)?;
        Some(Addition {
            table: "columns",
            names: names(role)?,
            value: format!(
                "{{ column = {}, unit = {} }}",
                column.number,
                serde_json::Value::from(column.unit.as_str())
            ),
            why: String::new(),
            replaces: true,
        })
    };
    others.filter_map(line).collect()
}

/// Names under which a role stands in an axis file.
fn names(role: &str) -> Option<&'static [&'static str]> {
    let mut roles = recording::Role::ALL.into_iter();
    roles.find(|own| own.name() == role).map(check::names)
}

/// Writes a correction into the axis file, which is begun as `stiction check --init` begins it where there is none; what changed.
/// One with which the log would not be understood any more is not written.
pub fn correct(
    logs: &Logs,
    workspace: &Workspace,
    asked: &Correction,
) -> Result<Vec<String>, Refused> {
    let log = workspace.file(&asked.log)?;
    let (file, text) = workspace.axis(&asked.axis)?;
    let axis = text.is_some().then_some(asked.axis.as_str());
    let text = text.map_or_else(|| Ok(check::init(&log, None)?.text), Ok::<_, Refused>)?;
    let quoted = |text: &str| serde_json::Value::from(text).to_string();
    let addition = if let Some(names) = key(&asked.role) {
        Addition {
            table: "",
            names,
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
        if let (Some(unit), Some(scale)) = (&asked.unit, &asked.scale) {
            has_unit(scale.trim(), unit.trim())?;
        }
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
        let role = &asked.role;
        let alone = match key(role) {
            Some(_) => format!("{role} = {value}\n"),
            None => format!("[columns]\n{role} = {value}\n"),
        };
        Axis::parse(&alone)?;
        return Err(Refused::conflict(format!(
            "{}: the line cannot be placed; write it by hand: {}",
            asked.axis,
            changes.join("; ")
        )));
    }
    let before = logs.log(workspace, &asked.log, axis);
    if let Ok(before) = before
        && before.about.refused.is_none()
    {
        // Units that the file does not give are asked for one after the other: the others are taken as they were.
        let (whole, _) = extend(&next, &assumed(&before.about.columns, &asked.role));
        read_as(
            &file,
            &whole,
            |beside| -> Result<_, stiction_workflows::Error> {
                load(&log, &Axis::read(beside)?.of_whole(&log))
            },
        )?;
    }
    write_atomic(&file, visible::toml(next).as_bytes())?;
    Ok(changes)
}
