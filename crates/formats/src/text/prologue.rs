//! The lines above the samples: preamble, header, units.

use super::cell::{self, Cell};
use super::fit::{Fit, Row, Whole};
use super::header::{self, Title};
use super::limits::MAX_COLUMNS;
use super::lines::Line;
use super::options::{Decimal, Separator, TextOptions};
use super::problem;
use super::split::{self, Ends};
use crate::{Error, Kind};

/// What the lines above the samples say.
pub(super) struct Prologue {
    pub titles: Vec<Title>,
    /// Index of the line with the first sample.
    pub first: usize,
    /// Whether there is a header.
    pub named: bool,
    /// For people.
    pub detected: Vec<String>,
    /// A header that names another number of columns, and its line.
    pub misfit: Option<(u64, usize)>,
}

/// Understands the lines above the samples.
pub(super) fn read(
    lines: &[Line],
    fit: &Fit,
    ends: &Ends,
    options: &TextOptions,
) -> Result<Prologue, Error> {
    let mut first = fit.rows.first().map_or(0, |r| r.index);
    let top = options.preamble.unwrap_or(0);
    let above = |first: usize| (top..first).rev().find(|&i| !lines[i].is_blank());
    let mut found = Prologue {
        titles: vec![Title::default(); fit.width],
        first,
        named: false,
        detected: Vec::new(),
        misfit: None,
    };
    if options.header == Some(false) {
        found.say_top(lines, first, "no header");
        return Ok(found);
    }
    if options.header == Some(true) && above(first).is_none() {
        // Names that are numbers: the first line is the header because that is what was stated.
        first += 1;
        found.first = fit.rows.get(1).map_or(first, |r| r.index);
    }
    let Some(last) = above(first) else {
        refuse_counted_row(lines, fit)?;
        found.say_top(lines, first, "no header");
        return Ok(found);
    };
    let cells = |index: usize| {
        let line = &lines[index];
        let line = if line.is_comment() {
            line.without_mark()
        } else {
            *line
        };
        let mut cells = header::texts(&line, ends);
        if cells.len() == fit.width + 1 && cells.last().is_some_and(String::is_empty) {
            cells.pop();
        }
        cells
    };
    if split::fields(lines[last].text, ends, MAX_COLUMNS)
        .last()
        .is_some_and(|f| f.open)
    {
        return Err(problem::open_quote().at_line(lines[last].number));
    }
    let names = cells(last);
    let adjacent = last + 1 == first;
    let before = above(last).filter(|i| i + 1 == last);
    if let Some(before) = before.filter(|_| names.len() == fit.width && header::is_units(&names)) {
        let units = names;
        let names = cells(before);
        if names.len() == fit.width && is_header(&names) {
            let mut titles = header::titles(&names);
            if let Some(column) = header::add_units(&mut titles, &units) {
                let own = header::titles(&names)[column]
                    .unit
                    .clone()
                    .unwrap_or_default();
                return Err(Error::new(
                    Kind::Ambiguous,
                    format!(
                        "unit {} below a name with unit `{own}`",
                        problem::show(units[column].as_bytes())
                    ),
                    "the same unit in both places, or in one of them only",
                )
                .at_line(lines[last].number)
                .in_column(problem::label(&titles[column].name, column)));
            }
            found.say_top(lines, before, "");
            found
                .detected
                .push(format!("header in line {}", lines[before].number));
            found
                .detected
                .push(format!("units in line {}", lines[last].number));
            found.named = true;
            found.titles = titles;
            return Ok(found);
        }
        return found.named_by(lines, last, &units);
    }
    if names.len() == fit.width && (is_header(&names) || options.header == Some(true)) {
        return found.named_by(lines, last, &names);
    }
    if options.header == Some(true) {
        return Err(wrong_header(lines[last].number, names.len(), fit));
    }
    if adjacent && !lines[last].is_comment() && names.len() == fit.width {
        return Err(Error::new(
            Kind::Ambiguous,
            format!(
                "{}, partly names and partly numbers",
                problem::show(lines[last].text.trim_ascii())
            ),
            format!(
                "names only, or numbers, empty cells and NaN only; else one line under [text] of the axis file: header = true if \
                 these are the names, preamble = {} to begin below them",
                lines[last].number
            ),
        )
        .settled_by_line()
        .at_line(lines[last].number));
    }
    if adjacent
        && names.len() > 1
        && fit.separator != Separator::Blanks
        && !lines[last].is_comment()
    {
        found.misfit = Some((lines[last].number, names.len()));
    }
    found.say_top(lines, first, "no header");
    Ok(found)
}

