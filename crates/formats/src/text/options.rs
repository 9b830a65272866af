//! What a user may state about a text file; whatever is left out is detected.

use crate::{Error, Kind};
use std::fmt;

/// The separator between two cells of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Separator {
    /// One TAB.
    Tab,
    /// `;`
    Semicolon,
    /// `,`
    Comma,
    /// `|`
    Pipe,
    /// `:`, detected in TwinCAT exports only.
    Colon,
    /// Any run of blanks and TABs; those at the ends of a row do not count.
    Blanks,
}

impl Separator {
    /// The separating byte, where it is a single one.
    pub(super) fn byte(self) -> Option<u8> {
        match self {
            Separator::Tab => Some(b'\t'),
            Separator::Semicolon => Some(b';'),
            Separator::Comma => Some(b','),
            Separator::Pipe => Some(b'|'),
            Separator::Colon => Some(b':'),
            Separator::Blanks => None,
        }
    }
}

impl fmt::Display for Separator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Separator::Tab => "TAB",
            Separator::Semicolon => "`;`",
            Separator::Comma => "`,`",
            Separator::Pipe => "`|`",
            Separator::Colon => "`:`",
            Separator::Blanks => "blanks",
        })
    }
}

/// The decimal mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decimal {
    /// `1.5`
    Point,
    /// `1,5`
    Comma,
}

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Decimal::Point => "point",
            Decimal::Comma => "comma",
        })
    }
}

/// How a text file is written, as far as the user states it; `None` is detected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TextOptions {
    /// The separator between two cells.
    pub separator: Option<Separator>,
    /// The decimal mark of every number.
    pub decimal: Option<Decimal>,
    /// Whether the line above the first sample names the columns.
    pub header: Option<bool>,
    /// Lines to leave out at the top of the file, 0 to 1000; the line after them is the header or
    /// the first sample.
    pub preamble: Option<usize>,
}

impl TextOptions {
    /// Refuses what contradicts itself.
    pub(super) fn check(&self) -> Result<(), Error> {
        if self.separator == Some(Separator::Comma) && self.decimal == Some(Decimal::Comma) {
            return Err(Error::new(
                Kind::Value,
                "the comma is stated both as separator and as decimal mark",
                "only one of the two can be a comma",
            )
            .of_setting("text.decimal"));
        }
        if self
            .preamble
            .is_some_and(|n| n > super::limits::MAX_PREAMBLE_LINES)
        {
            return Err(Error::new(
                Kind::Value,
                format!("{} preamble lines are stated", self.preamble.unwrap_or(0)),
                format!("at most {}", super::limits::MAX_PREAMBLE_LINES),
            )
            .of_setting("text.preamble"));
        }
        Ok(())
    }
}
