//! Names of keys in messages.

/// A key of a message is not longer than a line.
pub(super) fn cut(name: &str) -> String {
    let name = name.escape_debug().to_string();
    match name.char_indices().nth(60) {
        Some((end, _)) => format!("{}...", &name[..end]),
        None => name,
    }
}
