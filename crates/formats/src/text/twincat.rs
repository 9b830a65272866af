//! TwinCAT Scope text exports, old and new: rows of `<key> <value>` for each channel, then samples.
//!
//! A group of channels stands behind each key cell; the key's own column holds the group's time
//! stamps (milliseconds, or FILETIME), or is not written at all. A slower channel runs out early.
//! The Offset and ScaleFactor rows describe the display: no value is ever changed by them.

use super::cell::{self, Cell};
use super::choose::Layout;
use super::header::Title;
use super::limits::{MAX_COLUMNS, MAX_PREAMBLE_LINES};
use super::lines::Line;
use super::options::{Decimal, Separator, TextOptions};
use super::problem;
use super::row::{self, Role, Rule, Seen, State};
use super::scope::{Group, Scope};
use super::split::{self, Ends};
use crate::{Error, Kind};

/// Keys of the rows above the samples that only a Scope export has.
const KEYS: [&str; 15] = [
    "SymbolComment",
    "Data-Type",
    "DataType",
    "SampleTime[ms]",
    "SampleTime",
    "VariableSize",
    "SymbolBased",
    "IndexGroup",
    "IndexOffset",
    "SymbolName",
    "NetID",
    "ScaleFactor",
    "BitMask",
    "Unit ScaleFactor",
    "Unit Offset",
];
/// Starts of the rows about the whole file.
const FILE_KEYS: [&str; 4] = [
    "Starttime of export",
    "Endtime of export",
    "StartRecord",
    "EndRecord",
];
/// Difference of two spacings that is put down to rounding, relative.
const SPACING_ROUNDING: f64 = 1e-6;

/// Least FILETIME stamp (100 ns since 1601): those of this century and the last are above it, milliseconds of a log below.
const MIN_FILETIME: i64 = 10_000_000_000_000_000;

/// The layout of a Scope export, or `None` where the file is not one.
pub(super) fn layout(
    lines: &[Line],
    skip: usize,
    row_end: u8,
    options: &TextOptions,
) -> Option<Result<Layout, Error>> {
    let (index, separator) = name_row(lines, skip)?;
    if options.header == Some(false) || options.separator.is_some_and(|s| s != separator) {
        return None;
    }
    let ends = Ends::new(separator, row_end);
    Some(Header { lines, index, ends }.layout(options))
}

/// The row of channel names, if the lines around it are those of a Scope export.
fn name_row(lines: &[Line], skip: usize) -> Option<(usize, Separator)> {
    let starts = |line: &Line, key: &str| line.text.starts_with(key.as_bytes());
    let named: Vec<usize> = (skip..lines.len())
        .filter(|&i| separator(lines[i].text).is_some())
        .collect();
    let index = *named.last()?;
    let separator = separator(lines[index].text)?;
    let repeats = lines[index]
        .text
        .split(|b| Some(*b) == separator.byte())
        .filter(|c| *c == b"Name");
    let telling = lines[skip..]
        .iter()
        .any(|l| KEYS.iter().chain(&FILE_KEYS).any(|key| starts(l, key)));
    let blank_below = lines.get(index + 1).is_some_and(Line::is_blank);
    (telling || named.len() > 1 || repeats.count() > 1 || blank_below).then_some((index, separator))
}

/// The separator behind `Name` at the start of a line.
fn separator(line: &[u8]) -> Option<Separator> {
    match line.strip_prefix(b"Name")?.first()? {
        b'\t' => Some(Separator::Tab),
        b' ' => Some(Separator::Blanks),
        b':' => Some(Separator::Colon),
        b';' => Some(Separator::Semicolon),
        b',' => Some(Separator::Comma),
        _ => None,
    }
}

/// The rows above the samples.
struct Header<'a> {
    lines: &'a [Line<'a>],
    /// The row of channel names.
    index: usize,
    ends: Ends,
}