impl Prologue {
    fn named_by(mut self, lines: &[Line], index: usize, names: &[String]) -> Result<Self, Error> {
        self.say_top(lines, index, "");
        self.detected
            .push(format!("header in line {}", lines[index].number));
        self.named = true;
        self.titles = header::titles(names);
        Ok(self)
    }

    fn say_top(&mut self, lines: &[Line], end: usize, more: &str) {
        let count = lines[..end].iter().filter(|l| !l.is_blank()).count();
        if count > 0 {
            self.detected.push(problem::count(count, "preamble line"));
        }
        if !more.is_empty() {
            self.detected.push(more.to_owned());
        }
    }
}

/// The error for a header that names another number of columns than the rows have.
pub(super) fn wrong_header(line: u64, names: usize, fit: &Fit) -> Error {
    let names_text = problem::count(names, "name");
    let found = format!(
        "{names_text}, but the rows below have {}",
        problem::count(fit.width, "cell")
    );
    let error = match fit.separator {
        Separator::Comma if fit.width > names => Error::new(
            Kind::Ambiguous,
            found,
            "one name for each cell; if the comma is the decimal mark too, export with `;` or TAB \
             between the cells",
        ),
        separator => Error::new(
            Kind::Format,
            found,
            format!(
                "one name for each cell (separator {separator}), or header = false under [text] of the axis file"
            ),
        )
        .settled_by_line(),
    };
    error.at_line(line)
}

/// Whether these cells are names: text, and no numbers.
fn is_header(cells: &[String]) -> bool {
    let kinds = || cells.iter().map(|c| cell::classify(c.as_bytes()));
    kinds().any(|c| c == Cell::Text) && !kinds().any(Cell::is_sample)
}

/// A first row `0, 1, 2` may be the column numbers that some programs write instead of names.
fn refuse_counted_row(lines: &[Line], fit: &Fit) -> Result<(), Error> {
    let Some(first) = fit
        .rows
        .first()
        .filter(|_| fit.width > 2 && fit.rows.len() > 1)
    else {
        return Ok(());
    };
    let counts_from =
        |start: f64| {
            first.cells.iter().take(fit.width).zip(0..).all(
                |(cell, n)| matches!(cell, Cell::Number(v, None) if *v == start + f64::from(n)),
            )
        };
    if !counts_from(0.0) && !counts_from(1.0) {
        return Ok(());
    }
    let line = &lines[first.index];
    Err(Error::new(
        Kind::Ambiguous,
        format!(
            "{}, which may be column numbers or a sample",
            problem::show(line.text.trim_ascii())
        ),
        "header = true (column numbers) or header = false (a sample) under [text] of the axis file",
    )
    .settled_by_line()
    .at_line(line.number))
}

/// Refuses rows that could as well be numbers with a decimal comma.
pub(super) fn refuse_comma_twice(
    lines: &[Line],
    fit: &Fit,
    ends: &Ends,
    named: bool,
    mark: Option<Decimal>,
) -> Result<(), Error> {
    if fit.separator != Separator::Comma || named || mark == Some(Decimal::Comma) {
        return Ok(());
    }
    let Some(first) = fit.rows.first() else {
        return Ok(());
    };
    let all = |test: &dyn Fn(&Row) -> bool| fit.rows.iter().all(test);
    let halves = all(&|r| {
        let mut cells = r.cells.iter().zip(&r.whole);
        cells.all(|(cell, whole)| !matches!(cell, Cell::Number(..)) || *whole != Whole::No)
    });
    let before = |c: usize| all(&|r| matches!(r.whole.get(c), Some(Whole::Digits | Whole::Before)));
    let after = |c: usize| all(&|r| matches!(r.whole.get(c), Some(Whole::Digits | Whole::After)));
    let time = |c: usize| all(&|r| r.cells.get(c).is_some_and(|cell| cell.is_whole_second()));
    let pair = (1..fit.width).find(|&c| after(c) && ((halves && before(c - 1)) || time(c - 1)));
    let Some(column) = pair else { return Ok(()) };
    let line = &lines[first.index];
    let cells = split::fields(line.text, ends, column + 1);
    let [.., before, after] = &cells[..] else {
        return Ok(());
    };
    let both = [&before.text[..], b",", &after.text[..]].concat();
    let (before, after) = (problem::show(&before.text), problem::show(&after.text));
    Err(Error::new(
        Kind::Ambiguous,
        format!(
            "{} is either two cells, {before} and {after}, or one with a decimal comma",
            problem::show(&both)
        ),
        format!(
            "a header, an export with `;` or TAB between the cells, or one line under [text] of the axis file: \
             separator = \"comma\" if these are two cells{}",
            match fit.width {
                2 => ", decimal = \"comma\" if they are one",
                _ => "",
            }
        ),
    )
    .settled_by_line()
    .at_line(line.number)
    .in_column(column.to_string()))
}
