//! How a file is written, decided from its head.

use super::cell::{self, Cell};
use super::fit::{Fit, Row};
use super::header::Title;
use super::limits::{MAX_COLUMNS, MAX_PREAMBLE_LINES};
use super::lines::{self, Line};
use super::options::{Decimal, Separator, TextOptions};
use super::problem;
use super::prologue;
use super::row::{Role, Rule, Seen, State};
use super::scope::Scope;
use super::source::Source;
use super::split::{self, Ends};
use super::twincat;
use crate::open::Wanted;
use crate::{Column, Error, Kind, Table};

/// Lines of samples from which the dialect is decided.
const SAMPLE_LINES: usize = 256;
/// Bytes of the head from which the separator is decided.
const SAMPLE_BYTES: usize = 1 << 20;

/// How a file is written.
pub(super) struct Layout {
    pub rule: Rule,
    /// The rule at the first row.
    pub state: State,
    pub titles: Vec<Title>,
    /// Where the first row starts in the head, and its line.
    pub offset: usize,
    pub line: u64,
    /// Where the decimal mark showed.
    pub decimal: Option<Seen>,
    /// For each text column, its first cell.
    pub texts: Vec<Option<Seen>>,
    pub detected: Vec<String>,
    /// What a TwinCAT export says beyond names and units.
    pub scope: Option<Scope>,
}

impl Layout {
    /// A column in messages: its name, or its number from 1.
    pub(super) fn label(&self, column: usize) -> String {
        problem::label(self.titles.get(column).map_or("", |t| &t.name), column)
    }
}

impl Layout {
    /// Keeps the samples of those columns alone that are asked for, and of those that tell something of the others.
    pub(super) fn keep_only(&mut self, wanted: Wanted) {
        // Channels of a scope share time stamps, and which ones only the samples tell.
        if self.scope.is_some() {
            return;
        }
        let titles = self.titles.iter().zip(&self.state.roles);
        let heads = titles.flat_map(|(title, role)| {
            title.each(*role).map(|name| Column {
                name,
                unit: title.unit.clone(),
                ..Column::default()
            })
        });
        let heads = Table {
            columns: heads.collect(),
            ..Table::default()
        };
        let mut wanted = wanted(&heads).into_iter();
        let mut next = || wanted.next().unwrap_or(true);
        for (column, role) in self.state.roles.iter().enumerate() {
            if let Role::List { first, length } = *role {
                self.rule.keep[first..first + length].fill_with(&mut next);
                continue;
            }
            // Times of day run on over midnight; halsampler numbers its samples.
            let stamps = matches!(
                role,
                Role::Moment { .. } | Role::Local(_) | Role::FileTime { .. }
            );
            let numbers = column == 0 && self.rule.overruns;
            self.rule.keep[column] = next() || stamps || numbers;
        }
    }
}

/// Decides how the file is written.
pub(super) fn layout(source: &Source, options: &TextOptions) -> Result<Layout, Error> {
    let limit = MAX_PREAMBLE_LINES + SAMPLE_LINES;
    let lines = lines::lines(&source.head, source.row_end, source.whole, limit);
    if lines.iter().all(Line::is_blank) {
        return Err(match source.whole {
            true => Error::new(
                Kind::Format,
                "an empty file",
                "a text table with at least one row",
            ),
            false => problem::long_row(),
        });
    }
    let skip = options.preamble.unwrap_or(0).min(lines.len());
    if let Some(scope) = twincat::layout(&lines, skip, source.row_end, options) {
        return scope;
    }
    let near = lines.iter().take_while(|l| l.start < SAMPLE_BYTES).count();
    let fit = best(&lines[..near], skip, source.row_end, options)?;
    let columns = fit.roles.iter().map(|role| role.columns()).sum();
    if columns > MAX_COLUMNS {
        return Err(problem::too_many_columns(columns).at_line(first_line(&lines, &fit)));
    }
    let ends = Ends::new(fit.separator, source.row_end);
    let above = prologue::read(&lines, &fit, &ends, options)?;
    let label = |column: usize| problem::label(&above.titles[column].name, column);
    let marks = match options.decimal {
        None => fit.marks(&lines, &ends),
        Some(decimal) => {
            refuse_other_mark(&lines, &fit, &ends, decimal)
                .map_err(|(c, e)| e.in_column(label(c)))?;
            [None, None]
        }
    };
    let [mark, other] = marks;
    if let (Some(first), Some(other)) = (&mark, &other) {
        return Err(Error::new(
            Kind::Ambiguous,
            format!("{} with decimal {}", other.seen.text, other.decimal),
            format!(
                "numbers with decimal {} as in line {} ({}); the same mark throughout the file",
                first.decimal, first.seen.line, first.seen.text
            ),
        )
        .at_line(other.seen.line)
        .in_column(label(other.column)));
    }
    if options.separator.is_none() && options.decimal.is_none() {
        let decimal = mark.as_ref().map(|m| m.decimal);
        prologue::refuse_comma_twice(&lines, &fit, &ends, above.named, decimal)?;
    }
    if let Some((line, names)) = above.misfit {
        return Err(prologue::wrong_header(line, names, &fit));
    }
    let first = &lines[above.first.min(lines.len() - 1)];
    let mut detected = vec![format!("separator {}", fit.separator)];
    detected.extend(above.detected);
    if fit.trailing {
        detected.push("separator at the end of each row".to_owned());
    }
    Ok(Layout {
        texts: first_texts(&lines, &fit, &ends),
        rule: Rule {
            ends,
            trailing: fit.trailing,
            run_out: false,
            overruns: fit.separator == Separator::Blanks && !above.named,
            keep: vec![true; fit.kept],
        },
        state: State {
            decimal: options.decimal.or(mark.as_ref().map(|m| m.decimal)),
            width: fit.width,
            roles: fit.roles,
        },
        titles: above.titles,
        offset: first.start,
        line: first.number,
        decimal: mark.map(|m| m.seen),
        detected,
        scope: None,
    })
}

