//! What goes wrong, with a stable code.

use std::fmt;
use std::path::Path;
use stiction_codes::Code;
use stiction_parameters::LawError;
use stiction_workflows::identify::Method;
use stiction_workflows::{Error as Failure, Parts, Setting};

/// An input that is refused or work that could not be done: where, what was found, what is allowed. A result that should not be
/// trusted is no error.
#[derive(Debug)]
pub struct Error(Box<Inner>);

#[derive(Debug)]
struct Inner {
    cause: Cause,
    parts: Parts,
}

#[derive(Debug)]
enum Cause {
    Work(Failure),
    Law(LawError),
}

/// An option as the method of a builder that sets it.
fn option(setting: Setting, value: Option<&str>) -> String {
    let name = match setting {
        Setting::Adapt => "adapting",
        Setting::NoFinish => "without_least_squares",
        _ => setting.field(),
    };
    match value {
        // A search over whole records is no method of its own here.
        Some(search) if setting == Setting::Method && Method::SEARCHES.contains(&search) => {
            format!("method = separable with search = {search}")
        }
        Some(value) => format!("{name} = {value}"),
        None => name.into(),
    }
}

impl Error {
    /// An error of the engine in the words of this interface.
    pub(crate) fn of(error: impl Into<Failure>) -> Self {
        let error = error.into();
        let parts = error.parts(option);
        let cause = Cause::Work(error);
        Self(Box::new(Inner { cause, parts }))
    }

    /// Numbers that make no law.
    pub(crate) fn of_law(error: LawError) -> Self {
        let parts = Parts {
            found: error.to_string(),
            ..Parts::default()
        };
        let cause = Cause::Law(error);
        Self(Box::new(Inner { cause, parts }))
    }

    /// Stable code; each has a page in `docs/codes/`.
    pub fn code(&self) -> Code {
        match &self.0.cause {
            Cause::Work(error) => error.code(),
            Cause::Law(_) => Code::Usage,
        }
    }

    /// File, line and key, or the option; empty where it is of no place.
    pub fn place(&self) -> &str {
        &self.0.parts.place
    }

    /// What was found.
    pub fn found(&self) -> &str {
        &self.0.parts.found
    }

    /// What is allowed, or leads on; empty where nothing is known of that.
    pub fn allowed(&self) -> &str {
        &self.0.parts.allowed
    }

    /// A name that is none of those that there are.
    pub(crate) fn unknown(what: &str, name: &str, allowed: &[&str]) -> Self {
        let found = format!("{what} = {name:?}");
        let allowed = format!("one of {}", allowed.join(", "));
        let (found, allowed) = (found.into(), allowed.into());
        Self::of(Failure::Usage { found, allowed })
    }

    /// The axis, model, robot or study files that have to be corrected, each with its line where one is known, counted from 1.
    pub fn to_correct(&self) -> Vec<(&Path, Option<usize>)> {
        match &self.0.cause {
            Cause::Work(Failure::File(error)) => error.to_correct(),
            _ => Vec::new(),
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0.cause {
            Cause::Work(error) => f.write_str(&error.named(option)),
            Cause::Law(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for Error {}
