//! A table of a configuration file, whose keys are asked for one by one. A key that nobody asked for is refused.

use super::given::Given;
use super::name::cut;
use super::source::Source;
use super::swept::Swept;
use crate::error::Error;
use std::cell::RefCell;
use std::ops::RangeInclusive;
use stiction_formats::Dimension;
use stiction_friction::ParamError;
use stiction_number::full;
use toml::de::DeTable;

/// Parameters of the engines that have another name in the files.
const ALIASES: [(&str, &str); 7] = [
    ("peak_current", "peak_force"),
    ("current_lag", "current_loop"),
    ("resolution", "encoder"),
    ("adaptation_memory", "memory"),
    ("adaptation_range", "range"),
    ("half_width", "width"),
    ("half_height", "height"),
];

/// Most characters of a name: what a title and a terminal can show.
const LONGEST_LINE: usize = 200;

/// A table.
pub(crate) struct Table<'a> {
    source: Source<'a>,
    /// What stands before its keys in messages, such as `path[2].`.
    prefix: String,
    /// Where it starts, bytes.
    start: usize,
    entries: &'a DeTable<'a>,
    asked: RefCell<Vec<&'static str>>,
}

impl<'a> Table<'a> {
    /// The whole file.
    pub fn root(source: Source<'a>, entries: &'a DeTable<'a>) -> Self {
        Table::new(source, String::new(), 0, entries)
    }

    pub(super) fn new(
        source: Source<'a>,
        prefix: String,
        start: usize,
        entries: &'a DeTable<'a>,
    ) -> Self {
        Table {
            source,
            prefix,
            start,
            entries,
            asked: RefCell::default(),
        }
    }

    /// What a key was given, if it was.
    pub fn get(&self, key: &'static str) -> Option<Given<'a>> {
        self.asked.borrow_mut().push(key);
        self.find(key)
    }

    /// The value of a key, also of one that nobody asks for.
    pub fn find(&self, key: &str) -> Option<Given<'a>> {
        let mut entries = self.entries.iter();
        let found = entries.find(|(name, _)| name.get_ref() == key);
        let swept = self.source.swept;
        if let Some(given) = swept.and_then(|s| s.of(&self.prefix, key, found.is_some())) {
            return Some(given);
        }
        let (_, value) = found?;
        Some(Given::new(
            self.source,
            format!("{}{key}", self.prefix),
            value,
        ))
    }

