//! A model file as text: every key asked for, and where each stands.

use super::fault;
use super::form::{ModelFile, ModelParameter, SCHEMA, SourceEntry, SourceInput};
use crate::config::{Given, Places, Source, Table};
use crate::error::Error;
use crate::hash::sha256_of;
use crate::result::CovarianceEntry;
use std::path::Path;

/// What a model file is, for messages.
pub(crate) const MODEL: &str = "a model file as an identification writes it";

/// What the text of a model is called in messages where it is in no file.
const IN_MEMORY: &str = "model";

/// A model with the text it was read from, for messages about its values.
pub struct ReadModel {
    /// The model.
    pub model: ModelFile,
    /// SHA-256 of the text, hexadecimal.
    pub sha256: String,
    places: Places,
}

impl ReadModel {
    /// Reads a model file from disk.
    ///
    /// # Errors
    /// As [`ModelFile::read`].
    pub fn read(file: impl AsRef<Path>) -> Result<Self, Error> {
        let file = file.as_ref();
        let text = crate::config::read(file, MODEL)?;
        Self::named(&text, file)
    }

    /// Reads the text of a model file.
    ///
    /// # Errors
    /// As [`ModelFile::parse`].
    pub fn parse(text: &str) -> Result<Self, Error> {
        Self::named(text, Path::new(IN_MEMORY))
    }

    /// A model in memory, checked by the same rules; messages have keys and no lines. The hash is that of the file
    /// that it would be written as.
    ///
    /// # Errors
    /// When its parameters do not fit its law.
    pub fn of(model: &ModelFile) -> Result<Self, Error> {
        Self::checked(
            model.clone(),
            model.to_toml().as_bytes(),
            Places::in_memory(IN_MEMORY),
        )
    }

    pub(crate) fn named(text: &str, file: &Path) -> Result<Self, Error> {
        let source = Source {
            file,
            text,
            page: "docs/result.md",
            swept: None,
        };
        let entries = source.parse()?;
        let model = model(&Table::root(source, &entries))?;
        Self::checked(model, text.as_bytes(), Places::of(&source, &entries))
    }

    fn checked(model: ModelFile, text: &[u8], places: Places) -> Result<Self, Error> {
        match fault::fault(&model).or_else(|| fault::top_speed(&model)) {
            Some((key, found, allowed)) => Err(places.refuse(&key, found, &allowed)),
            None => Ok(ReadModel {
                model,
                sha256: sha256_of(text),
                places,
            }),
        }
    }

    /// A value that cannot be used: its key, such as `law` or `parameter[2].value`, what was found, what is allowed.
    pub fn refuse(&self, key: &str, found: impl Into<String>, allowed: &str) -> Error {
        self.places.refuse(key, found.into(), allowed)
    }

    /// The same of a parameter by its name, or of all of them where the model has no such parameter.
    pub fn refuse_parameter(&self, name: &str, found: impl Into<String>, allowed: &str) -> Error {
        self.refuse(&self.value_key(name), found, allowed)
    }

    /// The file that it was read from; `model` where it was in memory.
    pub fn file(&self) -> &Path {
        self.places.file()
    }

    /// The place of a key or, where it is missing, of the table that lacks it, as errors begin:
    /// `line 4, column 7, law: `.
    pub fn place(&self, key: &str) -> String {
        self.places.place(key)
    }

    /// Where the value of a parameter stands, or all of them where the model has no such parameter, as errors begin:
    /// `line 28, column 9, parameter[2].value: `.
    pub fn place_of_parameter(&self, name: &str) -> String {
        self.places.place(&self.value_key(name))
    }

    fn value_key(&self, name: &str) -> String {
        let sided = format!("{name}_pos");
        let of = |name: &str| self.model.parameter.iter().position(|p| p.name == name);
        match of(name).or_else(|| of(&sided)) {
            Some(i) => format!("parameter[{}].value", i + 1),
            None => "parameter".into(),
        }
    }
}

fn model(root: &Table<'_>) -> Result<ModelFile, Error> {
    let schema = text(root, "schema", &format!("{SCHEMA:?}"))?;
    if schema != SCHEMA {
        let allowed = format!("this version reads {SCHEMA:?}");
        return Err(root.refuse("schema", format!("{schema:?}"), &allowed));
    }
    let source = root.table("source")?;
    let source = root.required("source", source, "a table [source]")?;
    let covariance = root.table("covariance")?;
    let covariance = root.required("covariance", covariance, "a table [covariance]")?;
    let parameters = list(root, "parameter", "tables [[parameter]]")?;
    let model = ModelFile {
        schema,
        name: root.text("name")?.map(str::to_string),
        kind: text(root, "kind", "\"linear\" or \"rotary\"")?,
        law: text(root, "law", "a law such as \"lugre\"")?,
        asymmetric: flag(root, "asymmetric")?,
        force_unit: text(root, "force_unit", "a unit such as \"N\"")?,
        trustworthy: flag(root, "trustworthy")?,
        source: self::source(&source)?,
        parameter: each(&parameters, parameter)?,
        covariance: self::covariance(&covariance)?,
    };
    root.end()?;
    Ok(model)
}

