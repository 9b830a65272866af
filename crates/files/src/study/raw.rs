//! A study file as typed: tables whose keys are asked for one by one. A key that nobody asked for is refused.

use crate::axis::syntax;
use crate::error::Error;
use std::cell::RefCell;
use std::path::Path;
use stiction_friction::ParamError;
use stiction_log::{Dimension, Value};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Largest value with a unit, SI, and the inverse of the smallest above 0: no machine is near, and products of a few stay
/// finite.
const LARGEST: f64 = 1e15;

/// The file, for messages.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub file: &'a Path,
    pub text: &'a str,
}

impl<'a> Source<'a> {
    /// The tables of the text.
    pub fn parse(&self) -> Result<DeTable<'a>, Error> {
        let table = DeTable::parse(self.text).map_err(|e| {
            let refusal = syntax::refusal(self.text, &e, "docs/study.md");
            Error::Config {
                file: self.file.to_path_buf(),
                place: refusal.place,
                found: refusal.found,
                allowed: refusal.allowed,
            }
        })?;
        Ok(table.into_inner())
    }

    fn line(&self, byte: usize) -> usize {
        let before = self.text.as_bytes().iter().take(byte);
        1 + before.filter(|&&b| b == b'\n').count()
    }
}

/// A table of the file.
pub(super) struct Table<'a> {
    source: Source<'a>,
    /// What stands before its keys in messages, such as `path[2].`.
    prefix: String,
    line: Option<usize>,
    entries: &'a DeTable<'a>,
    asked: RefCell<Vec<&'static str>>,
}

impl<'a> Table<'a> {
    /// The whole file.
    pub fn root(source: Source<'a>, entries: &'a DeTable<'a>) -> Self {
        Table {
            source,
            prefix: String::new(),
            line: None,
            entries,
            asked: RefCell::default(),
        }
    }

    fn get(&self, key: &'static str) -> Option<&'a Spanned<DeValue<'a>>> {
        self.asked.borrow_mut().push(key);
        let mut entries = self.entries.iter();
        entries
            .find(|(name, _)| name.get_ref() == key)
            .map(|(_, value)| value)
    }

