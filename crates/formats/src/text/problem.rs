//! Error messages for text files.

use super::cell::{self, Cell};
use super::local::{Dates, Wrong};
use super::options::{Decimal, Separator};
use crate::{Error, Kind};
use std::io;

/// Longest piece of a file that a message shows, in characters.
const MAX_SHOWN_CHARS: usize = 40;

/// A piece of the file in a message: short, one line, control characters escaped.
pub(super) fn show(text: &[u8]) -> String {
    let text = decode(&text[..text.len().min(8 * MAX_SHOWN_CHARS)]);
    let mut shown: String = text
        .chars()
        .take(MAX_SHOWN_CHARS)
        .flat_map(char::escape_debug)
        .collect();
    shown = shown.replace("\\\"", "\"").replace("\\'", "'");
    if text.chars().count() > MAX_SHOWN_CHARS {
        shown.push('…');
    }
    format!("`{shown}`")
}

/// The first few items of a list, and how many more there are.
pub(super) fn list(things: &[String]) -> String {
    /// Items that a message names: a line of a terminal.
    const MAX_LISTED: usize = 8;
    let mut text = things[..things.len().min(MAX_LISTED)].join(", ");
    if things.len() > MAX_LISTED {
        text += &format!(" and {} more", things.len() - MAX_LISTED);
    }
    text
}

/// The name of a column (from 0) in a message, or its number from 1 where it has none.
pub(super) fn label(name: &str, column: usize) -> String {
    if name.is_empty() {
        return (column + 1).to_string();
    }
    show(name.as_bytes()).trim_matches('`').to_owned()
}

/// A name from the file; control characters, which no name needs, do not reach a terminal.
pub(super) fn name(text: &[u8]) -> String {
    let clean = |c: char| match c {
        c if c.is_control() && c.is_whitespace() => ' ',
        c if c.is_control() => char::REPLACEMENT_CHARACTER,
        c => c,
    };
    decode(text).chars().map(clean).collect()
}

/// Text as UTF-8, or as ISO-8859-1 where it is not.
pub(super) fn decode(text: &[u8]) -> String {
    match std::str::from_utf8(text) {
        Ok(text) => text.to_owned(),
        // A character that is cut off at the end does not make it another encoding.
        Err(e) if e.error_len().is_none() && e.valid_up_to() > 0 => String::from_utf8_lossy(text)
            .trim_end_matches('\u{FFFD}')
            .to_owned(),
        Err(_) => text.iter().map(|&b| char::from(b)).collect(),
    }
}

pub(super) fn io(error: &io::Error) -> Error {
    Error::new(Kind::Io, error.to_string(), "")
}

/// `1 cell`, `2 cells`.
pub(super) fn count(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

fn cells(number: usize) -> String {
    count(number, "cell")
}

pub(super) fn wrong_count(
    row: &[u8],
    found: usize,
    width: usize,
    separator: Separator,
    decimal: Option<Decimal>,
    at_end: bool,
) -> Error {
    let found_text = format!("{} {}", cells(found), show(row));
    let width_text = cells(width);
    if separator == Separator::Comma && decimal.is_none() && found > width {
        return Error::new(
            Kind::Ambiguous,
            found_text,
            format!(
                "{width_text} as in the rows before; if the comma is the decimal mark too, export with \
                 `;` or TAB between the cells"
            ),
        );
    }
    let cut = if at_end && found < width {
        "; the file may be cut off here"
    } else {
        ""
    };
    let allowed = format!("{width_text} as in the rows before (separator {separator}){cut}");
    Error::new(Kind::Format, found_text, allowed)
}

/// A cell in a numeric column that is not a number there.
pub(super) fn wrong_cell(text: &[u8], decimal: Option<Decimal>, seen: Option<&str>) -> Error {
    let other = match cell::classify(text) {
        Cell::Number(_, mark) => mark,
        _ => None,
    };
    match (decimal, other) {
        (Some(decimal), Some(other)) if decimal != other => {
            let because = seen.map_or("as stated".to_owned(), |s| format!("as in {s}"));
            Error::new(
                Kind::Ambiguous,
                format!("{} with decimal {other}", show(text)),
                format!(
                    "numbers with decimal {decimal}, {because}; the same mark throughout the file"
                ),
            )
        }
        _ => {
            let hint = match grouped(text) {
                true => "; digits must not be grouped",
                false => "",
            };
            let mark = decimal.map_or(String::new(), |d| format!(" with decimal {d}"));
            Error::new(
                Kind::Format,
                show(text),
                format!("a number{mark}, an empty cell or NaN{hint}"),
            )
        }
    }
}

/// A cell of a column that is text, and what of it may be mended.
pub(super) fn text_cell(text: &[u8]) -> String {
    match grouped(text) {
        true => format!("{} (digits must not be grouped)", show(text)),
        false => show(text),
    }
}

/// Whether a text looks like a number whose digits are grouped (`1.234,5`, `1,234,567`, `1'234`).
fn grouped(text: &[u8]) -> bool {
    text.iter()
        .all(|b| b.is_ascii_digit() || b"+-.,' ".contains(b))
        && text.iter().filter(|b| b.is_ascii_digit()).count() > 3
        && text.iter().any(|b| b",.' ".contains(b))
        && text
            .first()
            .is_some_and(|b| b.is_ascii_digit() || b"+-".contains(b))
}

pub(super) fn wrong_moment(text: &[u8], dated: bool) -> Error {
    let allowed = match dated {
        true => "a date with time such as 2024-05-01T12:00:00.001, as in the rows before",
        false => "a time of day such as 12:00:00.001, as in the rows before",
    };
    Error::new(Kind::Format, show(text), allowed)
}

/// A cell of a column of lists, with another number of elements where that is what is wrong.
pub(super) fn wrong_list(text: &[u8], length: usize, count: Option<usize>) -> Error {
    let found = match count {
        Some(0) | None => show(text),
        Some(count) => format!("{}, a list of {count}", show(text)),
    };
    let allowed = format!("a list of {length} numbers such as [0.5, -1] in every row, or nothing");
    Error::new(Kind::Format, found, allowed)
}

/// A date whose order the dates before it do not allow, or leave open.
pub(super) fn wrong_date(text: &[u8], dates: Dates, wrong: Wrong) -> Error {
    let first = dates.first();
    match wrong {
        Wrong::NoDate => Error::new(
            Kind::Format,
            show(text),
            format!("a date with time as in the rows before, {}", dates.said()),
        ),
        Wrong::Unclear => Error::new(
            Kind::Ambiguous,
            format!(
                "{} after {first}: day and month in unknown order, so the time between the two is unknown",
                show(text)
            ),
            "dates as 2024-05-01 12:00:00.001, times of day alone, or a log that does not go on after a pause of days",
        ),
    }
}

pub(super) fn long_row() -> Error {
    Error::new(
        Kind::Limit,
        format!("a row of more than {} bytes", super::limits::MAX_ROW_BYTES),
        "shorter rows; is this a text table with one sample in each row?",
    )
}

pub(super) fn open_quote() -> Error {
    Error::new(
        Kind::Format,
        "a quote `\"` that is never closed",
        "a closing quote `\"`",
    )
}

pub(super) fn too_many_columns(width: usize) -> Error {
    let width = if width > super::limits::MAX_COLUMNS {
        format!("more than {}", super::limits::MAX_COLUMNS)
    } else {
        width.to_string()
    };
    Error::new(
        Kind::Limit,
        format!("{width} columns"),
        format!(
            "at most {} columns; is there one sample in each row?",
            super::limits::MAX_COLUMNS
        ),
    )
}
