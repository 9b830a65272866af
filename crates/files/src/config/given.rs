//! One value of a configuration file, with its key and its place.

use super::form::Form;
use super::source::Source;
use super::table::Table;
use super::typed::{self, NotRead};
use crate::error::Error;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use stiction_codes::Code;
use stiction_formats::{Dimension, Value};
use stiction_number::full;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Largest value with a unit, in SI, and the inverse of the smallest above 0. No machine comes near; products of twenty of them
/// stay finite (below 1e308).
pub(crate) const LARGEST_SI: f64 = 1e15;
/// The largest whole number that a file can hold: no limit of its own.
pub(crate) const ANY_COUNT: u64 = i64::MAX as u64;
/// Longest piece of the file that is quoted, characters.
const QUOTED: usize = 60;
/// Most entries of a list that are quoted.
const LISTED: usize = 4;

/// A value as it stands in the file.
#[derive(Clone)]
pub(crate) struct Given<'a> {
    source: Source<'a>,
    /// The key with the tables that it is in, such as `path[2].amplitude`.
    pub(super) key: String,
    value: &'a Spanned<DeValue<'a>>,
    /// Words that are allowed too, for messages.
    words: &'static [&'static str],
}

impl<'a> Given<'a> {
    pub(super) fn new(source: Source<'a>, key: String, value: &'a Spanned<DeValue<'a>>) -> Self {
        Given {
            source,
            key,
            value,
            words: &[],
        }
    }

