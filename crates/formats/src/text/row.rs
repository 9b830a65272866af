//! Blocks of rows turned into columns of numbers, by a rule that is settled.

use super::cell::{self, Cell};
use super::halsampler;
use super::limits::MAX_ROW_BYTES;
use super::local::{Dates, Wrong};
use super::options::Decimal;
use super::problem;
use super::split::{self, Ends, Field};
use crate::{Error, Passed};

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Role {
    /// Only empty cells so far.
    Unknown,
    /// Numbers.
    Number,
    /// Text, which is passed over.
    Text,
    /// Moments, as seconds from this one (nanoseconds).
    Moment { base: i64, dated: bool },
    /// Dates with time as they are written from place to place, as seconds from the first.
    Local(Dates),
    /// Counts of 100 ns since 1601, as seconds from this one.
    FileTime { base: i64 },
    /// Lists of so many numbers, whose samples are kept from the place `first` on, behind those of all cells.
    List { first: usize, length: usize },
}

impl Role {
    /// How many columns of the table it makes.
    pub(super) fn columns(self) -> usize {
        match self {
            Role::List { length, .. } => length,
            _ => 1,
        }
    }
}

/// What rows have shown so far and the rows after them must keep to.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct State {
    pub roles: Vec<Role>,
    /// `None` until a number shows a mark.
    pub decimal: Option<Decimal>,
    /// Cells in a row.
    pub width: usize,
}

/// How rows are written; does not change within a file.
#[derive(Clone, Debug)]
pub(super) struct Rule {
    pub ends: Ends,
    /// Whether rows may end in a separator.
    pub trailing: bool,
    /// Whether columns at the end of a row may run out, once and for all.
    pub run_out: bool,
    /// Whether a line `overrun` is the mark of halsampler for samples that are missing.
    pub overruns: bool,
    /// Of which columns the samples are kept, one for each cell and then those of lists; the cells of others are read and checked
    /// all the same.
    pub keep: Vec<bool>,
}

/// A line of the file and the words on it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Seen {
    pub line: u64,
    pub text: String,
}

/// What a block of rows holds; lines count from 0 at its start.
#[derive(Debug)]
pub(super) struct Block {
    pub columns: Vec<Vec<f64>>,
    /// What was seen of columns that are not kept; one for each column.
    pub passed: Vec<Passed>,
    pub rows: usize,
    pub lines: u64,
    pub state: State,
    /// Where the decimal mark first showed.
    pub decimal: Option<Seen>,
    /// Columns that turned out to be text in this block, and where.
    pub texts: Vec<(usize, Seen)>,
    pub comments: usize,
    /// Before which rows of the block samples are missing, each row once.
    pub overruns: Vec<usize>,
    /// Blank lines, and those of them after the last row.
    pub blank: usize,
    pub blank_end: usize,
    pub stop: Option<Stop>,
}

/// A row that cannot be read.
#[derive(Debug)]
pub(super) struct Stop {
    pub line: u64,
    /// Where the row starts in the block.
    pub at: usize,
    /// The column, from 0.
    pub column: Option<usize>,
    pub error: Error,
}

/// Reads all rows of a block, or those before the first that cannot be read.
pub(super) fn parse(text: &[u8], rule: &Rule, state: &State, seen: Option<&str>) -> Block {
    let columns = vec![Vec::new(); rule.keep.len()];
    let block = Block {
        columns,
        passed: vec![Passed::default(); rule.keep.len()],
        rows: 0,
        lines: 0,
        state: state.clone(),
        decimal: None,
        texts: Vec::new(),
        comments: 0,
        overruns: Vec::new(),
        blank: 0,
        blank_end: 0,
        stop: None,
    };
    let mut parser = Parser {
        text,
        rule,
        seen,
        before: state,
        block,
        cell: 0,
    };
    parser.run();
    parser.block
}

struct Parser<'a> {
    text: &'a [u8],
    rule: &'a Rule,
    /// Where the decimal mark was seen before this block, for messages.
    seen: Option<&'a str>,
    /// What the rows before this block have shown.
    before: &'a State,
    block: Block,
    /// The cell being read, for messages.
    cell: usize,
}

