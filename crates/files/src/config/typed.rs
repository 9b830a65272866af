//! A file that a user types: read whole, within bounds.

use super::form::{self, Form};
use crate::error::Error;
use crate::output::whole;
use std::path::Path;
use stiction_formats::{Irregular, regular};

/// Largest file that is read, bytes.
pub(super) const MAX_BYTES: u64 = 1 << 20;

/// Why a file has no text to be read.
pub(super) enum NotRead {
    /// What was found, and what is allowed.
    Faulty(String, String),
    /// It is something else than a file to type.
    Other(Error),
}

/// The text of a file, with the form that it is to have.
pub(crate) fn read(file: &Path, form: Form) -> Result<String, Error> {
    text(file, form).map_err(|refused| match refused {
        NotRead::Other(error) => error,
        NotRead::Faulty(found, allowed) => Error::Config {
            file: file.to_path_buf(),
            place: String::new(),
            found,
            allowed,
        },
    })
}

/// The same, with what is wrong apart from the file.
pub(super) fn text(file: &Path, form: Form) -> Result<String, NotRead> {
    let what = form.what();
    let unreadable = |e: std::io::Error| {
        let found = format!("cannot be read ({e})");
        NotRead::Faulty(found, format!("give the path of {what}"))
    };
    // It may be one of several files that were about to be replaced together.
    let content = whole(file).map_err(|e| {
        let allowed =
            format!("{what} in a folder without such a record, or a copy of it elsewhere");
        NotRead::Faulty(e.to_string(), allowed)
    })?;
    let other = || form::of_file(file).map(|found| NotRead::Other(form.instead_of(file, found)));
    let found = match regular(&content) {
        Ok(about) if about.len() <= MAX_BYTES => None,
        Ok(about) => Some(format!("{} bytes", about.len())),
        Err(Irregular::Io(e)) => return Err(unreadable(e)),
        Err(Irregular::Other(what)) => Some(what.into()),
    };
    if let Some(found) = found {
        let allowed = format!("{what} is a text file of at most 1 MiB");
        return Err(other().unwrap_or(NotRead::Faulty(found, allowed)));
    }
    let bytes = std::fs::read(&content).map_err(unreadable)?;
    if stiction_formats::is_binary_recording(&content) {
        return Err(other().unwrap_or(NotRead::Faulty("a recording".into(), what.into())));
    }
    String::from_utf8(bytes)
        .map_err(|_| NotRead::Faulty("is not UTF-8 text".into(), "save it as UTF-8".into()))
}
