//! Numbers in cells that are texts, with a decimal comma: what a program writes that does not know numbers, and what stays of a
//! German table that was opened in an English Excel.
//!
//! The second is the danger: Excel has made numbers of the cells that it could read, `1,234` is 1234 there, and has left the
//! others as texts. So a column of texts with commas is read, one that has numbers among them is refused.

use crate::text::{Cell, Decimal, classify};
use crate::{Error, Kind};

/// The decimal marks of the texts of a sheet, a column each.
#[derive(Default)]
pub(super) struct Commas {
    columns: Vec<Column>,
}

#[derive(Clone, Default)]
struct Column {
    /// The row of the first text with a comma, and what it says.
    comma: Option<(u64, String)>,
    /// The row of the first text with a point.
    point: Option<(u64, String)>,
    /// The row of the first number.
    number: Option<u64>,
    /// Whether some comma is certainly a decimal one: not every text is as `12,345`, which may be twelve thousand.
    is_decimal: bool,
}

impl Commas {
    /// Takes note of a cell (column from 0, row from 1).
    pub fn see(&mut self, column: usize, row: u64, text: &str, is_text: bool) {
        let cell = classify(text.as_bytes());
        if matches!(cell, Cell::Text) {
            // The title of a column: what stands above it is no sample.
            if let Some(above) = self.columns.get_mut(column) {
                *above = Column::default();
            }
        }
        let Cell::Number(_, mark) = cell else {
            return;
        };
        if self.columns.len() <= column {
            self.columns.resize(column + 1, Column::default());
        }
        let seen = &mut self.columns[column];
        let here = || (row, text.to_owned());
        match mark {
            _ if !is_text => {
                seen.number.get_or_insert(row);
            }
            Some(Decimal::Comma) => {
                seen.comma.get_or_insert_with(here);
                seen.is_decimal |= !may_be_thousands(text);
            }
            Some(Decimal::Point) => {
                seen.point.get_or_insert_with(here);
            }
            None => {}
        }
    }

    /// Refuses columns in which texts with a comma stand beside other numbers.
    pub fn check(&self) -> Result<(), Error> {
        for (column, seen) in self.columns.iter().enumerate() {
            let Some((row, text)) = &seen.comma else {
                continue;
            };
            let beside = match (&seen.number, &seen.point) {
                (Some(row), _) => format!("a number in row {row}"),
                (None, Some((row, text))) => format!("the text `{text}` in row {row}"),
                (None, None) => continue,
            };
            return Err(Error::new(
                Kind::Ambiguous,
                format!("the text `{text}` with a decimal comma beside {beside}"),
                "a column of numbers alone, or of texts with one decimal mark; where Excel has opened a table with decimal \
                 commas, some of its numbers are a thousand times too large now: give the table itself (CSV), which is read \
                 with commas",
            )
            .at_row(*row)
            .in_column(letters(column)));
        }
        Ok(())
    }

    /// Whether there is a column of texts with decimal commas.
    pub fn any(&self) -> bool {
        self.columns.iter().any(|column| column.is_decimal)
    }

    /// Puts a point for the comma of a text that is a number of such a column. Where every comma may be one of thousands the texts
    /// stay as they are, and the column is left out as one of texts.
    pub fn to_point(&self, column: usize, text: &mut String) {
        let has_commas = self.columns.get(column).is_some_and(|c| c.is_decimal);
        let number = || classify(text.as_bytes());
        if has_commas && matches!(number(), Cell::Number(_, Some(Decimal::Comma))) {
            *text = text.replace(',', ".");
        }
    }
}

/// Whether the comma of a number may stand behind thousands: `12,345`, and neither `0,345` nor `12,3`.
fn may_be_thousands(text: &str) -> bool {
    let digits = text.trim().trim_start_matches(['-', '+', '\u{2212}']);
    digits.split_once(',').is_some_and(|(whole, part)| {
        let all = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
        (1..=3).contains(&whole.len())
            && !whole.starts_with('0')
            && part.len() == 3
            && all(whole)
            && all(part)
    })
}

/// The name of a column as Excel shows it: A, B .. Z, AA (from 0).
pub(super) fn letters(column: usize) -> String {
    let (mut left, mut name) = (column + 1, String::new());
    while left > 0 {
        left -= 1;
        name.insert(0, char::from(b'A' + (left % 26) as u8));
        left /= 26;
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(cells: &[(u64, &str, bool)]) -> Commas {
        let mut commas = Commas::default();
        for (row, text, is_text) in cells {
            commas.see(1, *row, text, *is_text);
        }
        commas
    }

    #[test]
    fn texts_with_commas_are_read_and_mixtures_are_refused() {
        let title = (1, "1000", false);
        let commas = seen(&[title, (3, "Kraft", true), (4, "1,5", true), (5, "2", true)]);
        assert_eq!(commas.check(), Ok(()));
        let mut text = "-1,5e-3".to_owned();
        commas.to_point(1, &mut text);
        assert_eq!(text, "-1.5e-3");
        commas.to_point(0, &mut text);
        for mixed in [
            [(4, "1,5", true), (5, "1234", false)],
            [(4, "1234", false), (5, "1,5", true)],
            [(4, "1,5", true), (5, "2.5", true)],
        ] {
            let error = seen(&mixed).check().unwrap_err();
            assert_eq!(error.place.column.as_deref(), Some("B"));
        }
    }

    /// Fifty thousand and fifty may be written alike.
    #[test]
    fn commas_that_may_be_those_of_thousands_are_left_as_they_are() {
        let read = |texts: [&str; 2]| {
            let commas = seen(&[(2, texts[0], true), (3, texts[1], true)]);
            let mut text = texts[0].to_owned();
            commas.to_point(1, &mut text);
            text
        };
        assert_eq!(read(["50,725", "-1,250"]), "50,725");
        assert_eq!(read(["50,725", "0,250"]), "50.725");
        assert_eq!(read(["50,725", "1,25"]), "50.725");
    }

    #[test]
    fn columns_have_letters() {
        assert_eq!(
            [0, 25, 26, 701, 702].map(letters),
            ["A", "Z", "AA", "ZZ", "AAA"]
        );
    }
}