    /// The value that stands in place of one of the file.
    pub fn swept(&self) -> Option<Swept<'a>> {
        self.source.swept
    }

    /// A table of this one.
    pub fn table(&self, key: &'static str) -> Result<Option<Table<'a>>, Error> {
        let Some(given) = self.get(key) else {
            return Ok(None);
        };
        match given.as_table() {
            Some(table) => Ok(Some(table)),
            None => Err(given.refused(&format!("a table [{key}]"))),
        }
    }

    /// A list of at most `most` tables; empty where there is none.
    pub fn tables(&self, key: &'static str, most: usize) -> Result<Vec<Table<'a>>, Error> {
        let Some(given) = self.get(key) else {
            return Ok(Vec::new());
        };
        let allowed = format!("tables [[{key}]]");
        let Some(list) = given.as_list() else {
            return Err(given.refused(&allowed));
        };
        if list.len() > most {
            let found = format!("{} of them", list.len());
            return Err(given.refuse(found, &format!("at most {most}")));
        }
        let tables = list.iter().map(|entry| {
            let table = entry.as_table();
            table.ok_or_else(|| entry.refused(&allowed))
        });
        tables.collect()
    }

    /// Text.
    pub fn text(&self, key: &'static str) -> Result<Option<&'a str>, Error> {
        self.get(key).map(|given| given.text()).transpose()
    }

    /// Text on one line, which titles, tables and terminals can show.
    pub fn line(&self, key: &'static str) -> Result<Option<&'a str>, Error> {
        let text = self.text(key)?;
        match text {
            Some(text) if text.contains(char::is_control) => {
                Err(self.refused(key, "text on one line, without control characters"))
            }
            Some(text) if text.chars().count() > LONGEST_LINE => {
                let found = format!("{} characters", text.chars().count());
                Err(self.refuse(key, found, &format!("at most {LONGEST_LINE} characters")))
            }
            text => Ok(text),
        }
    }

    /// One of a few words.
    pub fn choice(&self, key: &'static str, words: &[&str]) -> Result<Option<&'a str>, Error> {
        self.get(key).map(|given| given.choice(words)).transpose()
    }

    /// A value of either sign with its unit, in SI.
    pub fn value(&self, key: &'static str, dimension: Dimension) -> Result<Option<f64>, Error> {
        let value = self.get(key).map(|given| given.signed(dimension));
        value.transpose()
    }

    /// A value above 0 with its unit, in SI.
    pub fn positive(&self, key: &'static str, dimension: Dimension) -> Result<Option<f64>, Error> {
        let value = self.get(key).map(|given| given.positive(&[dimension]));
        Ok(value.transpose()?.map(|(x, _)| x))
    }

    /// The same within a range in SI.
    pub fn among(
        &self,
        key: &'static str,
        dimension: Dimension,
        range: &RangeInclusive<f64>,
    ) -> Result<Option<f64>, Error> {
        let value = self.get(key).map(|given| given.among(&[dimension], range));
        Ok(value.transpose()?.map(|(x, _)| x))
    }

    /// A value of 0 or more with its unit, in SI.
    pub fn not_negative(
        &self,
        key: &'static str,
        dimension: Dimension,
    ) -> Result<Option<f64>, Error> {
        let value = self.get(key).map(|given| given.not_negative(&[dimension]));
        Ok(value.transpose()?.map(|(x, _)| x))
    }

    /// A plain number within a range.
    pub fn number(&self, key: &'static str, low: f64, high: f64) -> Result<Option<f64>, Error> {
        self.get(key)
            .map(|given| given.number(low, high))
            .transpose()
    }

    /// A whole number within a range.
    pub fn count(&self, key: &'static str, low: u64, high: u64) -> Result<Option<u64>, Error> {
        self.get(key)
            .map(|given| given.count(low, high))
            .transpose()
    }

    /// True or false.
    pub fn flag(&self, key: &'static str) -> Result<Option<bool>, Error> {
        self.get(key).map(|given| given.flag()).transpose()
    }

    /// Every entry, in the order of the file, of a table whose keys are names that the user chose.
    pub fn named(&self) -> Vec<(&'a str, Given<'a>)> {
        let mut entries: Vec<_> = self.entries.iter().collect();
        entries.sort_by_key(|(name, _)| name.span().start);
        let given = |(name, value): (&'a toml::Spanned<_>, &'a toml::Spanned<_>)| {
            let name: &'a std::borrow::Cow<'a, str> = name.get_ref();
            let key = format!("{}{name}", self.prefix);
            (name.as_ref(), Given::new(self.source, key, value))
        };
        entries.into_iter().map(given).collect()
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
                Some((at, name)) => format!("is missing, but {at} has {}", cut(name)),
                None => "is missing".into(),
            };
            self.refuse(key, found, &format!("give {example}"))
        })
    }

    /// A key that nobody asked for so far and that is nearly this one, with its place.
    fn mistyped(&self, key: &str) -> Option<(String, &str)> {
        let asked = self.asked.borrow();
        let mut strangers = self
            .entries
            .keys()
            .filter(|name| !asked.iter().any(|a| a == name.get_ref()));
        let found = strangers.find(|name| near(key, name.get_ref()));
        found.map(|name| (self.source.at(name.span().start), name.get_ref().as_ref()))
    }

    /// Refuses keys that nobody asked for.
    pub fn end(&self) -> Result<(), Error> {
        match self.strangers().into_iter().next() {
            Some(error) => Err(error),
            None => Ok(()),
        }
    }

    /// An error for each key that nobody asked for.
    pub fn strangers(&self) -> Vec<Error> {
        let asked = self.asked.borrow();
        let mut keys: Vec<&str> = Vec::new();
        for key in asked.iter() {
            if !keys.contains(key) {
                keys.push(key);
            }
        }
        let allowed = format!(
            "one of {} (see {})",
            keys.join(", "),
            self.source.form.page()
        );
        let names = self.entries.keys();
        let strangers = names.filter(|name| !keys.contains(&name.get_ref().as_ref()));
        let errors = strangers.map(|name| {
            let text = name.get_ref();
            let found = match keys.iter().find(|key| near(key, text)) {
                Some(key) => format!("is not a key here; did you mean {key}?"),
                None => "is not a key here".into(),
            };
            let at = self.source.at(name.span().start);
            let place = format!("{at}, {}{}: ", self.prefix, cut(text));
            self.source.error(place, found, &allowed)
        });
        errors.collect()
    }

    /// A value that makes no sense, or a key that is missing.
    pub fn refuse(&self, key: &str, found: String, allowed: &str) -> Error {
        match self.find(key) {
            Some(given) => given.refuse(found, allowed),
            None => self
                .source
                .error(self.place(&format!("{}{key}", self.prefix)), found, allowed),
        }
    }

    /// The same, with the value as typed for what was found.
    pub fn refused(&self, key: &str, allowed: &str) -> Error {
        match self.find(key) {
            Some(given) => given.refused(allowed),
            None => self.refuse(key, "is missing".into(), allowed),
        }
    }

    /// File and place of a key, within a message about another file.
    pub fn where_is(&self, key: &str) -> String {
        let place = match self.find(key) {
            Some(given) => given.place(),
            None => self.place(&format!("{}{key}", self.prefix)),
        };
        format!(
            "{}: {}",
            self.source.file.display(),
            place.trim_end_matches(": ")
        )
    }

    /// Values that do not go together, as a constructor says it: at the key that it names, where the file has it.
    pub fn together(&self, error: &ParamError) -> Error {
        let alias = ALIASES.iter().find(|(name, _)| *name == error.name);
        let key = alias.map_or(error.name, |(_, key)| *key);
        match self.find(key) {
            Some(given) => given.refused(error.allowed),
            None => {
                let place = self.place(self.prefix.trim_end_matches('.'));
                let found = format!("{} = {}", error.name, full(error.value));
                self.source.error(place, found, error.allowed)
            }
        }
    }

    /// The place of this table, with a name that it is to have in messages.
    fn place(&self, name: &str) -> String {
        format!("{}, {name}: ", self.source.at(self.start))
    }
}

/// Whether a word is probably this key, mistyped.
fn near(key: &str, word: &str) -> bool {
    edits(key, &word.to_lowercase()) <= 1 + key.len() / 4
}

/// Number of letters to change, add or leave out to make one word of another.
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
