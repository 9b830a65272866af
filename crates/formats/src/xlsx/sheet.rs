//! The rows of a sheet as lines of text with TABs between the cells.

use std::io::{self, BufRead, Read};

use super::book::Book;
use super::booleans::Booleans;
use super::commas::{Commas, letters};
use super::xml::{Part, Xml, attribute, name};
use crate::{Error, Kind};

/// Most columns, those of the text reader.
const MAX_COLUMNS: usize = crate::text::MAX_COLUMNS;

/// Most rows, those that a workbook can have.
const MAX_ROWS: u64 = 1 << 20;

/// A sheet that is read as text.
pub(super) struct Sheet<'b, R> {
    xml: Xml<R>,
    book: &'b Book,
    /// Cells of a row, the missing ones included.
    width: usize,
    /// The columns whose cells are texts with a decimal comma.
    commas: Commas,
    /// The columns of numbers with cells that say TRUE or FALSE.
    booleans: Booleans,
    /// Cells that may still come.
    cells: u64,
    row: u64,
    line: Vec<u8>,
    used: usize,
}

impl<'b, R: BufRead> Sheet<'b, R> {
    /// A sheet whose rows are filled up to this many cells, of which there may be so many.
    pub(super) fn new(reader: R, book: &'b Book, width: usize, cells: u64) -> Self {
        Self {
            xml: Xml::new(reader),
            book,
            width,
            commas: Commas::default(),
            booleans: Booleans::default(),
            cells,
            row: 0,
            line: Vec::new(),
            used: 0,
        }
    }

    /// The same sheet, with points in place of the commas of these columns.
    pub(super) fn with_points(mut self, commas: Commas) -> Self {
        self.commas = commas;
        self
    }

    /// The same sheet, without the cells that say TRUE or FALSE among numbers.
    pub(super) fn without(mut self, booleans: Booleans) -> Self {
        self.booleans = booleans;
        self
    }

    /// The cells of the widest row, the decimal marks of all that are texts, and what is no number among numbers.
    pub(super) fn survey(mut self) -> io::Result<(usize, Commas, Booleans)> {
        let (mut most, mut commas) = (0, Commas::default());
        let mut booleans = Booleans::default();
        while let Some(cells) = self.cells()? {
            most = most.max(cells.len());
            for (column, cell) in cells.iter().enumerate() {
                commas.see(column, self.row, &cell.text, cell.is_text);
                booleans.see(column, self.row, &cell.text, cell.is_boolean);
            }
        }
        Ok((most, commas, booleans))
    }

    /// The cells of the next row, and how many rows without any are before it.
    fn cells(&mut self) -> io::Result<Option<Vec<Said>>> {
        let mut cells: Vec<Said> = Vec::new();
        let mut cell = Cell::default();
        let (mut in_value, mut in_row, mut aloud) = (false, false, false);
        while let Some(part) = self.xml.next()? {
            match part {
                Part::Open(tag, empty) => match name(&tag) {
                    "row" => {
                        let said = attribute(&tag, "r").and_then(|row| row.parse().ok());
                        let row = said.unwrap_or(self.row + 1);
                        if row <= self.row || row > MAX_ROWS {
                            return Err(io::Error::other(format!(
                                "row {row} after row {}",
                                self.row
                            )));
                        }
                        self.row = row;
                        in_row = !empty;
                        if empty {
                            return Ok(Some(cells));
                        }
                    }
                    "c" if in_row => {
                        let at = attribute(&tag, "r").and_then(|place| column(&place));
                        let at = at.unwrap_or(cells.len());
                        if at >= MAX_COLUMNS {
                            return Err(io::Error::other(TooWide {
                                column: at,
                                row: self.row,
                            }));
                        }
                        if at < cells.len() {
                            return Err(io::Error::other(format!(
                                "column {} in row {}",
                                at + 1,
                                self.row
                            )));
                        }
                        let kind = attribute(&tag, "t").unwrap_or_default();
                        let style = attribute(&tag, "s").and_then(|style| style.parse().ok());
                        cell = Cell {
                            at,
                            kind,
                            style,
                            text: String::new(),
                        };
                        if empty {
                            cells.resize(at + 1, Said::default());
                        }
                    }
                    "v" | "t" => in_value = in_row && !empty && !aloud,
                    "rPh" => aloud = !empty,
                    _ => {}
                },
                Part::Text(text) if in_value => cell.text.push_str(&text),
                Part::Text(_) => {}
                Part::Close(tag) => match tag.as_str() {
                    "v" | "t" => in_value = false,
                    "rPh" => aloud = false,
                    "c" if in_row => {
                        cells.resize(cell.at, Said::default());
                        cells.push(Said {
                            text: self.book.text(&cell.kind, cell.style, &cell.text),
                            is_boolean: cell.kind == "b",
                            is_text: matches!(cell.kind.as_str(), "s" | "str" | "inlineStr"),
                        });
                    }
                    "row" => return Ok(Some(cells)),
                    _ => {}
                },
            }
        }
        Ok(None)
    }

