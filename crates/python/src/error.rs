//! Errors of the library as exceptions with code, place, found and allowed.

use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;
use stiction::commands::{FileError, Setting};
use stiction::{Error, Warning};

static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();

/// What an exception is made of.
pub struct Refusal {
    code: String,
    place: String,
    found: String,
    allowed: String,
}

impl Refusal {
    /// An argument that cannot be taken: its name, what was found, what is allowed.
    pub fn argument(place: &str, found: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self {
            code: "usage".into(),
            place: place.into(),
            found: found.into(),
            allowed: allowed.into(),
        }
    }

    /// The exception `stiction.StictionError`.
    pub fn raise(self, py: Python<'_>) -> PyErr {
        let class = match CLASS.import(py, "stiction._errors", "StictionError") {
            Ok(class) => class,
            Err(error) => return error,
        };
        match class.call1((self.code, self.place, self.found, self.allowed)) {
            Ok(value) => PyErr::from_value(value),
            Err(error) => error,
        }
    }
}

/// An error of the library as the exception `stiction.StictionError`.
pub fn raised(py: Python<'_>, error: &Error) -> PyErr {
    let code = error.code().to_string();
    let (place, found, allowed) = parts(error);
    Refusal {
        code,
        place,
        found,
        allowed,
    }
    .raise(py)
}

/// Place, found and allowed.
fn parts(error: &Error) -> (String, String, String) {
    match error {
        Error::File(error) => of_file(error),
        Error::Identify { inputs, .. } => {
            let said = error.to_string();
            let rest = said.strip_prefix(inputs.as_str());
            let rest = rest.and_then(|rest| rest.strip_prefix(": "));
            let (found, allowed) = halves(rest.unwrap_or(&said));
            (inputs.clone(), found, allowed)
        }
        Error::Checkpoint {
            file,
            found,
            allowed,
        } => (
            file.display().to_string(),
            found.clone(),
            allowed.named(argument),
        ),
        Error::ExportModel {
            file,
            place,
            source,
        } => {
            let (found, allowed) = halves(&source.to_string());
            (at(&file.display().to_string(), place), found, allowed)
        }
        Error::NotFed { found, instead } => (
            "feedforward".into(),
            found.clone(),
            format!("it can feed forward: {}", instead.join(", ")),
        ),
        Error::Usage { found, allowed } => (
            String::new(),
            found.named(argument),
            allowed.named(argument),
        ),
        error => {
            let (found, allowed) = halves(&error.to_string());
            (String::new(), found, allowed)
        }
    }
}

fn of_file(error: &FileError) -> (String, String, String) {
    match error {
        FileError::Log(e) => {
            let file = e.file.as_ref().map(|file| file.display().to_string());
            let place = at(&file.unwrap_or_default(), &e.place.to_string());
            (place, e.found.clone(), e.allowed.clone())
        }
        FileError::Config {
            file,
            place,
            found,
            allowed,
        }
        | FileError::Misfit {
            file,
            place,
            found,
            allowed,
            ..
        } => (
            at(&file.display().to_string(), place),
            found.clone(),
            allowed.clone(),
        ),
        FileError::OtherForm {
            file,
            found,
            wanted,
            instead,
        } => {
            let instead = instead.as_ref().map(|path| format!(": {}", path.display()));
            (
                file.display().to_string(),
                format!("is {found}"),
                format!("{wanted} is wanted{}", instead.unwrap_or_default()),
            )
        }
        FileError::TooLarge {
            what,
            found,
            needed,
            ..
        } => (
            what.clone(),
            found.clone(),
            format!("less, or max_samples={needed}"),
        ),
        FileError::Output { path, reason, .. } => {
            (path.display().to_string(), reason.clone(), String::new())
        }
        FileError::Taken { path, found, .. } => (
            path.display().to_string(),
            found.clone().into_owned(),
            "another folder, or force=True to write into it all the same".into(),
        ),
        error => {
            let (found, allowed) = halves(&error.to_string());
            (String::new(), found, allowed)
        }
    }
}

/// A file and the place in it.
fn at(file: &str, place: &str) -> String {
    let place = place.trim_end_matches(": ");
    match (file.is_empty(), place.is_empty()) {
        (_, true) => file.into(),
        (true, false) => place.into(),
        (false, false) => format!("{file}: {place}"),
    }
}

/// A message of the form `found; allowed`.
fn halves(message: &str) -> (String, String) {
    match message.split_once("; ") {
        Some((found, allowed)) => (found.into(), allowed.into()),
        None => (message.into(), String::new()),
    }
}

/// An option as an argument of a call: `law="lugre"`, `search=Search(evaluations=0)`; without a value by its name.
fn argument(setting: Setting, value: Option<&str>) -> String {
    let (group, name) = match setting {
        Setting::Statics | Setting::Model | Setting::BreakAway => ("procedures", setting.field()),
        Setting::Search => ("search", "name"),
        Setting::NoFinish
        | Setting::Cost
        | Setting::Evaluations
        | Setting::Target
        | Setting::Time
        | Setting::Checkpoint
        | Setting::Resume => ("search", setting.field()),
        Setting::Adapt => ("compensator", setting.field()),
        Setting::Want => ("", "wants"),
        _ => ("", setting.field()),
    };
    let is_flag = matches!(
        setting,
        Setting::Asymmetric | Setting::NoFinish | Setting::Adapt
    );
    let value = match value {
        Some(value) if value.parse::<f64>().is_ok() => value.into(),
        Some(value) => format!("{value:?}"),
        None if is_flag => "True".into(),
        None if group.is_empty() => return name.into(),
        None => return format!("{group}.{name}"),
    };
    match group {
        "" => format!("{name}={value}"),
        group => format!("{group}={}({name}={value})", class(group)),
    }
}

/// The class of a group of arguments.
fn class(group: &str) -> &'static str {
    match group {
        "procedures" => "Procedures",
        "search" => "Search",
        _ => "Compensator",
    }
}

/// Warnings with their options as arguments of a call.
pub fn spoken(warnings: &mut [Warning]) {
    for warning in warnings {
        if let Some(named) = warning.kind().map(|kind| kind.named(option)) {
            warning.message = named;
        }
    }
}

/// An option of an export by its name on the command line, as an argument of a call.
fn option(name: &str, value: &str) -> String {
    let name = name.replace('-', "_");
    match value.parse::<f64>() {
        Ok(_) => format!("{name}={value}"),
        Err(_) => {
            let values: Vec<&str> = value.split(',').collect();
            format!("{name}={values:?}")
        }
    }
}