/// Refuses a column (from 0) that is text only because its numbers show another mark than stated.
fn refuse_other_mark(
    lines: &[Line],
    fit: &Fit,
    ends: &Ends,
    decimal: Decimal,
) -> Result<(), (usize, Error)> {
    let Some(first) = fit.rows.first() else {
        return Ok(());
    };
    let line = &lines[first.index];
    let cells = split::fields(line.text, ends, fit.width);
    for (column, (cell, role)) in cells.iter().zip(&fit.roles).enumerate() {
        let number = matches!(cell::classify(&cell.text), Cell::Number(..));
        if *role == Role::Text && number {
            let error = problem::wrong_cell(&cell.text, Some(decimal), None);
            return Err((column, error.at_line(line.number)));
        }
    }
    Ok(())
}

fn first_line(lines: &[Line], fit: &Fit) -> u64 {
    fit.rows.first().map_or(1, |r| lines[r.index].number)
}

/// The first cell of each text column that is a text.
fn first_texts(lines: &[Line], fit: &Fit, ends: &Ends) -> Vec<Option<Seen>> {
    let is_text = |row: &Row, c: usize| row.cells.get(c) == Some(&Cell::Text);
    fit.roles
        .iter()
        .enumerate()
        .map(|(c, role)| {
            let first = fit.rows.first().filter(|_| *role == Role::Text)?;
            let row = fit.rows.iter().find(|row| is_text(row, c)).unwrap_or(first);
            let line = &lines[row.index];
            let cells = split::fields(line.text, ends, fit.width);
            Some(Seen {
                line: line.number,
                text: problem::text_cell(&cells.get(c)?.text),
            })
        })
        .collect()
}

