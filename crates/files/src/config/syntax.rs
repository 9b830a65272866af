//! What the TOML reader refused, as place, found and allowed.

use super::source::Source;
use crate::error::Error;

/// The error of a text that is not TOML.
pub(super) fn refusal(source: &Source<'_>, error: &toml::de::Error) -> Error {
    let message = error.message().trim().replace('\n', " ");
    let place = match error.span() {
        Some(span) => format!("{}: ", source.at(span.start)),
        None => String::new(),
    };
    // Only the word `expected` parts what was found from what is allowed.
    let (found, allowed) = match message.split_once(", expected ") {
        Some((found, expected)) => (found.to_string(), expected.to_string()),
        None => (message, format!("see {} for every key", source.page)),
    };
    source.error(place, found, &allowed)
}
