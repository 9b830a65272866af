//! Names of keys in messages.

/// A key shortened to fit on one line of a message.
pub(super) fn cut(name: &str) -> String {
    let name = name.escape_debug().to_string();
    match name.char_indices().nth(60) {
        Some((end, _)) => format!("{}...", &name[..end]),
        None => name,
    }
}
