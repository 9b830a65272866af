//! Errors of the library as exceptions with code, place, found and allowed.

use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;
use stiction_files::{Error as FileError, Warning};
use stiction_workflows::{Error, Parts, Setting};

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
    let Parts {
        place,
        found,
        allowed,
    } = error.parts(argument);
    let allowed = match error {
        Error::File(FileError::TooLarge { needed, .. }) => {
            format!("less, or max_samples={needed}")
        }
        Error::File(FileError::Taken { .. }) => {
            "another folder, or force=True to write into it all the same".into()
        }
        _ => allowed,
    };
    Refusal {
        code,
        place,
        found,
        allowed,
    }
    .raise(py)
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