fn source(table: &Table<'_>) -> Result<SourceEntry, Error> {
    let seed = table.count("seed", 0, i64::MAX as u64)?;
    let inputs = list(table, "inputs", "a list of logs, which may be empty")?;
    let source = SourceEntry {
        version: text(table, "version", "the version that wrote the model")?,
        method: text(
            table,
            "method",
            "the method that found it, such as \"separable\"",
        )?,
        seed: table.required("seed", seed, "the seed of the search, such as 0")?,
        top_speed: table.get("top_speed").map(|x| number(&x)).transpose()?,
        inputs: each(&inputs, |table| {
            let input = SourceInput {
                path: text(table, "path", "the path of a log")?,
                sha256: text(table, "sha256", "the SHA-256 of the log")?,
            };
            table.end()?;
            Ok(input)
        })?,
    };
    table.end()?;
    Ok(source)
}

fn parameter(table: &Table<'_>) -> Result<ModelParameter, Error> {
    let value = table.required("value", table.get("value"), "a number in its unit")?;
    let parameter = ModelParameter {
        name: text(table, "name", "a parameter such as \"sigma0\"")?,
        symbol: text(table, "symbol", "a symbol such as \"σ₀\"")?,
        value: number(&value)?,
        unit: text(table, "unit", "a unit such as \"N/m\"")?,
        std: table.get("std").map(|x| number(&x)).transpose()?,
        ci95: table.get("ci95").map(|x| interval(&x)).transpose()?,
        interval: table.text("interval")?.map(str::to_string),
        identifiable: flag(table, "identifiable")?,
        origin: text(table, "origin", "\"identified\" or \"given\"")?,
    };
    table.end()?;
    Ok(parameter)
}

fn covariance(table: &Table<'_>) -> Result<CovarianceEntry, Error> {
    let names = list(table, "names", "a list of names, which may be empty")?;
    let rows = list(table, "matrix", "a row of numbers for each name")?;
    let names = names.iter().map(|name| Ok(name.text()?.to_string()));
    let rows = rows.iter().map(|row| {
        let numbers = row
            .as_list()
            .ok_or_else(|| row.refused("a row of numbers"))?;
        numbers.iter().map(number).collect()
    });
    let covariance = CovarianceEntry {
        names: names.collect::<Result<_, Error>>()?,
        matrix: rows.collect::<Result<_, Error>>()?,
    };
    table.end()?;
    Ok(covariance)
}

fn text(table: &Table<'_>, key: &'static str, example: &str) -> Result<String, Error> {
    let text = table.text(key)?.map(str::to_string);
    table.required(key, text, example)
}

fn flag(table: &Table<'_>, key: &'static str) -> Result<bool, Error> {
    let flag = table.flag(key)?;
    table.required(key, flag, "true or false")
}

/// Any number, also infinite or NaN: its range is checked later, together with the others.
fn number(given: &Given<'_>) -> Result<f64, Error> {
    given
        .as_number()
        .ok_or_else(|| given.refused("a number, without quotes"))
}

fn interval(given: &Given<'_>) -> Result<[f64; 2], Error> {
    match given.as_list().as_deref() {
        Some([low, high]) => Ok([number(low)?, number(high)?]),
        _ => Err(given.refused("two numbers in brackets, such as [-inf, 0.5]")),
    }
}

fn list<'a>(table: &Table<'a>, key: &'static str, what: &str) -> Result<Vec<Given<'a>>, Error> {
    let given = table.required(key, table.get(key), what)?;
    given.as_list().ok_or_else(|| given.refused(what))
}

fn each<'a, T>(
    list: &[Given<'a>],
    read: impl Fn(&Table<'a>) -> Result<T, Error>,
) -> Result<Vec<T>, Error> {
    let read = |given: &Given<'a>| {
        let table = given.as_table();
        read(&table.ok_or_else(|| given.refused("a table"))?)
    };
    list.iter().map(read).collect()
}

impl ModelFile {
    /// Reads a model file from disk.
    ///
    /// # Errors
    /// When the file cannot be read, or its text is no model of this schema.
    pub fn read(file: impl AsRef<Path>) -> Result<Self, Error> {
        Ok(ReadModel::read(file)?.model)
    }

    /// Reads the text of a model file.
    ///
    /// # Errors
    /// When the text is no model of this schema, or its parameters do not fit its law: their names, units and values.
    pub fn parse(text: &str) -> Result<Self, Error> {
        Ok(ReadModel::parse(text)?.model)
    }
}