impl Parser<'_> {
    fn run(&mut self) {
        let mut at = 0;
        while at < self.text.len() {
            let next = if self.is_blank(at) {
                self.block.blank += 1;
                self.block.blank_end += 1;
                self.rule.ends.next_row(self.text, at)
            } else if split::is_comment(&self.text[at..]) {
                self.block.comments += 1;
                self.rule.ends.next_row(self.text, at)
            } else if self.rule.overruns && halsampler::is_overrun(&self.text[at..]) {
                let rows = self.block.rows;
                if self.block.overruns.last() != Some(&rows) {
                    self.block.overruns.push(rows);
                }
                self.rule.ends.next_row(self.text, at)
            } else {
                match self.row(at) {
                    Ok(next) => {
                        self.block.rows += 1;
                        self.block.blank_end = 0;
                        next
                    }
                    Err((error, in_cell)) => {
                        self.forget_row(at);
                        let long = self.rule.ends.next_row(self.text, at) - at > MAX_ROW_BYTES;
                        let error = if long { problem::long_row() } else { error };
                        let column = (in_cell && !long).then_some(self.cell);
                        let line = self.block.lines;
                        self.block.stop = Some(Stop {
                            line,
                            at,
                            column,
                            error,
                        });
                        return;
                    }
                }
            };
            self.block.lines += 1;
            at = next;
        }
    }

    /// Undoes what the cells before one that cannot be read have left.
    fn forget_row(&mut self, at: usize) {
        for column in &mut self.block.columns {
            column.truncate(self.block.rows);
        }
        if self.rule.keep.contains(&false) && self.block.rows > 0 {
            let before = parse(&self.text[..at], self.rule, self.before, self.seen);
            self.block.passed = before.passed;
        } else {
            self.block.passed.fill(Passed::default());
        }
    }

    /// Whether a line holds nothing at all; a row of separators is a row of missing values.
    #[inline]
    fn is_blank(&self, at: usize) -> bool {
        // Most rows start with a digit or a sign.
        if self.text[at] > b' ' {
            return false;
        }
        let at = self.rule.ends.skip_blanks(self.text, at);
        self.text.get(at).is_none_or(|&b| b == self.rule.ends.row)
    }

    /// Reads one row and gives the start of the next; an error says whether it is about a cell.
    fn row(&mut self, start: usize) -> Result<usize, (Error, bool)> {
        let rule = self.rule;
        let width = self.block.state.width;
        let mut at = start;
        self.cell = 0;
        let next = loop {
            if self.cell == width {
                if let Some(next) = self.trailing(at) {
                    break next;
                }
                return Err((self.wrong_count(start), false));
            }
            at = self.cell(at).map_err(|e| (e, true))?;
            self.cell += 1;
            at = rule.ends.skip_blanks(self.text, at);
            match self.text.get(at) {
                None => break at,
                Some(&b) if b == rule.ends.row => break at + 1,
                Some(&b) if Some(b) == rule.ends.byte => at += 1,
                // Separated by blanks: this is the start of the next cell.
                Some(_) => {}
            }
        };
        if next - start > MAX_ROW_BYTES {
            return Err((problem::long_row(), false));
        }
        if self.cell < width {
            if !rule.run_out {
                return Err((self.wrong_count(start), false));
            }
            self.block.state.width = self.cell;
        }
        Ok(next)
    }

    /// After the last cell and a separator: the start of the next row if nothing else follows.
    fn trailing(&self, at: usize) -> Option<usize> {
        let end = self.rule.ends.skip_blanks(self.text, at);
        match self.text.get(end) {
            _ if !self.rule.trailing => None,
            None => Some(end),
            Some(&b) => (b == self.rule.ends.row).then_some(end + 1),
        }
    }

    fn wrong_count(&self, start: usize) -> Error {
        let state = &self.block.state;
        let row = &self.text[start..];
        let found = split::fields(row, &self.rule.ends, usize::MAX).len();
        let end = memchr::memchr(self.rule.ends.row, row);
        let line = row[..end.unwrap_or(row.len())].trim_ascii_end();
        let separator = self.rule.ends.separator;
        problem::wrong_count(
            line,
            found,
            state.width,
            separator,
            state.decimal,
            end.is_none(),
        )
    }

    /// Reads the cell at `at` into its column and gives the place where it ends.
    #[inline]
    fn cell(&mut self, at: usize) -> Result<usize, Error> {
        if self.block.state.roles[self.cell] == Role::Number
            && let Some((value, end)) = self.plain_number(at)
        {
            self.put(self.cell, value);
            return Ok(end);
        }
        self.any_cell(at)
    }

    #[inline]
    fn put(&mut self, column: usize, value: f64) {
        if self.rule.keep[column] {
            self.block.columns[column].push(value);
        } else {
            self.block.passed[column].see(value);
        }
    }

    /// The fast path: a bare number in a column of numbers.
    #[inline]
    fn plain_number(&self, at: usize) -> Option<(f64, usize)> {
        let ends = &self.rule.ends;
        let start = ends.skip_blanks(self.text, at);
        let rest = &self.text[start..];
        let (value, length) = match self.block.state.decimal {
            Some(Decimal::Point) => fast_float2::parse_partial(rest).ok()?,
            Some(Decimal::Comma) => {
                let mut copy = [0_u8; 32];
                let near = &rest[..rest.len().min(copy.len())];
                let length = near
                    .iter()
                    .position(|&b| ends.is_end(b))
                    .unwrap_or(near.len());
                cell::with_point(&rest[..length], copy.get_mut(..length)?)?;
                (fast_float2::parse(&copy[..length]).ok()?, length)
            }
            None => {
                let (value, length) = fast_float2::parse_partial(rest).ok()?;
                if rest[..length].contains(&b'.') {
                    return None;
                }
                (value, length)
            }
        };
        let end = start + length;
        match self.text.get(end) {
            Some(&b) if !ends.is_end(b) => {
                let end = ends.skip_blanks(self.text, end);
                let clear = self.text.get(end).is_none_or(|&b| ends.is_end(b));
                (clear && ends.byte.is_some()).then_some((value, end))
            }
            _ => Some((value, end)),
        }
    }

    /// The careful path: quotes, missing values, words, moments, the first decimal mark.
    #[inline(never)]
    fn any_cell(&mut self, at: usize) -> Result<usize, Error> {
        let found = split::field(self.text, at, &self.rule.ends);
        if found.open {
            return Err(problem::open_quote());
        }
        if found.quoted {
            let inside = &self.text[at..found.end];
            self.block.lines += memchr::memchr_iter(self.rule.ends.row, inside).count() as u64;
        }
        let column = self.cell;
        let value = match self.block.state.roles[column] {
            Role::Text => return Ok(found.end),
            Role::List { first, length } => {
                self.list(&found.text, first, length)?;
                return Ok(found.end);
            }
            Role::Unknown | Role::Number => self.number(&found)?,
            Role::Moment { base, dated } => match cell::classify(&found.text) {
                Cell::Moment(m) if m.dated == dated => {
                    Some((m.ns.saturating_sub(base)) as f64 / 1e9)
                }
                cell if cell.is_void() => Some(f64::NAN),
                _ => return Err(problem::wrong_moment(&found.text, dated)),
            },
            Role::Local(mut dates) => match cell::classify(&found.text) {
                Cell::Local(date) => {
                    let seconds = dates
                        .seconds(date)
                        .map_err(|unclear| problem::wrong_date(&found.text, dates, unclear))?;
                    self.block.state.roles[column] = Role::Local(dates);
                    Some(seconds)
                }
                cell if cell.is_void() => Some(f64::NAN),
                _ => return Err(problem::wrong_date(&found.text, dates, Wrong::NoDate)),
            },
            Role::FileTime { base } => match file_time(&found.text) {
                Some(count) => Some((count.saturating_sub(base)) as f64 / 1e7),
                None if cell::classify(&found.text).is_void() => Some(f64::NAN),
                None => return Err(problem::wrong_cell(&found.text, None, None)),
            },
        };
        if let Some(value) = value {
            self.put(column, value);
        }
        Ok(found.end)
    }

    /// A cell in a column of lists of this length; one without any is missing in all of its columns.
    fn list(&mut self, cell: &[u8], first: usize, length: usize) -> Result<(), Error> {
        if cell::classify(cell).is_void() || cell::is_empty_list(cell) {
            (first..first + length).for_each(|column| self.put(column, f64::NAN));
            return Ok(());
        }
        let mut count = 0;
        for element in cell::elements(cell).into_iter().flatten() {
            match element {
                Some(value) if count < length => self.put(first + count, value),
                Some(_) => {}
                None => return Err(problem::wrong_list(cell, length, None)),
            }
            count += 1;
        }
        match count == length {
            true => Ok(()),
            false => Err(problem::wrong_list(cell, length, Some(count))),
        }
    }

    /// A cell in a column of numbers, or in one that has been empty so far.
    fn number(&mut self, found: &Field<'_>) -> Result<Option<f64>, Error> {
        let column = self.cell;
        let state = &mut self.block.state;
        match cell::classify(&found.text) {
            cell if cell.is_void() => Ok(Some(f64::NAN)),
            Cell::Number(value, mark)
                if mark.is_none() || state.decimal.is_none() || mark == state.decimal =>
            {
                state.roles[column] = Role::Number;
                if state.decimal.is_none() && mark.is_some() {
                    state.decimal = mark;
                    let text = problem::show(&found.text);
                    self.block.decimal = Some(Seen {
                        line: self.block.lines,
                        text,
                    });
                }
                Ok(Some(value))
            }
            // A number with the other decimal mark does not make a column text.
            cell if state.roles[column] == Role::Unknown && !matches!(cell, Cell::Number(..)) => {
                state.roles[column] = Role::Text;
                let text = problem::text_cell(&found.text);
                self.block.texts.push((
                    column,
                    Seen {
                        line: self.block.lines,
                        text,
                    },
                ));
                Ok(None)
            }
            _ => {
                let here = self.block.decimal.as_ref().map(|seen| seen.text.as_str());
                Err(problem::wrong_cell(
                    &found.text,
                    state.decimal,
                    here.or(self.seen),
                ))
            }
        }
    }
}

/// A FILETIME: 100 ns since 1601, as TwinCAT writes full time stamps.
pub(super) fn file_time(cell: &[u8]) -> Option<i64> {
    std::str::from_utf8(cell.trim_ascii()).ok()?.parse().ok()
}
