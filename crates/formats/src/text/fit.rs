//! How well the head of a file reads with one separator.

use super::cell::{self, Cell};
use super::limits::MAX_COLUMNS;
use super::lines::Line;
use super::local::{Dates, Local};
use super::options::{Decimal, Separator, TextOptions};
use super::problem;
use super::row::{Role, Seen};
use super::split::{self, Ends};
use std::collections::BTreeMap;

/// A row of the head, understood with one separator.
pub(super) struct Row {
    /// Index of its line.
    pub index: usize,
    pub cells: Vec<Cell>,
    /// How each cell could be half of a number with decimal comma.
    pub whole: Vec<Whole>,
    all_quoted: bool,
}

/// How a cell could take part in a number that has its decimal comma as separator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Whole {
    /// Digits only: may stand before and after the comma.
    Digits,
    /// Signed or grouped: may stand before the comma.
    Before,
    /// Digits with an exponent: may stand after the comma.
    After,
    /// Neither.
    No,
}

/// The head of a file read with one separator.
pub(super) struct Fit {
    pub separator: Separator,
    pub width: usize,
    /// Columns of samples that are kept apart: one for each cell, then those of lists.
    pub kept: usize,
    /// Whether rows end in a separator.
    pub trailing: bool,
    /// What each column holds.
    pub roles: Vec<Role>,
    /// The rows of samples, the first one first.
    pub rows: Vec<Row>,
    /// Numbers and moments in those rows.
    pub samples: usize,
    /// Cells in those rows that are not empty.
    pub filled: usize,
}

/// A decimal mark, and where it showed.
pub(super) struct Mark {
    pub decimal: Decimal,
    /// Column from 0.
    pub column: usize,
    pub seen: Seen,
}

impl Fit {
    /// Reads the lines with a separator; `None` where no row of numbers shows.
    pub(super) fn new(
        lines: &[Line],
        skip: usize,
        separator: Separator,
        row_end: u8,
        options: &TextOptions,
    ) -> Option<Self> {
        let ends = Ends::new(separator, row_end);
        let rows: Vec<Row> = lines
            .iter()
            .enumerate()
            .skip(skip)
            .filter(|(_, line)| !line.is_blank() && !split::is_comment(line.text))
            .map(|(index, line)| row(index, line.text, &ends, options.decimal))
            .collect();
        let wide = common_width(&rows)?;
        let at_width = |r: &&Row| r.cells.len() == wide;
        let last_is_empty = |r: &Row| r.cells.last() == Some(&Cell::Empty);
        let trailing = wide > 1
            && separator != Separator::Blanks
            && rows.iter().filter(at_width).all(last_is_empty);
        let width = wide - usize::from(trailing);
        let columns: Vec<Column> = (0..width)
            .map(|c| Column::new(rows.iter().filter(at_width), c))
            .collect();
        let roles: Vec<Role> = columns.iter().map(Column::role).collect();
        if !roles
            .iter()
            .any(|r| !matches!(r, Role::Unknown | Role::Text))
        {
            return None;
        }
        let quoted = rows
            .iter()
            .filter(at_width)
            .filter(|r| r.all_quoted)
            .count();
        let mostly_quoted = 2 * quoted > rows.iter().filter(at_width).count();
        let rows: Vec<Row> = rows
            .into_iter()
            .filter(|r| r.fits(&roles, trailing) && (mostly_quoted || !r.all_quoted))
            .collect();
        let first = rows.first()?;
        let mut kept = width;
        let roles = roles
            .into_iter()
            .enumerate()
            .map(|(c, role)| match role {
                Role::Moment { .. } => first_moment(&rows, c).unwrap_or(role),
                Role::List { .. } => {
                    let role = first_list(&rows, c, kept).unwrap_or(role);
                    kept += role.columns();
                    role
                }
                other => other,
            })
            .collect();
        debug_assert!(first.cells.len() <= width + 1);
        let samples = rows
            .iter()
            .map(|r| r.cells.iter().map(|c| c.samples()).sum::<usize>())
            .sum();
        let filled = rows.iter().flat_map(|r| &r.cells);
        let filled = filled
            .filter(|c| **c != Cell::Empty)
            .map(|c| c.samples().max(1))
            .sum();
        Some(Self {
            separator,
            width,
            kept,
            trailing,
            roles,
            rows,
            samples,
            filled,
        })
    }

    /// The first decimal mark in a column of numbers, and the first that differs from it.
    pub(super) fn marks(&self, lines: &[Line], ends: &Ends) -> [Option<Mark>; 2] {
        let mut found: [Option<Mark>; 2] = [None, None];
        for row in &self.rows {
            for (c, cell) in row.cells.iter().enumerate() {
                let Cell::Number(_, Some(decimal)) = *cell else {
                    continue;
                };
                if self.roles.get(c) != Some(&Role::Number) {
                    continue;
                }
                let slot = match &found[0] {
                    None => 0,
                    Some(first) if first.decimal != decimal => 1,
                    Some(_) => continue,
                };
                let line = &lines[row.index];
                let cells = split::fields(line.text, ends, c + 1);
                let text = cells
                    .get(c)
                    .map(|f| problem::show(&f.text))
                    .unwrap_or_default();
                let seen = Seen {
                    line: line.number,
                    text,
                };
                found[slot] = Some(Mark {
                    decimal,
                    column: c,
                    seen,
                });
                if slot == 1 {
                    return found;
                }
            }
        }
        found
    }
}