    /// Allows these words besides what is asked for next, and returns the word if the value is one of them.
    pub fn or_word(mut self, words: &'static [&'static str]) -> (Self, Option<&'static str>) {
        self.words = words;
        let word = words.iter().find(|word| self.as_text() == Some(word));
        (self, word.copied())
    }

    /// Where it stands, as errors begin: `line 3, column 8, mass: `.
    pub fn place(&self) -> String {
        format!(
            "{}, {}: ",
            self.source.at(self.value.span().start),
            self.key
        )
    }

    /// The value as typed, for messages.
    pub fn shown(&self) -> String {
        shown(self.value.get_ref())
    }

    /// A value that makes no sense: what was found, what is allowed.
    pub fn refuse(&self, found: String, allowed: &str) -> Error {
        let words: Vec<String> = self.words.iter().map(|w| format!("{w:?}")).collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        match words.as_slice() {
            [] => self.source.error(self.place(), found, allowed),
            words => {
                let allowed = format!("{allowed}; or {}", either(words));
                self.source.error(self.place(), found, &allowed)
            }
        }
    }

    /// The same with a code of its own: what is wrong with a file that this names.
    pub fn refuse_as(&self, code: Code, found: String, allowed: &str) -> Error {
        Error::Misfit {
            file: self.source.file.to_path_buf(),
            place: self.place(),
            found,
            allowed: allowed.into(),
            code,
        }
    }

    /// The same, with the value as typed for what was found.
    pub fn refused(&self, allowed: &str) -> Error {
        self.refuse(self.shown(), allowed)
    }

    /// Text, where it is text.
    pub fn as_text(&self) -> Option<&'a str> {
        match self.value.get_ref() {
            DeValue::String(text) => Some(text),
            _ => None,
        }
    }

    /// A whole number, where it is one.
    pub fn as_whole(&self) -> Option<i64> {
        match self.value.get_ref() {
            DeValue::Integer(x) => i64::from_str_radix(x.as_str(), x.radix()).ok(),
            _ => None,
        }
    }

    /// A number, where it is one.
    pub fn as_number(&self) -> Option<f64> {
        match self.value.get_ref() {
            DeValue::Float(x) => x.as_str().parse().ok(),
            DeValue::Integer(_) => self.as_whole().map(|x| x as f64),
            _ => None,
        }
    }

    /// A table, where it is one.
    pub fn as_table(&self) -> Option<Table<'a>> {
        match self.value.get_ref() {
            DeValue::Table(entries) => Some(self.table(entries)),
            _ => None,
        }
    }

    fn table(&self, entries: &'a DeTable<'a>) -> Table<'a> {
        let prefix = format!("{}.", self.key);
        Table::new(self.source, prefix, self.value.span().start, entries)
    }

    /// The entries of a list, where it is one.
    pub fn as_list(&self) -> Option<Vec<Given<'a>>> {
        let DeValue::Array(list) = self.value.get_ref() else {
            return None;
        };
        let entry = |(i, value)| Given::new(self.source, format!("{}[{}]", self.key, i + 1), value);
        Some(list.iter().enumerate().map(entry).collect())
    }

    /// Text in quotes.
    pub fn text(&self) -> Result<&'a str, Error> {
        self.as_text().ok_or_else(|| self.refused("text in quotes"))
    }

    /// The file that this names, from a folder, with its text; `what` it is to be, such as "an axis file", is for messages.
    pub fn file(&self, folder: &Path, form: Form) -> Result<(PathBuf, String), Error> {
        let name = self.path(form.what())?;
        let file = folder.join(name);
        match typed::text(&file, form) {
            Ok(text) => Ok((file, text)),
            // The file that names it is the one to mend.
            Err(NotRead::Other(Error::OtherForm {
                found,
                wanted,
                instead,
                ..
            })) => {
                let found = format!("{}: is {found}", file.display());
                let beside = instead.map(|path| format!(": {}", path.display()));
                Err(self.refuse(found, &format!("{wanted}{}", beside.unwrap_or_default())))
            }
            Err(NotRead::Other(error)) => Err(error),
            Err(NotRead::Faulty(found, allowed)) => {
                let found = format!("{}: {found}", file.display());
                Err(self.refuse(found, &allowed))
            }
        }
    }

    /// The name of a file.
    pub fn path(&self, what: &str) -> Result<&'a str, Error> {
        match self.as_text() {
            Some(name) if !name.trim().is_empty() => Ok(name),
            _ => Err(self.refused(&format!("the path of {what}, in quotes"))),
        }
    }

    /// True or false.
    pub fn flag(&self) -> Result<bool, Error> {
        match self.value.get_ref() {
            DeValue::Boolean(flag) => Ok(*flag),
            _ => Err(self.refused("true or false, without quotes")),
        }
    }

    /// One of a few words.
    pub fn choice(&self, words: &[&str]) -> Result<&'a str, Error> {
        match self.as_text() {
            Some(word) if words.contains(&word) => Ok(word),
            _ => Err(self.refused(&either(words))),
        }
    }

    /// A plain number within a range.
    pub fn number(&self, low: f64, high: f64) -> Result<f64, Error> {
        match self.as_number() {
            Some(x) if (low..=high).contains(&x) => Ok(x),
            _ => {
                let range = match high {
                    f64::MAX => String::new(),
                    _ => format!(" from {} to {}", full(low), full(high)),
                };
                Err(self.refused(&format!("a number{range}, without quotes")))
            }
        }
    }

    /// A whole number within a range.
    pub fn count(&self, low: u64, high: u64) -> Result<u64, Error> {
        match self.as_whole().and_then(|x| u64::try_from(x).ok()) {
            Some(x) if (low..=high).contains(&x) => Ok(x),
            _ => {
                // Nobody types the largest number of a machine.
                let range = match high {
                    ANY_COUNT => format!("from {low} on, with at most 18 digits"),
                    _ => format!("from {low} to {high}"),
                };
                Err(self.refused(&format!("a whole number {range}, without quotes")))
            }
        }
    }

    /// A value with its unit; `example` is for messages.
    pub fn quantity(&self, example: &str) -> Result<Value, Error> {
        let Some(text) = self.as_text() else {
            let allowed = format!("a value with its unit, in quotes, such as {example}");
            return Err(self.refused(&allowed));
        };
        Value::parse(text).map_err(|e| self.refuse(e.found, &e.allowed))
    }

    /// A value with a unit of one of these dimensions, in SI, and which it is.
    pub fn value(&self, dimensions: &[Dimension]) -> Result<(f64, Dimension), Error> {
        let first = dimensions.first().copied().unwrap_or(Dimension::ONE);
        let example = match first.si_text() {
            unit if unit == "1" => "\"10 %\"".into(),
            unit if unit == "1/s" => "\"100 Hz\"".into(),
            unit => format!("\"0.5 {unit}\""),
        };
        let value = self.quantity(&example)?;
        let (mut found, mut allowed) = (String::new(), Vec::new());
        for &dimension in dimensions {
            match value.si_of(dimension) {
                Ok(x) => return Ok((x, dimension)),
                Err(e) => {
                    found = e.found;
                    allowed.push(e.allowed);
                }
            }
        }
        Err(self.refuse(found, &allowed.join("; or ")))
    }

    /// The same of either sign.
    pub fn signed(&self, dimension: Dimension) -> Result<f64, Error> {
        let (x, _) = self.value(&[dimension])?;
        if x.abs() <= LARGEST_SI {
            return Ok(x);
        }
        let unit = dimension.si_text();
        let unit = if unit == "1" { "" } else { &unit };
        let allowed = format!("from -{LARGEST_SI:e} to {LARGEST_SI:e} {unit}");
        Err(self.refused(allowed.trim_end()))
    }

    /// The same above 0.
    pub fn positive(&self, dimensions: &[Dimension]) -> Result<(f64, Dimension), Error> {
        self.within(dimensions, |x| x > 0.0, "a finite value above 0")
    }

    /// The same of 0 or more.
    pub fn not_negative(&self, dimensions: &[Dimension]) -> Result<(f64, Dimension), Error> {
        self.within(dimensions, |x| x >= 0.0, "a finite value from 0")
    }

    /// A value with a unit of one of these dimensions within a range in SI.
    pub fn among(
        &self,
        dimensions: &[Dimension],
        range: &RangeInclusive<f64>,
    ) -> Result<(f64, Dimension), Error> {
        let (x, dimension) = self.value(dimensions)?;
        if range.contains(&x) {
            return Ok((x, dimension));
        }
        let (low, high) = (range.start(), range.end());
        let unit = match dimension {
            Dimension::FREQUENCY => "Hz".into(),
            other => other.si_text(),
        };
        let allowed = format!("from {low:e} to {high:e} {unit}");
        Err(self.refused(&allowed))
    }

    fn within(
        &self,
        dimensions: &[Dimension],
        good: impl Fn(f64) -> bool,
        allowed: &str,
    ) -> Result<(f64, Dimension), Error> {
        let (x, dimension) = self.value(dimensions)?;
        if !(x.is_finite() && good(x)) {
            return Err(self.refused(allowed));
        }
        if x > LARGEST_SI || (x > 0.0 && x < 1.0 / LARGEST_SI) {
            let (least, unit) = (1.0 / LARGEST_SI, dimension.si_text());
            let allowed = format!("from {least:e} to {LARGEST_SI:e} {unit}");
            return Err(self.refused(&allowed));
        }
        Ok((x, dimension))
    }
}

