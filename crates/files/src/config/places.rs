//! Where every value of a file stands, for what is found wrong after the file was read.

use super::form::Form;
use super::source::Source;
use crate::error::Error;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::de::{DeTable, DeValue};

/// The places of a file by their keys, such as `parameter[3].unit`, counted from 1.
#[derive(Clone, Debug, Default)]
pub(crate) struct Places {
    file: PathBuf,
    form: Form,
    /// The table that stands for `[columns]`, such as `joint.elbow`; `None` for that itself.
    columns: Option<String>,
    /// The text and where in it each key stands; `None` for values that are in no file.
    text: Option<(String, BTreeMap<String, usize>)>,
}

impl Places {
    /// Values that are in no file: their keys are all that is known. `name` stands for the file in messages.
    pub fn in_memory(name: &str, form: Form) -> Self {
        Places {
            file: name.into(),
            form,
            columns: None,
            text: None,
        }
    }

    /// All places of a file.
    pub fn of(source: &Source<'_>, entries: &DeTable<'_>) -> Self {
        let mut bytes = BTreeMap::new();
        table(entries, "", &mut bytes);
        Places {
            file: source.file.to_path_buf(),
            form: source.form,
            columns: None,
            text: Some((source.text.into(), bytes)),
        }
    }

    /// The file, or what stands for it in messages.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// The same places for one of several axes, whose columns and encoder step stand in a table of their own.
    pub fn with_columns_in(&self, table: String) -> Self {
        Places {
            columns: Some(table),
            ..self.clone()
        }
    }

    /// The table that has the columns.
    pub fn columns(&self) -> &str {
        self.columns.as_deref().unwrap_or("columns")
    }

    /// A key as this file has it.
    fn own<'a>(&self, key: &'a str) -> Cow<'a, str> {
        let Some(table) = &self.columns else {
            return key.into();
        };
        let parts = ["columns.", "log.resolution", "log.wrap", "log.force_limit"];
        let is_own = parts.iter().any(|part| key.starts_with(part))
            && !key.starts_with("columns.time")
            && !key.starts_with("columns.enable");
        match key.split_once('.') {
            Some((_, rest)) if is_own => format!("{table}.{rest}").into(),
            _ => key.into(),
        }
    }

    /// Whether the file gives a key.
    pub fn has(&self, key: &str) -> bool {
        let key = &*self.own(key);
        let bytes = self.text.as_ref().map(|(_, bytes)| bytes);
        bytes.is_some_and(|bytes| bytes.contains_key(key))
    }

    /// An error at a key or, where it is missing, at the start of the table (or file) that lacks it.
    pub fn refuse(&self, key: &str, found: String, allowed: &str) -> Error {
        self.source().error(self.place(key), found, allowed)
    }

    /// The place of a key or, where it is missing, of the table (or file) that lacks it, as errors begin:
    /// `line 3, column 8, mass: `.
    pub fn place(&self, key: &str) -> String {
        let key = &*self.own(key);
        let Some((_, bytes)) = &self.text else {
            return format!("{key}: ");
        };
        let mut known = key;
        loop {
            if let Some(&byte) = bytes.get(known) {
                return format!("{}, {key}: ", self.source().at(byte));
            }
            match known.rfind(['.', '[']) {
                Some(end) => known = &known[..end],
                None => return format!("{}, {key}: ", self.source().at(0)),
            }
        }
    }

    fn source(&self) -> Source<'_> {
        Source {
            file: &self.file,
            text: self.text.as_ref().map_or("", |(text, _)| text.as_str()),
            form: self.form,
            swept: None,
        }
    }
}

fn table(entries: &DeTable<'_>, prefix: &str, out: &mut BTreeMap<String, usize>) {
    for (name, given) in entries.iter() {
        let key = format!("{prefix}{}", name.get_ref());
        out.insert(key.clone(), given.span().start);
        value(given.get_ref(), &key, out);
    }
}

fn value(found: &DeValue<'_>, key: &str, out: &mut BTreeMap<String, usize>) {
    match found {
        DeValue::Table(entries) => table(entries, &format!("{key}."), out),
        DeValue::Array(list) => {
            for (i, entry) in list.iter().enumerate() {
                let key = format!("{key}[{}]", i + 1);
                out.insert(key.clone(), entry.span().start);
                value(entry.get_ref(), &key, out);
            }
        }
        _ => {}
    }
}