    /// A table of this one.
    pub fn table(&self, key: &'static str) -> Result<Option<Table<'a>>, Error> {
        let Some(value) = self.get(key) else {
            return Ok(None);
        };
        match value.get_ref() {
            DeValue::Table(entries) => Ok(Some(self.inner(key.into(), value, entries))),
            other => Err(self.refuse(key, shown(other), &format!("a table [{key}]"))),
        }
    }

    /// A list of at most `most` tables; empty where there is none.
    pub fn tables(&self, key: &'static str, most: usize) -> Result<Vec<Table<'a>>, Error> {
        let Some(value) = self.get(key) else {
            return Ok(Vec::new());
        };
        let allowed = format!("tables [[{key}]]");
        let DeValue::Array(list) = value.get_ref() else {
            return Err(self.refuse(key, shown(value.get_ref()), &allowed));
        };
        if list.len() > most {
            let found = format!("{} of them", list.len());
            return Err(self.refuse(key, found, &format!("at most {most}")));
        }
        let tables = list.iter().enumerate().map(|(i, value)| {
            let name = format!("{key}[{}]", i + 1);
            match value.get_ref() {
                DeValue::Table(entries) => Ok(self.inner(name, value, entries)),
                other => Err(self.refuse(key, shown(other), &allowed)),
            }
        });
        tables.collect()
    }

    fn inner(
        &self,
        name: String,
        value: &Spanned<DeValue<'a>>,
        entries: &'a DeTable<'a>,
    ) -> Table<'a> {
        Table {
            source: self.source,
            prefix: format!("{}{name}.", self.prefix),
            line: Some(self.source.line(value.span().start)),
            entries,
            asked: RefCell::default(),
        }
    }

    /// Text.
    pub fn text(&self, key: &'static str) -> Result<Option<&'a str>, Error> {
        match self.get(key).map(Spanned::get_ref) {
            None => Ok(None),
            Some(DeValue::String(text)) => Ok(Some(text)),
            Some(other) => Err(self.refuse(key, shown(other), "text in quotes")),
        }
    }

    /// One of a few words.
    pub fn choice(&self, key: &'static str, words: &[&str]) -> Result<Option<&'a str>, Error> {
        match self.text(key)? {
            Some(word) if !words.contains(&word) => {
                Err(self.refuse(key, format!("{word:?}"), &words.join(", ")))
            }
            word => Ok(word),
        }
    }

    /// A value with its unit, in SI.
    pub fn value(&self, key: &'static str, dimension: Dimension) -> Result<Option<f64>, Error> {
        let text = match self.get(key).map(Spanned::get_ref) {
            None => return Ok(None),
            Some(DeValue::String(text)) => text,
            Some(other) => {
                let example = match dimension.si_text() {
                    unit if unit == "1" => "\"10 %\"".into(),
                    unit => format!("\"0.5 {unit}\""),
                };
                let allowed = format!("a value with its unit, in quotes, such as {example}");
                return Err(self.refuse(key, shown(other), &allowed));
            }
        };
        let value = Value::parse(text).map_err(|e| self.refuse(key, e.found, &e.allowed))?;
        let value = value
            .si_of(dimension)
            .map_err(|e| self.refuse(key, e.found, &e.allowed))?;
        Ok(Some(value))
    }

    /// A value above 0 with its unit, in SI.
    pub fn positive(&self, key: &'static str, dimension: Dimension) -> Result<Option<f64>, Error> {
        self.within(key, dimension, |x| x > 0.0, "a finite value above 0")
    }

    /// A value of 0 or more with its unit, in SI.
    pub fn not_negative(
        &self,
        key: &'static str,
        dimension: Dimension,
    ) -> Result<Option<f64>, Error> {
        self.within(key, dimension, |x| x >= 0.0, "a finite value from 0")
    }

    fn within(
        &self,
        key: &'static str,
        dimension: Dimension,
        good: impl Fn(f64) -> bool,
        allowed: &str,
    ) -> Result<Option<f64>, Error> {
        match self.value(key, dimension)? {
            Some(x) if !(x.is_finite() && good(x)) => {
                Err(self.refuse(key, format!("{x:?} in SI units"), allowed))
            }
            Some(x) if x > LARGEST || (x > 0.0 && x < 1.0 / LARGEST) => {
                let allowed = format!("from {:e} to {LARGEST:e} in SI units", 1.0 / LARGEST);
                Err(self.refuse(key, format!("{x:?}"), &allowed))
            }
            x => Ok(x),
        }
    }

    /// A plain number within a range.
    pub fn number(&self, key: &'static str, low: f64, high: f64) -> Result<Option<f64>, Error> {
        let allowed = format!("a number from {low} to {high}, without quotes");
        let found = match self.get(key).map(Spanned::get_ref) {
            None => return Ok(None),
            Some(DeValue::Float(x)) => x.as_str().parse::<f64>().ok(),
            Some(DeValue::Integer(x)) => whole(x).map(|x| x as f64),
            Some(other) => return Err(self.refuse(key, shown(other), &allowed)),
        };
        match found {
            Some(x) if (low..=high).contains(&x) => Ok(Some(x)),
            other => {
                let found = other.map_or("no number".into(), |x| x.to_string());
                Err(self.refuse(key, found, &allowed))
            }
        }
    }

    /// A whole number within a range.
    pub fn count(&self, key: &'static str, low: u64, high: u64) -> Result<Option<u64>, Error> {
        let allowed = format!("a whole number from {low} to {high}, without quotes");
        let found = match self.get(key).map(Spanned::get_ref) {
            None => return Ok(None),
            Some(DeValue::Integer(x)) => whole(x),
            Some(other) => return Err(self.refuse(key, shown(other), &allowed)),
        };
        match found.and_then(|x| u64::try_from(x).ok()) {
            Some(x) if (low..=high).contains(&x) => Ok(Some(x)),
            _ => {
                let found = found.map_or("a number too large".into(), |x| x.to_string());
                Err(self.refuse(key, found, &allowed))
            }
        }
    }

    /// True or false.
    pub fn flag(&self, key: &'static str) -> Result<Option<bool>, Error> {
        match self.get(key).map(Spanned::get_ref) {
            None => Ok(None),
            Some(DeValue::Boolean(flag)) => Ok(Some(*flag)),
            Some(other) => Err(self.refuse(key, shown(other), "true or false, without quotes")),
        }
    }

    /// What was asked for, or that it is missing; `example` completes "give".
    pub fn required<T>(
        &self,
        key: &'static str,
        found: Option<T>,
        example: &str,
    ) -> Result<T, Error> {
        found.ok_or_else(|| {
            let found = match self.mistyped(key) {
                Some((line, name)) => format!("is missing, but line {line} has {name}"),
                None => "is missing".into(),
            };
            self.refuse(key, found, &format!("give {example}"))
        })
    }

    /// A key that nobody asked for so far and that is nearly this one, with its line.
    fn mistyped(&self, key: &str) -> Option<(usize, &str)> {
        let asked = self.asked.borrow();
        let strangers = self
            .entries
            .keys()
            .filter(|name| !asked.iter().any(|a| a == name.get_ref()));
        let near = |name: &str| edits(key, &name.to_lowercase()) <= 1 + key.len() / 4;
        let found = strangers.into_iter().find(|name| near(name.get_ref()));
        found.map(|name| (self.source.line(name.span().start), name.get_ref().as_ref()))
    }

    /// Refuses keys that nobody asked for.
    pub fn end(&self) -> Result<(), Error> {
        let asked = self.asked.borrow();
        for name in self.entries.keys() {
            if !asked.iter().any(|key| key == name.get_ref()) {
                let line = self.source.line(name.span().start);
                let found = "is no key here".to_string();
                let allowed = format!("one of {}", asked.join(", "));
                let place = format!("line {line}, {}{}: ", self.prefix, name.get_ref());
                return Err(self.error(place, found, &allowed));
            }
        }
        Ok(())
    }

    /// A value that makes no sense.
    pub fn refuse(&self, key: &str, found: String, allowed: &str) -> Error {
        let mut entries = self.entries.iter();
        let own = entries.find(|(name, _)| name.get_ref() == key);
        let line = own
            .map(|(name, _)| self.source.line(name.span().start))
            .or(self.line);
        let place = match line {
            Some(line) => format!("line {line}, {}{key}: ", self.prefix),
            None => format!("{}{key}: ", self.prefix),
        };
        self.error(place, found, allowed)
    }

    /// Values that do not go together, as a constructor says it.
    pub fn together(&self, error: &ParamError) -> Error {
        let name = self.prefix.trim_end_matches('.');
        let place = match self.line {
            Some(line) => format!("line {line}, {name}: "),
            None => format!("{name}: "),
        };
        let found = format!("{} = {}", error.name, error.value);
        self.error(place, found, error.allowed)
    }

    fn error(&self, place: String, found: String, allowed: &str) -> Error {
        Error::Config {
            file: self.source.file.to_path_buf(),
            place,
            found,
            allowed: allowed.into(),
        }
    }
}

/// Letters to change, add or leave out to make one word of another.
fn edits(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().take(60).collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut corner = std::mem::replace(&mut row[0], i + 1);
        for (j, y) in b.iter().enumerate() {
            let change = corner + usize::from(x != *y);
            corner = row[j + 1];
            row[j + 1] = change.min(corner + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

fn whole(x: &toml::de::DeInteger<'_>) -> Option<i64> {
    i64::from_str_radix(x.as_str(), x.radix()).ok()
}

/// A value as it stands in the file.
fn shown(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("{text:?}"),
        DeValue::Integer(x) => x.as_str().to_string(),
        DeValue::Float(x) => x.as_str().to_string(),
        DeValue::Boolean(flag) => flag.to_string(),
        DeValue::Datetime(_) => "a date".into(),
        DeValue::Array(_) => "a list".into(),
        DeValue::Table(_) => "a table".into(),
    }
}