/// The separator with which the head holds most numbers.
fn best(lines: &[Line], skip: usize, row_end: u8, options: &TextOptions) -> Result<Fit, Error> {
    let fit = |separator| Fit::new(lines, skip, separator, row_end, options);
    let none = || nothing_fits(lines, skip, options);
    if let Some(separator) = options.separator {
        return fit(separator).ok_or_else(none);
    }
    let blanks = fit(Separator::Blanks);
    // TAB, `;` and `|` do not occur within numbers: where they split rows, they are the separator,
    // unless every piece between runs of blanks is a number (TABs used as blanks).
    let strong = [Separator::Tab, Separator::Semicolon, Separator::Pipe]
        .into_iter()
        .filter_map(fit)
        .filter(|f| f.width > 1 || f.trailing)
        .reduce(|best, next| {
            if next.samples > best.samples {
                next
            } else {
                best
            }
        });
    if let Some(strong) = strong {
        let all_numbers = |f: &Fit| {
            strong.separator == Separator::Tab
                && f.samples == f.filled
                && f.samples > strong.samples
        };
        return Ok(blanks.filter(all_numbers).unwrap_or(strong));
    }
    let comma = match options.decimal {
        Some(Decimal::Comma) => None,
        _ => fit(Separator::Comma).filter(|f| f.width > 1 || f.trailing),
    };
    // Numbers between words that a separator keeps apart: `0.5 mm;2 N` is two cells, not three.
    if are_apart(lines, skip) {
        return Err(nothing_fits(lines, skip, options));
    }
    let (comma, blanks) = match (comma, blanks) {
        (Some(comma), Some(blanks)) => (comma, blanks),
        (Some(only), None) | (None, Some(only)) => return Ok(only),
        (None, None) => return Err(none()),
    };
    // Compares samples, then the share of cells that are samples.
    let rank = |f: &Fit, other: &Fit| (f.samples, f.samples * other.filled);
    match rank(&comma, &blanks).cmp(&rank(&blanks, &comma)) {
        std::cmp::Ordering::Greater => Ok(comma),
        std::cmp::Ordering::Less => Ok(blanks),
        std::cmp::Ordering::Equal => {
            let row = comma.rows.first().map_or(0, |r| r.index);
            Err(Error::new(
                Kind::Ambiguous,
                format!(
                    "{} can be split at commas or at blanks",
                    problem::show(lines[row].text.trim_ascii())
                ),
                "separator = \"comma\" or separator = \"blanks\" under [text] of the axis file",
            )
            .settled_by_line()
            .at_line(lines[row].number))
        }
    }
}

/// Whether nearly all lines have as many TABs, `;` or `|` as each other.
fn are_apart(lines: &[Line], skip: usize) -> bool {
    let below = lines.get(skip..).unwrap_or_default();
    let filled = || below.iter().filter(|line| !line.is_blank());
    let all = filled().count();
    let strong = [Separator::Tab, Separator::Semicolon, Separator::Pipe];
    strong.into_iter().any(|separator| {
        let marks = |line: &Line| {
            let byte = separator.byte().unwrap_or_default();
            memchr::memchr_iter(byte, line.text.trim_ascii()).count()
        };
        let most = filled().map(marks).max().unwrap_or(0);
        let alike = filled().filter(|line| marks(line) == most).count();
        most > 0 && alike > 1 && alike * 10 >= all * 9
    })
}

fn nothing_fits(lines: &[Line], skip: usize, options: &TextOptions) -> Error {
    let with = match (options.separator, options.decimal) {
        (Some(separator), Some(decimal)) => {
            format!(" with separator {separator}, decimal {decimal}")
        }
        (Some(separator), None) => format!(" with separator {separator}"),
        (None, Some(decimal)) => format!(" with decimal {decimal}"),
        (None, None) => String::new(),
    };
    let count = problem::count(lines.len(), "line");
    let below = lines.get(skip..).unwrap_or_default();
    let shown = below.iter().rfind(|l| !l.is_blank());
    let (mut found, mut allowed) = (
        format!("no row of numbers in the first {count}{with}"),
        "a text table with one sample in each row, as numbers: position or velocity, force, and time unless the rate is known",
    );
    if let Some(line) = shown {
        let text = line.text.trim_ascii();
        found += &format!("; line {} is {}", line.number, problem::show(text));
        if below.iter().filter(|l| !l.is_blank()).count() == 1 && !text.is_empty() {
            allowed =
                "rows of numbers below the names; was the recording exported without its samples?";
        } else if has_units(text) {
            allowed =
                "numbers alone in the cells, with their unit in the header, as `position [mm]`";
        }
    }
    let error = Error::new(Kind::Format, found, allowed);
    match options {
        TextOptions {
            preamble: Some(1..),
            ..
        } => error.of_setting("text.preamble"),
        TextOptions {
            separator: Some(_), ..
        } => error.of_setting("text.separator"),
        TextOptions {
            decimal: Some(_), ..
        } => error.of_setting("text.decimal"),
        _ => error,
    }
}

/// Whether a line has numbers with their unit: `0.5 mm`, `0,5mm`.
fn has_units(line: &[u8]) -> bool {
    line.split(|b| b";|\t".contains(b)).any(|cell| {
        let cell = cell.trim_ascii();
        let number = cell
            .iter()
            .take_while(|b| b.is_ascii_digit() || b"+-.,".contains(b))
            .count();
        let (number, unit) = cell.split_at(number);
        let unit = String::from_utf8_lossy(unit.trim_ascii()).into_owned();
        number.iter().any(u8::is_ascii_digit) && super::unit::is_known(&unit)
    })
}