impl Row {
    /// Whether this is a row of samples of columns with these roles.
    fn fits(&self, roles: &[Role], trailing: bool) -> bool {
        let width = self.cells.len();
        let whole = width == roles.len()
            || (trailing && width == roles.len() + 1 && self.cells.last() == Some(&Cell::Empty));
        whole
            && self.cells.iter().any(|c| c.is_sample())
            && self.cells.iter().zip(roles).all(|(cell, role)| match role {
                Role::Number => cell.is_void() || matches!(cell, Cell::Number(..)),
                Role::Moment { .. } => cell.is_void() || matches!(cell, Cell::Moment(_)),
                Role::Local(_) => cell.is_void() || matches!(cell, Cell::Local(_)),
                Role::List { .. } => cell.is_void() || matches!(cell, Cell::List(_)),
                _ => true,
            })
    }
}

fn row(index: usize, text: &[u8], ends: &Ends, decimal: Option<Decimal>) -> Row {
    let fields = split::fields(text, ends, MAX_COLUMNS + 2);
    let cells = fields
        .iter()
        .map(|f| match cell::classify(&f.text) {
            Cell::Number(_, Some(mark)) if decimal.is_some_and(|d| d != mark) => Cell::Text,
            cell => cell,
        })
        .collect();
    let whole = fields.iter().map(|f| whole(&f.text)).collect();
    let all_quoted = fields.iter().all(|f| f.quoted || f.text.is_empty());
    Row {
        index,
        cells,
        whole,
        all_quoted,
    }
}

fn whole(cell: &[u8]) -> Whole {
    if !cell.is_empty() && cell.iter().all(u8::is_ascii_digit) {
        return Whole::Digits;
    }
    let exponent = cell.iter().position(|b| b.eq_ignore_ascii_case(&b'e'));
    if exponent.is_some_and(|at| at > 0 && cell[..at].iter().all(u8::is_ascii_digit)) {
        return Whole::After;
    }
    let bare = cell
        .strip_prefix(b"-")
        .or_else(|| cell.strip_prefix(b"+"))
        .unwrap_or(cell);
    let mut groups = bare.split(|&b| b == b'.');
    let first = groups.next().unwrap_or_default();
    let digits = |g: &[u8]| !g.is_empty() && g.iter().all(u8::is_ascii_digit);
    let grouped = bare.contains(&b'.') && (first.len() > 3 || first.starts_with(b"0"));
    if digits(first) && !grouped && groups.all(|g| g.len() == 3 && digits(g)) {
        return Whole::Before;
    }
    Whole::No
}

/// The number of cells that holds most of the samples.
fn common_width(rows: &[Row]) -> Option<usize> {
    let mut samples: BTreeMap<usize, usize> = BTreeMap::new();
    for row in rows {
        *samples.entry(row.cells.len()).or_default() +=
            row.cells.iter().filter(|c| c.is_sample()).count();
    }
    let (&width, &most) = samples.iter().max_by_key(|(_, samples)| **samples)?;
    (most > 0).then_some(width)
}

/// How many cells of a column are of each sort.
#[derive(Default)]
struct Column {
    numbers: usize,
    dated: usize,
    of_day: usize,
    local: usize,
    first_local: Option<Local>,
    lists: usize,
    length: usize,
    filled: usize,
}

impl Column {
    fn new<'a>(rows: impl Iterator<Item = &'a Row>, column: usize) -> Self {
        let mut counts = Self::default();
        // A row without any sample is a header or units row.
        for cell in rows
            .filter(|r| r.cells.iter().any(|c| c.is_sample()))
            .map(|r| r.cells[column])
        {
            match cell {
                Cell::Number(..) => counts.numbers += 1,
                Cell::Moment(m) if m.dated => counts.dated += 1,
                Cell::Moment(_) => counts.of_day += 1,
                Cell::Local(date) => {
                    counts.local += 1;
                    counts.first_local.get_or_insert(date);
                }
                Cell::List(length) => {
                    counts.lists += 1;
                    counts.length = length;
                }
                _ => {}
            }
            counts.filled += usize::from(!cell.is_void());
        }
        counts
    }

    /// The role that at least half of the cells have.
    fn role(&self) -> Role {
        let half = |count: usize| 2 * count >= self.filled;
        match self {
            Column { filled: 0, .. } => Role::Unknown,
            Column { numbers, .. } if half(*numbers) => Role::Number,
            Column { dated, .. } if half(*dated) => Role::Moment {
                base: 0,
                dated: true,
            },
            Column { of_day, .. } if half(*of_day) => Role::Moment {
                base: 0,
                dated: false,
            },
            Column {
                local,
                first_local: Some(first),
                ..
            } if half(*local) => Role::Local(Dates::from(*first)),
            Column { lists, length, .. } if half(*lists) => Role::List {
                first: 0,
                length: *length,
            },
            _ => Role::Text,
        }
    }
}

fn first_moment(rows: &[Row], column: usize) -> Option<Role> {
    rows.iter().find_map(|r| match r.cells.get(column) {
        Some(Cell::Moment(m)) => Some(Role::Moment {
            base: m.ns,
            dated: m.dated,
        }),
        _ => None,
    })
}

/// A column of lists, whose samples are kept from a place on.
fn first_list(rows: &[Row], column: usize, first: usize) -> Option<Role> {
    rows.iter().find_map(|r| match r.cells.get(column) {
        Some(Cell::List(length)) => Some(Role::List {
            first,
            length: *length,
        }),
        _ => None,
    })
}
