//! An error in parts: where, what was found, what is allowed.

use super::Error;
use crate::wording::{Setting, Wording};
use stiction_files::Error as FileError;

/// An error in parts, as a caller that shows them apart wants them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Parts {
    /// File, line and key, or the option; empty where it is of no place.
    pub place: String,
    /// What was found.
    pub found: String,
    /// What is allowed, or leads on; empty where nothing is known of that.
    pub allowed: String,
}

impl Error {
    /// Its message, with options as `name` writes them.
    pub fn named(&self, name: impl Fn(Setting, Option<&str>) -> String) -> String {
        match self {
            Error::Usage { found, allowed } => {
                format!("{}; {}", found.named(&name), allowed.named(&name))
            }
            Error::Checkpoint {
                file,
                found,
                allowed,
            } => format!("{}: {found}; {}", file.display(), allowed.named(&name)),
            _ => self.to_string(),
        }
    }

    /// Its parts, with options as `name` writes them.
    pub fn parts(&self, name: impl Fn(Setting, Option<&str>) -> String) -> Parts {
        let (place, found, allowed) = of(self, &name);
        Parts {
            place,
            found,
            allowed,
        }
    }
}

/// Place, found and allowed.
fn of(error: &Error, name: &dyn Fn(Setting, Option<&str>) -> String) -> (String, String, String) {
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
            allowed.named(name),
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
        Error::Usage { found, allowed } => {
            (place(found, name), found.named(name), allowed.named(name))
        }
        error => {
            let (found, allowed) = halves(&error.to_string());
            (String::new(), found, allowed)
        }
    }
}

/// The option that is wrong by itself: of several that do not go together none is.
fn place(found: &Wording, name: &dyn Fn(Setting, Option<&str>) -> String) -> String {
    let mut settings = found.settings();
    match (settings.next(), settings.next()) {
        (Some(setting), None) => name(setting, None),
        _ => String::new(),
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
            allowed,
        } => (
            what.clone(),
            found.clone(),
            format!("at most {allowed} samples, unless {needed} are allowed"),
        ),
        FileError::Output { path, reason, .. } => {
            (path.display().to_string(), reason.clone(), String::new())
        }
        FileError::Taken { path, found, .. } => (
            path.display().to_string(),
            found.clone().into_owned(),
            "another folder".into(),
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
