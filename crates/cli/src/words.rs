//! What was typed behind the name of the program. The process may be an interpreter, whose own arguments are others.

use std::ffi::OsString;
use std::sync::{PoisonError, RwLock};

static WORDS: RwLock<Vec<OsString>> = RwLock::new(Vec::new());

/// These were typed.
pub fn are(words: impl IntoIterator<Item = OsString>) {
    *WORDS.write().unwrap_or_else(PoisonError::into_inner) = words.into_iter().collect();
}

/// What was typed.
pub fn typed() -> impl Iterator<Item = OsString> {
    let words = WORDS.read().unwrap_or_else(PoisonError::into_inner);
    words.clone().into_iter()
}

/// The same behind the name of the program.
pub fn whole() -> impl Iterator<Item = OsString> {
    std::iter::once("stiction".into()).chain(typed())
}
