//! What was typed behind the name of the program. The process may be an interpreter, whose own arguments are others.

use std::ffi::OsString;
use std::sync::OnceLock;

static WORDS: OnceLock<Vec<OsString>> = OnceLock::new();

/// These were typed.
pub fn are(words: impl IntoIterator<Item = OsString>) {
    // A process runs one command: the first.
    let _ = WORDS.set(words.into_iter().collect());
}

/// What was typed.
pub fn typed() -> impl Iterator<Item = OsString> {
    WORDS.get().into_iter().flatten().cloned()
}

/// The same behind the name of the program.
pub fn whole() -> impl Iterator<Item = OsString> {
    std::iter::once("stiction".into()).chain(typed())
}