impl Header<'_> {
    fn layout(&self, options: &TextOptions) -> Result<Layout, Error> {
        let line = &self.lines[self.index];
        let mut names = self.cells(self.index);
        let trailing = names.len() > 1 && names.last().is_some_and(String::is_empty);
        if trailing {
            names.pop();
        }
        if names.len() > MAX_COLUMNS {
            return Err(problem::too_many_columns(names.len()).at_line(line.number));
        }
        let (first, samples) = self.first_row(&mut names)?;
        let keys: Vec<usize> = (0..names.len()).filter(|&c| names[c] == "Name").collect();
        let timed = samples.len() == names.len();
        let columns: Vec<usize> = (0..names.len())
            .filter(|c| timed || !keys.contains(c))
            .collect();
        let wide = |row: Option<Vec<String>>| row.filter(|r| r.len() >= names.len());
        let units = wide(self.row("Unit", first));
        let times = wide(
            self.row("SampleTime[ms]", first)
                .or_else(|| self.row("SampleTime", first)),
        );
        let mut groups: Vec<Group> = Vec::new();
        let (mut titles, mut roles, mut sample_times) = (Vec::new(), Vec::new(), Vec::new());
        let mut file_time = None;
        let mut key_of_group = None;
        for &c in &columns {
            let at = titles.len();
            let key = keys.iter().rev().find(|&&k| k <= c).copied();
            if groups.is_empty() || key != key_of_group {
                groups.push(Group {
                    time: None,
                    channels: Vec::new(),
                });
                key_of_group = key;
            }
            let Some(group) = groups.last_mut() else {
                continue;
            };
            if Some(c) == key {
                group.time = Some(at);
                let stamp = row::file_time(samples[at].as_bytes()).filter(|t| *t >= MIN_FILETIME);
                file_time = file_time.or(stamp);
                let role = stamp
                    .and(file_time)
                    .map_or(Role::Number, |base| Role::FileTime { base });
                let unit = if role == Role::Number { "ms" } else { "s" };
                titles.push(Title {
                    name: "time".to_owned(),
                    unit: Some(unit.to_owned()),
                });
                roles.push(role);
                sample_times.push(None);
            } else {
                group.channels.push(at);
                let unit = units.as_ref().and_then(|u| unit(&u[c]));
                titles.push(Title {
                    name: names[c].clone(),
                    unit,
                });
                roles.push(Role::Unknown);
                let time = times.as_ref().map(|t| cell::classify(t[c].as_bytes()));
                sample_times.push(match time {
                    Some(Cell::Number(ms, _)) if ms > 0.0 => Some(ms),
                    _ => None,
                });
            }
        }
        let mut detected = vec![
            "TwinCAT Scope export".to_owned(),
            format!("separator {}", self.ends.separator),
        ];
        detected.push(format!("channel names in line {}", line.number));
        if !timed {
            detected.push("no time columns".to_owned());
        }
        if file_time.is_some() {
            detected.push("FILETIME stamps, converted to seconds from the first".to_owned());
        }
        detected.extend(self.display_rows(&names, first));
        let decimal = options.decimal.or_else(|| self.decimal(&times));
        let row = &self.lines[first];
        Ok(Layout {
            rule: Rule {
                ends: self.ends.clone(),
                trailing: true,
                run_out: true,
                overruns: false,
                keep: vec![true; roles.len()],
            },
            state: State {
                width: roles.len(),
                roles,
                decimal,
            },
            texts: vec![None; titles.len()],
            titles,
            offset: row.start,
            line: row.number,
            decimal: decimal
                .filter(|_| options.decimal.is_none())
                .and(self.time_seen(first)),
            detected,
            scope: Some(Scope {
                groups,
                sample_times,
            }),
        })
    }

    fn cells(&self, index: usize) -> Vec<String> {
        split::fields(self.lines[index].text, &self.ends, 2 * MAX_COLUMNS)
            .iter()
            .map(|f| problem::name(&f.text))
            .collect()
    }

    /// Index and cells of the first row of samples; every channel has one there. Names that were
    /// split at their blanks are mended.
    fn first_row(&self, names: &mut Vec<String>) -> Result<(usize, Vec<String>), Error> {
        let number = self.lines[self.index].number;
        let below = self.index + 1..self.lines.len().min(MAX_PREAMBLE_LINES);
        for index in below {
            let mut cells = self.cells(index);
            let value = |c: &String| {
                let cell = cell::classify(c.as_bytes());
                cell.is_void() || matches!(cell, Cell::Number(..))
            };
            let numbers = cells.iter().all(value)
                && cells
                    .first()
                    .is_some_and(|c| cell::classify(c.as_bytes()).is_sample());
            if !numbers {
                continue;
            }
            if cells.len() > 1
                && cells.last().is_some_and(String::is_empty)
                && cells.len() > names.len()
            {
                cells.pop();
            }
            let keys = names.iter().filter(|n| *n == "Name").count();
            if self.ends.separator == Separator::Blanks && cells.len() != names.len() {
                // Only a row whose cells hold no blanks tells names with blanks from more names.
                let types = self
                    .row("Data-Type", index)
                    .or_else(|| self.row("SampleTime[ms]", index));
                match types.map(|t| t.len()) {
                    Some(width) if width == names.len() => {}
                    Some(width) if width == 2 * keys => *names = mend(names),
                    _ => names.clear(),
                }
            }
            if cells.len() == names.len() {
                return Ok((index, cells));
            }
            if names.len() > keys && cells.len() + keys == names.len() {
                self.refuse_stamps(index)?;
                return Ok((index, cells));
            }
            let found = format!("{} cells below the names of line {number}", cells.len());
            let line = self.lines[index].number;
            return Err(match self.ends.separator {
                Separator::Comma if cells.len() > names.len() => Error::new(
                    Kind::Ambiguous,
                    found,
                    "one cell for each name; if the comma is the decimal mark too, export with `;` \
                     or TAB between the cells",
                ),
                Separator::Blanks => Error::new(
                    Kind::Ambiguous,
                    found,
                    "names without blanks, or an export with `;` or TAB between the cells",
                ),
                _ => Error::new(Kind::Format, found, "one cell for each name"),
            }
            .at_line(line));
        }
        Err(Error::new(
            Kind::Format,
            "channel names without samples below",
            "one row of numbers or more, one cell for each name",
        )
        .at_line(number))
    }

    /// Where time columns seem not to be written: refuses samples that start with time stamps, since
    /// then it is a channel that is missing.
    fn refuse_stamps(&self, first: usize) -> Result<(), Error> {
        let number = |c: Option<&String>| match c.map(|c| cell::classify(c.as_bytes())) {
            Some(Cell::Number(value, _)) => value,
            _ => f64::NAN,
        };
        let rows = first..self.lines.len().min(first + 3);
        let starts: Vec<f64> = rows.map(|i| number(self.cells(i).first())).collect();
        let stated = self
            .row("SampleTime[ms]", first)
            .or_else(|| self.row("SampleTime", first));
        let ramp = match (&starts[..], stated) {
            ([a, b, c], Some(times)) => {
                let step = number(times.get(1));
                let near = |x: f64| (x - step).abs() < SPACING_ROUNDING * step;
                near(b - a) && near(c - b)
            }
            ([a, b, c], None) => {
                *a == 0.0 && *b > 0.0 && ((c - b) - (b - a)).abs() < SPACING_ROUNDING * b
            }
            _ => false,
        };
        if !ramp && starts[0] < MIN_FILETIME as f64 {
            return Ok(());
        }
        Err(Error::new(
            Kind::Ambiguous,
            "too few cells for the names above, and the first ones look like time stamps",
            "samples of every channel in the first row, or an export without time columns whose \
             first channel is no time",
        )
        .at_line(self.lines[first].number))
    }

    /// The cells of the row with this key between the names and the samples.
    fn row(&self, key: &str, first: usize) -> Option<Vec<String>> {
        let rows = self.index + 1..first;
        rows.map(|i| self.cells(i))
            .find(|cells| cells.first().is_some_and(|c| c == key))
    }

    /// Says which display settings the header states, none of which is applied.
    fn display_rows(&self, names: &[String], first: usize) -> Vec<String> {
        let mut said = Vec::new();
        for (key, neutral) in [
            ("Offset", 0.0),
            ("ScaleFactor", 1.0),
            ("Unit ScaleFactor", 1.0),
            ("Unit Offset", 0.0),
        ] {
            let Some(row) = self.row(key, first).filter(|r| r.len() >= names.len()) else {
                continue;
            };
            let differs = |c: &usize| {
                names[*c] != "Name"
                    && matches!(cell::classify(row[*c].as_bytes()), Cell::Number(v, _) if v != neutral)
            };
            let set: Vec<String> = (0..names.len())
                .filter(differs)
                .map(|c| format!("{} {}", problem::show(names[c].as_bytes()), row[c]))
                .collect();
            if !set.is_empty() {
                said.push(format!(
                    "display {key} not applied: {}",
                    problem::list(&set)
                ));
            }
        }
        said
    }

    /// The decimal mark of the sample times.
    fn decimal(&self, times: &Option<Vec<String>>) -> Option<Decimal> {
        times
            .iter()
            .flatten()
            .find_map(|t| match cell::classify(t.as_bytes()) {
                Cell::Number(_, mark) => mark,
                _ => None,
            })
    }

    fn time_seen(&self, first: usize) -> Option<Seen> {
        (self.index + 1..first).find_map(|i| {
            let cells = self.cells(i);
            let key = cells.first()?;
            let text = cells
                .iter()
                .find(|c| matches!(cell::classify(c.as_bytes()), Cell::Number(_, Some(_))))?;
            key.starts_with("SampleTime").then(|| Seen {
                line: self.lines[i].number,
                text: problem::show(text.as_bytes()),
            })
        })
    }
}

/// One name for each key: the words between two keys belong together.
fn mend(words: &[String]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for word in words {
        match names.last_mut() {
            Some(_) if word == "Name" => names.push(word.clone()),
            Some(last) if last == "Name" => names.push(word.clone()),
            Some(last) => {
                last.push(' ');
                last.push_str(word);
            }
            None => names.push(word.clone()),
        }
    }
    names
}

/// The unit of a cell such as `mm (Length)`; `(None)` means no unit.
fn unit(cell: &str) -> Option<String> {
    let unit = cell.split(" (").next().unwrap_or_default().trim();
    (!unit.is_empty() && unit != "(None)").then(|| unit.to_owned())
}
