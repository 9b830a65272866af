//! What the TOML reader refused, as place, found and allowed.

use super::name::cut;
use super::source::Source;
use crate::error::Error;

/// The error of a text that is not TOML.
pub(super) fn refusal(source: &Source<'_>, error: &toml::de::Error) -> Error {
    let message = error.message().trim().replace('\n', " ");
    // The reader gives no place where tables and lists are nested too deep.
    let span = error.span().unwrap_or_else(|| {
        let deepest = deepest(source.text);
        deepest..deepest
    });
    let at = source.at(span.start);
    if message == "duplicate key" {
        let key = source.text.get(span).unwrap_or_default();
        let place = format!("{at}, {}: ", cut(key.trim()));
        return source.error(place, "is given a second time".into(), "each key once");
    }
    if message.contains("recurs") {
        let found = "tables and lists too deep in each other".into();
        return source.error(format!("{at}: "), found, "at most a few levels");
    }
    // Only the word `expected` separates what was found from what is allowed.
    let (found, allowed) = match message.split_once(", expected ") {
        Some((found, expected)) => (found.to_string(), expected.to_string()),
        None => (message, format!("see {} for every key", source.form.page())),
    };
    source.error(format!("{at}: "), found, &allowed)
}

/// Byte at which brackets and dotted keys first reach their deepest nesting; brackets within quotes do not count.
fn deepest(text: &str) -> usize {
    let (mut brackets, mut dots, mut quote) = (0_usize, 0_usize, None);
    let (mut deepest, mut place) = (0, 0);
    for (byte, c) in text.char_indices() {
        match (quote, c) {
            (Some(open), _) if c == open || c == '\n' => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            (None, '[' | '{') => brackets += 1,
            (None, ']' | '}') => brackets = brackets.saturating_sub(1),
            (None, '.') => dots += 1,
            (None, '\n' | '=' | ',') => dots = 0,
            _ => {}
        }
        if brackets + dots > deepest {
            (deepest, place) = (brackets + dots, byte);
        }
    }
    place
}
