//! Columns in words, for what was detected and for errors.

use crate::Table;
use std::fmt::Display;

/// `column 5 "Torque [N m]"`, or `column 5` where it has no name.
pub(super) fn column(table: &Table, index: usize) -> String {
    format!("column {}", place(table, index))
}

/// `5 "Torque [N m]"`, or `5` where it has no name: a column as the place of an error.
pub(super) fn place(table: &Table, index: usize) -> String {
    match key(table, index) {
        name if name.is_empty() => table.number(index).to_string(),
        name => format!("{} {name}", table.number(index)),
    }
}

/// `"Torque [N m]"` in quotes; empty where the column has no name.
pub(super) fn key(table: &Table, index: usize) -> String {
    let column = &table.columns[index];
    let name = shortened(&column.name);
    match (&column.unit, name.as_str()) {
        (_, "") => String::new(),
        (Some(unit), name) => format!("\"{name} [{}]\"", shortened(unit)),
        (None, name) => format!("\"{name}\""),
    }
}

/// What a table has, as a sentence: `there are columns 1 "t", 2 "x"`, and what was left out of it.
pub(super) fn columns(table: &Table) -> String {
    let there = match table.columns.len() {
        0 => "there are no columns".to_string(),
        1 => format!("there is only {}", column(table, 0)),
        count if unnamed(table) => format!("there are {count} columns without names"),
        count => format!(
            "there are columns {}",
            listed((0..count).map(|i| place(table, i)))
        ),
    };
    if table.skipped.is_empty() {
        return there;
    }
    let left_out = listed(table.skipped.iter().map(|text| shortened(text)));
    format!("{there}; left out: {left_out}")
}

/// Most characters of a text that are quoted.
const QUOTED: usize = 80;

/// As many characters of a text as are quoted.
fn shortened(text: &str) -> String {
    match text.char_indices().nth(QUOTED) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_string(),
    }
}

/// Whether no column has a name or a unit.
pub(super) fn unnamed(table: &Table) -> bool {
    table
        .columns
        .iter()
        .all(|c| c.name.is_empty() && c.unit.is_none())
}

/// Items with commas, at most twelve.
pub(super) fn listed(items: impl ExactSizeIterator<Item = String>) -> String {
    let count = items.len();
    let mut shown: Vec<String> = items.take(12).collect();
    if count > shown.len() {
        shown.push(format!("and {} more", count - shown.len()));
    }
    shown.join(", ")
}

/// The line of `axis.toml` that makes a column a role: `force = "Torque"`, by number where the name
/// does not tell it apart.
pub(super) fn line(table: &Table, index: usize, role: impl Display) -> String {
    format!("{role} = {}", value(table, index))
}

/// The same with a unit to fill in: `force = { column = "Torque", unit = "N*m" }`.
pub(super) fn line_with(table: &Table, index: usize, role: impl Display, rest: &str) -> String {
    format!("{role} = {{ column = {}, {rest} }}", value(table, index))
}

/// Whether a character stands for nothing that is seen, or turns what is around it: a line that has it cannot be copied.
fn is_unseen(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
}

fn value(table: &Table, index: usize) -> String {
    let name = &table.columns[index].name;
    let unique = table.columns.iter().filter(|c| c.name == *name).count() == 1;
    let plain = !name.is_empty() && !name.contains(['"', '\\']) && !name.contains(is_unseen);
    if unique && plain && name.chars().count() <= QUOTED {
        format!("\"{name}\"")
    } else {
        table.number(index).to_string()
    }
}
