//! Standard output that may be closed at any time: `stiction .. | head` is no fault of anyone.

use std::io::{ErrorKind, Write};
use std::path::Path;
use stiction::Error;
use stiction::commands::FileError;

/// Prints a text as it is; a reader that has gone away has seen enough.
///
/// # Errors
/// Where the output cannot be written for another reason, such as a full disk behind it.
pub fn print(text: &str) -> Result<(), Error> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => {
            Err(FileError::output(Path::new("standard output"), e.to_string()).into())
        }
        _ => Ok(()),
    }
}

/// Prints one JSON value and a line feed.
///
/// # Errors
/// As [`print()`].
pub fn json(value: &impl serde::Serialize) -> Result<(), Error> {
    let text = serde_json::to_string_pretty(value).expect("plain data");
    print(&(text + "\n"))
}
