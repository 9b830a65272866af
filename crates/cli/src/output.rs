//! Standard output that may be closed at any time: `stiction .. | head` is no fault of anyone.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::{ErrorKind, Write};
use std::path::Path;
use stiction_files::Error as FileError;
use stiction_files::shell::{is_unseen, stands_for};
use stiction_files::visible;
use stiction_workflows::Error;

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
    print_as_it_is(&json_text(value))
}

fn json_text(value: &impl serde::Serialize) -> String {
    let mut text = serde_json::to_string_pretty(value).expect("plain data");
    text.push('\n');
    visible::json(text)
}

/// A text whose characters that would steer a terminal are written out, as `\u{1b}`; line feeds are kept.
pub fn plain(text: &str) -> Cow<'_, str> {
    escaped(text, steers, |c, out| match stands_for(c) {
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

/// Writes lines to standard error, each behind the name of the program.
pub fn complain(lines: &str) {
    for said in lines.lines() {
        // With standard error closed there is nowhere to say it.
        let _ = writeln!(std::io::stderr(), "stiction: {}", line(said));
    }
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

/// What a terminal does not show as it is, but the line feed.
fn steers(c: char) -> bool {
    c != '\n' && is_unseen(c)
}

#[cfg(test)]
mod tests {
    use super::{line, plain, steers};
    use proptest::prelude::*;

    /// Texts as a hostile file has them: mostly what steers a terminal.
    fn hostile() -> impl Strategy<Value = String> {
        let c = prop_oneof![
            any::<char>(),
            Just('\u{1b}'),
            Just('\n'),
            (0u32..0x20).prop_map(|c| char::from_u32(c).unwrap()),
            (0x7fu32..0xa0).prop_map(|c| char::from_u32(c).unwrap()),
            (0x2000u32..0x2070).prop_map(|c| char::from_u32(c).unwrap()),
            (0x10_ff70u32..=0x10_ffff).prop_map(|c| char::from_u32(c).unwrap()),
            prop::sample::select(
                "\u{ad}\u{61c}\u{180e}\u{feff}\u{e0041}]0;\\[31m"
                    .chars()
                    .collect::<Vec<_>>()
            ),
        ];
        prop::collection::vec(c, 0..40).prop_map(String::from_iter)
    }

    proptest! {
        #[test]
        fn nothing_that_steers_a_terminal_is_printed(text in hostile()) {
            prop_assert!(!plain(&text).contains(steers));
            prop_assert!(!line(&text).contains(|c| steers(c) || c == '\n'));
            // What a terminal shows as it is stays as it is, and once is enough.
            let clean: String = text.chars().filter(|c| !steers(*c)).collect();
            prop_assert_eq!(plain(&clean), clean.as_str());
            let once = plain(&text);
            prop_assert_eq!(plain(&once), once.as_ref());
        }

        #[test]
        fn json_keeps_what_it_escapes(text in hostile()) {
            let printed = super::json_text(&text);
            prop_assert!(!printed.contains(steers));
            prop_assert_eq!(serde_json::from_str::<String>(&printed).unwrap(), text);
        }
    }

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
