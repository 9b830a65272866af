//! Text recordings: CSV, TSV, semicolon and blank-separated tables in the dialects drives, PLCs and
//! spreadsheets write, and TwinCAT Scope exports.
//!
//! The reader looks at the head of the file, decides how it is written, says so in
//! [`Table::detected`], and then reads the rest by exactly that rule. A file that can be read in two
//! ways (`1,234`: two columns or one number?) is refused with [`Kind::Ambiguous`](crate::Kind), never
//! guessed; [`TextOptions`] settles it.
//!
//! What is understood:
//!
//! - separator TAB, `;`, `,`, `|`, or runs of blanks (`:` in TwinCAT exports); LF, CRLF or CR;
//! - decimal point or decimal comma, one of them throughout. Digits are never grouped: `1.234,5` is
//!   refused, not read as 1234.5;
//! - preamble lines of free text or comments (`#`, `%`, `//`, `;`), a header or none, units in the
//!   header as `Position [mm]` or `Position (mm)` (round brackets only around a known unit, so that
//!   `q (1)` stays a name; `pos_mm` and `pos/mm` stay names), or in a row of their own below it;
//! - UTF-8 or UTF-16 with byte order mark, UTF-8 without, ISO-8859-1 names;
//! - empty cells and the usual marks for a missing value (NaN), infinities, `TRUE`/`FALSE` (1/0);
//! - ISO date-times, times of day, and dates with time as `26.11.2024 12:00:00.123`, `11/26/2024 12:00:00 PM` or
//!   `26-Nov-2024 12:00:00`, read as seconds from the first sample; where day and month may be either, a log of one day
//!   needs no order, and another one shows it by a number above 12 or by the day that follows;
//! - text columns, which are skipped and named in [`Table::skipped`];
//! - comment lines between rows, and text such as `EOF` after the last row;
//! - lines `overrun` of LinuxCNC's halsampler: by the sample numbers of `halsampler -t` the samples that it
//!   lost become missing values in rows of their own.
//!
//! Numbers are correctly rounded: what Python, NumPy or pandas wrote comes back bit for bit.
//!
//! Limits, past which a file is refused with [`Kind::Limit`](crate::Kind): 4096 columns, 1 MiB in one
//! row, 1000 lines before the first row of numbers, and the memory that [`Limits`] allow. Beyond a fixed
//! 20 MB or so, memory stays below three times the samples' size: the text passes through in blocks
//! and is never held as a whole.
//!
//! ```
//! use stiction_formats::text::{TextOptions, read};
//!
//! let log = "Recorded on axis 3\nTime [ms];Torque [Nm]\n0;0,25\n1;-0,5\n";
//! let table = read(log.as_bytes(), &TextOptions::default()).unwrap();
//! assert_eq!(table.columns[1].name, "Torque");
//! assert_eq!(table.columns[1].unit.as_deref(), Some("Nm"));
//! assert_eq!(table.columns[1].values, [0.25, -0.5]);
//! assert!(table.detected.iter().any(|d| d == "decimal comma"));
//! ```

mod body;
mod cell;
mod choose;
mod clock;
mod column;
mod fit;
mod halsampler;
mod header;
mod limits;
mod lines;
mod local;
mod options;
mod problem;
mod prologue;
mod row;
mod scope;
mod source;
mod split;
mod twincat;
pub(crate) mod unit;
mod utf16;

#[cfg(any(feature = "json", feature = "xlsx"))]
pub(crate) use cell::{Cell, classify};
#[cfg(any(feature = "json", feature = "mcap"))]
pub(crate) use clock::Moment;
#[cfg(any(feature = "json", feature = "mcap"))]
pub(crate) use column::unwrap_midnight;
pub use limits::{MAX_COLUMNS, MAX_PREAMBLE_LINES, MAX_ROW_BYTES};
pub use options::{Decimal, Separator, TextOptions};
#[cfg(feature = "svb")]
pub(crate) use scope::{Group, Scope};

use crate::limits::Budget;
use crate::open::{Wanted, everything};
use crate::{Error, Kind, Limits, Table};
use source::Source;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Reads a text recording from any source of bytes.
///
/// # Errors
///
/// [`Error`] with the row (as an editor counts lines), the column, what was found and what is
/// allowed.
pub fn read(source: impl Read, options: &TextOptions) -> Result<Table, Error> {
    read_sized(source, None, options, Limits::default(), &everything)
}

/// Reads a text recording from a file; like [`read`], and the errors name the file.
///
/// # Errors
///
/// As [`read`]; [`Kind::Io`] where the file cannot be opened or read.
pub fn read_file(path: &Path, options: &TextOptions) -> Result<Table, Error> {
    let open = || {
        let file = File::open(path).map_err(|e| problem::io(&e))?;
        let size = file.metadata().ok().map(|m| m.len());
        read_sized(file, size, options, Limits::default(), &everything)
    };
    open().map_err(|e| e.in_file(path))
}

/// Reads a text of this many bytes, where that is known.
pub(crate) fn read_sized(
    reader: impl Read,
    size: Option<u64>,
    options: &TextOptions,
    limits: Limits,
    wanted: Wanted,
) -> Result<Table, Error> {
    options.check()?;
    let mut source = Source::open(reader, size)?;
    let mut layout = choose::layout(&source, options)?;
    layout.keep_only(wanted);
    let encoding = source.encoding(layout.offset);
    layout.detected.splice(..0, encoding.map(str::to_owned));
    let budget = Budget::from(limits);
    let mut body = body::read(&mut source, &layout, budget)?;
    let lost = halsampler::restore(&mut body, budget)?;
    layout.detected.extend(lost);
    let table = column::finish(layout, body);
    if table.columns.is_empty() {
        return Err(Error::new(
            Kind::Format,
            "no column holds numbers",
            "a recording needs at least one numeric column",
        ));
    }
    Ok(table)
}
