//! Standard output that may be closed at any time: `stiction .. | head` is no fault of anyone.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::{ErrorKind, Write};
use std::path::Path;
use stiction::Error;
use stiction::commands::FileError;
use stiction::commands::shell::stands_for;

/// Prints a text in which names from files may stand; a reader that has gone away has seen enough.
///
/// # Errors
/// Where the output cannot be written for another reason, such as a full disk behind it.
pub fn print(text: &str) -> Result<(), Error> {
    print_as_it_is(&plain(text))
}

/// Prints a text of our own, in which every character is meant.
///
/// # Errors
/// As [`print()`].
pub fn print_as_it_is(text: &str) -> Result<(), Error> {
    let mut out = std::io::stdout().lock();
    written(out.write_all(text.as_bytes()).and_then(|()| out.flush()))
}

/// Whether standard output took what was written.
///
/// # Errors
/// As [`print()`].
pub fn written(result: std::io::Result<()>) -> Result<(), Error> {
    match result {
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
    let mut text = serde_json::to_string_pretty(value).expect("plain data");
    text.push('\n');
    // Those that JSON does not escape itself; they stand within strings only.
    let text = escaped(&text, steers, |c, out| {
        let _ = write!(out, "\\u{:04x}", u32::from(c));
    });
    print_as_it_is(&text)
}

/// A text whose characters that would steer a terminal are written out, as `\u{1b}`; line feeds are kept.
pub fn plain(text: &str) -> Cow<'_, str> {
    let unseen = |c: char| steers(c) || stands_for(c).is_some();
    escaped(text, unseen, |c, out| match stands_for(c) {
        Some(byte) => {
            let _ = write!(out, "\\x{byte:02x}");
        }
        None => out.extend(c.escape_default()),
    })
}

/// The same on one line.
pub fn line(text: &str) -> String {
    plain(text).replace('\n', "\\n")
}

fn escaped(
    text: &str,
    steers: impl Fn(char) -> bool,
    escape: impl Fn(char, &mut String),
) -> Cow<'_, str> {
    if !text.contains(&steers) {
        return text.into();
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if steers(c) {
            escape(c, &mut out);
        } else {
            out.push(c);
        }
    }
    out.into()
}

/// Control characters but the line feed, and those that turn the direction of what follows.
fn steers(c: char) -> bool {
    (c.is_control() && c != '\n')
        || matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::{line, plain};

    #[test]
    fn what_steers_a_terminal_is_written_out() {
        assert_eq!(plain("σ₀ 1\n2"), "σ₀ 1\n2");
        assert_eq!(plain("a\u{1b}[31mb\r\t"), "a\\u{1b}[31mb\\r\\t");
        assert_eq!(plain("\u{9b}2J\u{202e}x"), "\\u{9b}2J\\u{202e}x");
        assert_eq!(line("a\nb"), "a\\nb");
        // A byte of a name that is not UTF-8.
        assert_eq!(plain("a\u{10ffff}"), "a\\xff");
    }
}
