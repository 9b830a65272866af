//! Workbooks of Excel (`.xlsx`).
//!
//! Format: ISO/IEC 29500-1. The rows of a sheet are read as the rows of a text table are: titles above, a header or none, units
//! in it or in a row below it, empty cells, columns of text. The first sheet that is shown, else the first hidden one, with a table of two columns of numbers and three rows is
//! taken (of smaller ones the first, where there is nothing else), and the others are named in [`Table::skipped`]. Numbers may
//! be texts, with a decimal point or comma, where a whole column is so. Cells that are shown as dates or times become seconds from the first; of a formula its last result counts.

mod book;
mod booleans;
mod commas;
mod sheet;
mod xml;

use std::fs::File;
use std::io::{self, BufReader};

use book::Book;
use sheet::{Sheet, TooWide};
use zip::ZipArchive;

use crate::binary::guard;
use crate::limits::Budget;
use crate::text::{self, Decimal, Separator, TextOptions};
use crate::{Error, Kind, Limits, Table};

/// Fewest columns of numbers and rows of a table; what is smaller is a title or a list of settings.
const LEAST_TABLE: (usize, usize) = (2, 3);

type Archive = ZipArchive<BufReader<File>>;

/// Whether an archive is a workbook.
pub(crate) fn is_workbook(file: &File) -> bool {
    let file = file.try_clone().ok();
    let archive = file.and_then(|file| ZipArchive::new(BufReader::new(file)).ok());
    archive.is_some_and(|archive| archive.index_for_name("xl/workbook.xml").is_some())
}

/// Reads the first sheet with a table.
pub(crate) fn read(file: File, limits: Limits) -> Result<Table, Error> {
    guard("XLSX", || {
        let mut archive = ZipArchive::new(BufReader::new(file)).map_err(broken)?;
        let mut book = Book::default();
        let sheets = part(&mut archive, "xl/workbook.xml", |reader| {
            book::sheets(reader)
        })?
        .unwrap_or_default();
        part(&mut archive, "xl/sharedStrings.xml", |reader| {
            book.texts(reader)
        })?;
        part(&mut archive, "xl/styles.xml", |reader| book.styles(reader))?;
        let mut first = None;
        let mut found: Option<Table> = None;
        let mut small: Option<(String, Table)> = None;
        let mut skipped = Vec::new();
        for book::Named {
            name,
            id,
            is_hidden,
        } in sheets
        {
            if found.is_some() {
                skipped.push(format!("sheet {name}: not the first with a table"));
                continue;
            }
            match table(&mut archive, &book, &id, limits) {
                Ok(mut table) => {
                    let hidden = if is_hidden { ", which is hidden" } else { "" };
                    table.detected.insert(0, format!("sheet {name}{hidden}"));
                    let (columns, rows) = (table.columns.len(), table.rows());
                    if columns >= LEAST_TABLE.0 && rows >= LEAST_TABLE.1 {
                        found = Some(table);
                    } else {
                        let said =
                            format!("sheet {name}: {columns} columns of numbers in {rows} rows");
                        match small {
                            None => small = Some((said, table)),
                            Some(_) => skipped.push(said),
                        }
                    }
                }
                Err(error) => {
                    skipped.push(format!("sheet {name}: {}", error.found));
                    first.get_or_insert(error.in_sheet(&name));
                }
            }
        }
        let found = match (found, small) {
            (Some(found), Some((said, _))) => {
                skipped.insert(0, said);
                Some(found)
            }
            (found, small) => found.or(small.map(|(_, table)| table)),
        };
        match found {
            Some(mut table) => {
                table.skipped.extend(skipped);
                Ok(table)
            }
            None => Err(first.unwrap_or_else(|| broken("no sheet"))),
        }
    })
}

fn table(archive: &mut Archive, book: &Book, id: &str, limits: Limits) -> Result<Table, Error> {
    let target = part(archive, "xl/_rels/workbook.xml.rels", |reader| {
        book::target(reader, id)
    })?;
    let target = target
        .flatten()
        .ok_or_else(|| broken("a sheet without a file"))?;
    let (width, commas, booleans) = part(archive, &target, |reader| {
        Sheet::new(reader, book, 0, Budget::from(limits).samples()).survey()
    })?
    .ok_or_else(|| broken("a sheet whose file is missing"))?;
    commas.check()?;
    let has_commas = commas.any();
    let missing: Vec<String> = booleans.said().collect();
    let options = TextOptions {
        separator: Some(Separator::Tab),
        decimal: Some(Decimal::Point),
        ..TextOptions::default()
    };
    let member = archive.by_name(&target).map_err(broken)?;
    let sheet = Sheet::new(
        BufReader::new(member),
        book,
        width,
        Budget::from(limits).samples(),
    )
    .with_points(commas)
    .without(booleans);
    let mut table = text::read_sized(sheet, None, &options, limits, &crate::open::everything)?;
    table
        .detected
        .retain(|said| !said.starts_with("separator") && !said.starts_with("decimal"));
    table.skipped.extend(missing);
    if has_commas {
        table
            .detected
            .push("decimal comma in cells that are texts".to_owned());
    }
    Ok(table)
}

/// Reads a member of the archive; `None` where there is none.
fn part<T>(
    archive: &mut Archive,
    name: &str,
    read: impl FnOnce(BufReader<zip::read::ZipFile<'_, BufReader<File>>>) -> io::Result<T>,
) -> Result<Option<T>, Error> {
    match archive.by_name(name) {
        Ok(member) => read(BufReader::new(member)).map(Some).map_err(|error| {
            let wide = error
                .get_ref()
                .and_then(|inner| inner.downcast_ref::<TooWide>());
            match wide {
                Some(wide) => wide.refusal(),
                None => broken(format!("{name}: {error}")),
            }
        }),
        Err(zip::result::ZipError::FileNotFound) => Ok(None),
        Err(error) => Err(broken(error)),
    }
}

fn broken(found: impl std::fmt::Display) -> Error {
    Error::new(
        Kind::Format,
        format!("broken workbook ({found})"),
        "a workbook as Excel, LibreOffice or openpyxl writes it",
    )
}

impl Error {
    /// The same error, in this sheet.
    fn in_sheet(mut self, name: &str) -> Self {
        // How its rows are handed to the text reader is none of its user's business.
        let found = self.found.replace(" with separator TAB, decimal point", "");
        self.found = format!("sheet {name}: {}", found.replace("\\t", " | "));
        self.allowed = self
            .allowed
            .replace(", as stated", "")
            .replace(" (separator TAB)", "");
        self
    }
}
