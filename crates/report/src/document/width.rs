//! How wide a table is, estimated from its characters: the fonts of the reader are not known here.

use super::table::{Align, Table};

/// Room for a table beside nothing else, px: what the style sheet gives the page's content from a window of 1000 px on.
pub(crate) const ROOM: f64 = 880.0;

/// How closely a table is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Setting {
    /// As other text.
    Normal,
    /// Smaller type, columns closer together.
    Dense,
    /// Dense, and still wider than the page: it scrolls sideways.
    Scrolling,
}

/// Sizes of the style sheet, px.
struct Sizes {
    cell: f64,
    header: f64,
    /// Between columns.
    gap: f64,
}

const NORMAL: Sizes = Sizes {
    cell: 14.7,
    header: 13.5,
    gap: 17.6,
};
const DENSE: Sizes = Sizes {
    cell: 13.2,
    header: 12.4,
    gap: 11.2,
};
/// Before the first column, px.
const MARGIN: f64 = 8.0;
/// A sign before the first cell of a marked row, in its letters.
const SIGN: f64 = 1.4;

impl Setting {
    /// The widest setting in which the table fits the page.
    pub fn of(table: &Table) -> Self {
        if least(table, &NORMAL) <= ROOM {
            Setting::Normal
        } else if least(table, &DENSE) <= ROOM {
            Setting::Dense
        } else {
            Setting::Scrolling
        }
    }
}

/// The least width, where everything is broken that may be: headers and words between their words, numbers nowhere.
fn least(table: &Table, sizes: &Sizes) -> f64 {
    let columns = (table.columns.len()).max(
        table
            .rows
            .iter()
            .map(|row| row.cells.len())
            .max()
            .unwrap_or(0),
    );
    let column = |i: usize| {
        let (name, align) = match table.columns.get(i) {
            Some((name, align)) => (Some(name), *align),
            None => (None, Align::Left),
        };
        let header = name.map_or(0.0, |name| name.widest_piece(sizes.header) * 1.08);
        let cells = table.rows.iter().filter_map(|row| {
            let cell = row.cells.get(i)?;
            let sign = match row.severity {
                Some(_) if i == 0 => SIGN * sizes.cell,
                _ => 0.0,
            };
            let width = match align {
                Align::Right => cell.width(sizes.cell),
                _ => cell.widest_piece(sizes.cell),
            };
            Some(sign + width)
        });
        cells.fold(header, f64::max) + sizes.gap
    };
    MARGIN + (0..columns).map(column).sum::<f64>()
}