    fn fill(&mut self) -> io::Result<()> {
        self.line.clear();
        self.used = 0;
        let before = self.row;
        let Some(mut cells) = self.cells()? else {
            return Ok(());
        };
        // Rows that are not there are lines without cells, so that lines are counted as rows are.
        self.line.resize((self.row - before - 1) as usize, b'\n');
        for (column, cell) in cells.iter_mut().enumerate() {
            if cell.is_text {
                self.commas.to_point(column, &mut cell.text);
            }
            if cell.is_boolean && self.booleans.are_missing(column) {
                cell.text.clear();
            }
        }
        let filled = cells.iter().filter(|cell| !cell.text.is_empty());
        let is_title =
            filled.count() < 2 && cells.iter().all(|cell| cell.text.parse::<f64>().is_err());
        if !is_title {
            cells.resize(self.width.max(cells.len()), Said::default());
        }
        let left = self.cells.checked_sub(cells.len() as u64);
        self.cells = left.ok_or_else(|| io::Error::other("more cells than are allowed"))?;
        for (index, cell) in cells.iter().enumerate() {
            if index > 0 {
                self.line.push(b'\t');
            }
            self.line.extend(cell.text.bytes().map(|byte| match byte {
                b'\t' | b'\n' | b'\r' | 0 => b' ',
                b'"' => b'\'',
                byte => byte,
            }));
        }
        self.line.push(b'\n');
        Ok(())
    }
}

/// A sheet with a cell beyond the last column that is read.
#[derive(Debug)]
pub(super) struct TooWide {
    /// From 0.
    column: usize,
    /// From 1.
    row: u64,
}

impl std::fmt::Display for TooWide {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "row {} goes on to column {}",
            self.row,
            letters(self.column)
        )
    }
}

impl std::error::Error for TooWide {}

impl TooWide {
    /// What is said of the workbook.
    pub(super) fn refusal(&self) -> Error {
        let allowed = format!(
            "at most {MAX_COLUMNS} columns, up to {}, with one sample in each row: where samples stand side by side, turn the table",
            letters(MAX_COLUMNS - 1)
        );
        Error::new(Kind::Limit, self.to_string(), allowed)
    }
}

/// What a cell says, and what it is.
#[derive(Clone, Default)]
struct Said {
    text: String,
    is_text: bool,
    /// TRUE or FALSE.
    is_boolean: bool,
}

#[derive(Default)]
struct Cell {
    at: usize,
    kind: String,
    style: Option<usize>,
    text: String,
}

impl<R: BufRead> Read for Sheet<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.used == self.line.len() {
            self.fill()?;
        }
        let left = &self.line[self.used..];
        let now = left.len().min(buffer.len());
        buffer[..now].copy_from_slice(&left[..now]);
        self.used += now;
        Ok(now)
    }
}

/// The index of the column of a place such as `AB12`.
fn column(place: &str) -> Option<usize> {
    let mut number = 0_usize;
    for letter in place.bytes().take_while(u8::is_ascii_uppercase) {
        number = number
            .checked_mul(26)?
            .checked_add(usize::from(letter - b'A') + 1)?;
    }
    number.checked_sub(1)
}

#[cfg(test)]
mod tests {
    use super::column;

    #[test]
    fn columns() {
        assert_eq!(column("A1"), Some(0));
        assert_eq!(column("Z9"), Some(25));
        assert_eq!(column("AA9"), Some(26));
        assert_eq!(column("9"), None);
    }
}
