//! Names and units of columns from the lines that hold them.

use super::limits::MAX_COLUMNS;
use super::lines::Line;
use super::options::Separator;
use super::problem;
use super::row::Role;
use super::split::{self, Ends};
use super::unit;
use crate::binary::Collector;

/// Name and unit of one column.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Title {
    pub name: String,
    pub unit: Option<String>,
}

impl Title {
    /// The names of the columns that it has: `name(:,1)` and so on of lists.
    pub(super) fn each(&self, role: Role) -> impl Iterator<Item = String> {
        (0..role.columns()).map(move |index| match role {
            Role::List { .. } => Collector::of_matrix(&self.name, index),
            _ => self.name.clone(),
        })
    }
}

/// The cells of a line above the samples, as text. Where blanks separate, a unit in brackets belongs
/// to the name before it (`Position [mm]`).
pub(super) fn texts(line: &Line, ends: &Ends) -> Vec<String> {
    let fields = split::fields(line.text, ends, MAX_COLUMNS + 2);
    let mut cells: Vec<String> = Vec::with_capacity(fields.len());
    let mut bare_before = false;
    for text in fields.iter().map(|f| problem::name(&f.text)) {
        let bare = unit::bare(&text) == text;
        match cells.last_mut() {
            Some(name) if ends.separator == Separator::Blanks && !bare && bare_before => {
                name.push(' ');
                name.push_str(&text);
            }
            _ => cells.push(text),
        }
        bare_before = bare;
    }
    cells
}

/// Names with the units that stand in their brackets.
pub(super) fn titles(names: &[String]) -> Vec<Title> {
    names
        .iter()
        .map(|header| {
            // A line end within a quoted name is a blank.
            let header = header.split_whitespace().collect::<Vec<_>>().join(" ");
            let (name, unit) = unit::split(&header);
            Title { name, unit }
        })
        .collect()
}

/// Whether these cells are a row of units: known ones, in brackets or not, or nothing.
pub(super) fn is_units(cells: &[String]) -> bool {
    let none = |c: &str| c.is_empty() || c == "-";
    cells
        .iter()
        .all(|c| none(c) || unit::is_known(unit::bare(c)) || unit::bare(c) != c)
        && cells.iter().any(|c| unit::is_known(unit::bare(c)))
}

/// Adds a row of units to titles; gives the first column for which both name a unit and differ.
pub(super) fn add_units(titles: &mut [Title], units: &[String]) -> Option<usize> {
    let mut clash = None;
    for (column, (title, cell)) in titles.iter_mut().zip(units).enumerate() {
        let unit = unit::bare(cell);
        if unit.is_empty() || unit == "-" {
            continue;
        }
        if title.unit.as_deref().is_some_and(|u| u != unit) {
            clash = clash.or(Some(column));
        }
        title.unit = Some(unit.to_owned());
    }
    clash
}