/// `a`, `a or b`, `a, b or c`.
fn either(words: &[&str]) -> String {
    match words {
        [before @ .., last] if !before.is_empty() => format!("{} or {last}", before.join(", ")),
        _ => words.concat(),
    }
}

/// A value as it stands in the file, on one line and not too long.
fn shown(value: &DeValue<'_>) -> String {
    let cut = |text: String| {
        if text.chars().count() <= QUOTED {
            return text;
        }
        let start: String = text.chars().take(QUOTED).collect();
        format!("{start}...")
    };
    match value {
        DeValue::String(text) => cut(format!("{text:?}")),
        DeValue::Integer(x) => cut(x.to_string()),
        DeValue::Float(x) => cut(x.as_str().to_string()),
        DeValue::Boolean(flag) => flag.to_string(),
        DeValue::Datetime(_) => "a date".into(),
        DeValue::Array(list) => {
            let each = list.iter().take(LISTED).map(|entry| match entry.get_ref() {
                DeValue::Array(_) => "a list".into(),
                entry => shown(entry),
            });
            let more = if list.len() > LISTED { ", ..." } else { "" };
            cut(format!("[{}{more}]", each.collect::<Vec<_>>().join(", ")))
        }
        DeValue::Table(_) => "a table".into(),
    }
}
