//! A file that a user types: read whole, within bounds.

use crate::error::Error;
use crate::output::settle;
use std::path::Path;

/// Largest file that is read, bytes.
const MAX_BYTES: u64 = 1 << 20;

/// The text of a file; `what` it is to be, such as "an axis file", is for messages.
pub(crate) fn read(file: &Path, what: &str) -> Result<String, Error> {
    text(file, what).map_err(|(found, allowed)| Error::Config {
        file: file.to_path_buf(),
        place: String::new(),
        found,
        allowed,
    })
}

/// The same; `Err` has what was found, and what is allowed.
pub(super) fn text(file: &Path, what: &str) -> Result<String, (String, String)> {
    let unreadable = |e: std::io::Error| {
        let found = format!("cannot be read ({e})");
        (found, format!("give the path of {what}"))
    };
    // It may be one of several files that were about to be replaced together.
    if let Some(dir) = file.parent() {
        let whole = format!("{what} in a folder that can be completed, or a copy of it elsewhere");
        settle(dir).map_err(|e| (e.to_string(), whole))?;
    }
    let meta = std::fs::metadata(file).map_err(unreadable)?;
    if !meta.is_file() || meta.len() > MAX_BYTES {
        let found = if meta.is_file() {
            format!("{} bytes", meta.len())
        } else {
            "not a file".into()
        };
        let allowed = format!("{what} is a text file of at most 1 MiB");
        return Err((found, allowed));
    }
    let bytes = std::fs::read(file).map_err(unreadable)?;
    String::from_utf8(bytes).map_err(|_| ("is not UTF-8 text".into(), "save it as UTF-8".into()))
}
