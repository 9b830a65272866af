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

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors of ten methods in so many parameters, with names as in files.
    fn errors(names: &[&str], cell: &str) -> Table {
        let columns = names.iter().map(|name| (*name, Align::Right));
        let table = Table::new(std::iter::once(("Method", Align::Left)).chain(columns));
        let row = std::iter::once("nelder\u{2011}mead").chain(names.iter().map(|_| cell));
        table.row(row)
    }

    const NAMES: [&str; 8] = [
        "sigma2_pos",
        "coulomb_pos",
        "static_pos",
        "stribeck_velocity_pos",
        "sigma2_neg",
        "coulomb_neg",
        "static_neg",
        "stribeck_velocity_neg",
    ];

    /// Chromium 156 with DejaVu Sans, a wide face, sets the table of [`NAMES`] in 981 px at least, densely.
    #[test]
    fn the_estimate_is_that_of_a_browser() {
        let width = least(&errors(&NAMES, "0.12 %"), &DENSE);
        assert!((width / 981.0 - 1.0).abs() < 0.05, "{width}");
    }

    #[test]
    fn tables_are_set_as_widely_as_they_fit() {
        let short = ["σ₂⁺", "Fc⁺", "Fs⁺", "vs⁺", "σ₂⁻", "Fc⁻", "Fs⁻", "vs⁻"];
        assert_eq!(Setting::of(&errors(&short, "0.12 %")), Setting::Normal);
        assert_eq!(Setting::of(&errors(&NAMES[..7], "0.12 %")), Setting::Dense);
        assert_eq!(Setting::of(&errors(&NAMES, "0.12 %")), Setting::Scrolling);
        // Words may be broken, numbers not.
        let words = errors(&short, "0.12 %").row(["a name of many words"; 1]);
        assert_eq!(Setting::of(&words), Setting::Normal);
        let digits = "1".repeat(40);
        assert_eq!(Setting::of(&errors(&short, &digits)), Setting::Scrolling);
    }

    /// A long path or hash does not widen its column.
    #[test]
    fn long_words_are_broken() {
        let path = "/home/somebody/measurements/2026_11_22/x_axis_stribeck_run_0001.csv";
        let table = Table::new([("Log", Align::Left), ("Samples", Align::Right)]);
        let table = table.row([path.to_string(), "30 001".into()]);
        assert!(least(&table, &NORMAL) < 450.0);
        let mut html = String::new();
        table.push_html("", &mut html);
        assert!(html.contains("measurements/<wbr/>"), "{html}");
        assert_eq!(html.replace("<wbr/>", "").matches(path).count(), 1);
    }
}
