//! Texts that go into files, with what no editor shows written out: names from recordings may hold marks that turn the text
//! around them, or characters of no width.

use crate::shell::is_unseen;
use std::fmt::Write;

/// JSON whose texts have what is not seen as `\u202e`. Outside of texts JSON has nothing that is not seen but white space.
pub fn json(text: String) -> String {
    written_out(text, |c, out| {
        let mut units = [0; 2];
        for unit in c.encode_utf16(&mut units) {
            let _ = write!(out, "\\u{unit:04x}");
        }
    })
}

/// TOML whose texts have what is not seen as `\u202e`: one in single quotes, where that would stand for itself, becomes one in
/// double quotes. In comments it stands for itself.
pub fn toml(text: String) -> String {
    if !text.contains(is_hidden) {
        return text;
    }
    let mut out = String::with_capacity(text.len() + 64);
    let mut rest = text.as_str();
    while let Some(c) = rest.chars().next() {
        let (token, is_text) = match c {
            '#' => (rest.find('\n').unwrap_or(rest.len()), true),
            '\'' | '"' => (length_of_text(rest), true),
            // Such as the mark at the beginning of a file.
            _ => (c.len_utf8(), false),
        };
        let (token, after) = rest.split_at(token);
        rest = after;
        if !is_text || !token.contains(is_hidden) {
            out.push_str(token);
        } else if let Some(plain) = inside(token, "'''").or_else(|| inside(token, "'")) {
            out.push('"');
            plain.chars().for_each(|c| in_double_quotes(c, &mut out));
            out.push('"');
        } else {
            // In double quotes what is escaped already stays so.
            token.chars().for_each(|c| match is_hidden(c) {
                true => in_double_quotes(c, &mut out),
                false => out.push(c),
            });
        }
    }
    out
}

/// Whether a character is to be written out; line feeds and tabs are the form of a file.
fn is_hidden(c: char) -> bool {
    is_unseen(c) && !matches!(c, '\n' | '\r' | '\t')
}

fn written_out(text: String, escape: impl Fn(char, &mut String)) -> String {
    if !text.contains(is_hidden) {
        return text;
    }
    let mut out = String::with_capacity(text.len() + 64);
    for c in text.chars() {
        match is_hidden(c) {
            true => escape(c, &mut out),
            false => out.push(c),
        }
    }
    out
}

/// How long the text is that begins with a quotation mark, with its marks.
fn length_of_text(rest: &str) -> usize {
    let mark = &rest[..1];
    let long = mark.repeat(3);
    let (open, escapes) = match rest.starts_with(&long) {
        true => (long.as_str(), mark == "\""),
        false => (mark, mark == "\""),
    };
    let mut at = open.len();
    while at < rest.len() {
        let tail = &rest[at..];
        if escapes && tail.starts_with('\\') {
            at += 1 + tail[1..].chars().next().map_or(0, char::len_utf8);
        } else if tail.starts_with(open) {
            at += open.len();
            // Up to two marks may stand before the three that end it.
            let more = rest[at..].bytes().take_while(|b| *b == mark.as_bytes()[0]);
            return at
                + if open.len() == 3 {
                    more.count().min(2)
                } else {
                    0
                };
        } else {
            at += tail.chars().next().map_or(1, char::len_utf8);
        }
    }
    rest.len()
}

/// What a text in such marks says; a line feed right after three marks does not count.
fn inside<'a>(token: &'a str, mark: &str) -> Option<&'a str> {
    let long = token.strip_prefix(mark)?.strip_suffix(mark)?;
    match mark.len() {
        3 => Some(long.strip_prefix('\n').unwrap_or(long)),
        _ => Some(long),
    }
}

/// A character as it stands in a text in double quotes on one line.
fn in_double_quotes(c: char, out: &mut String) {
    let code = u32::from(c);
    let _ = match c {
        '"' | '\\' => write!(out, "\\{c}"),
        '\n' => write!(out, "\\n"),
        '\t' => write!(out, "\\t"),
        '\r' => write!(out, "\\r"),
        c if is_hidden(c) && code > 0xffff => write!(out, "\\U{code:08x}"),
        c if is_hidden(c) => write!(out, "\\u{code:04x}"),
        c => write!(out, "{c}"),
    };
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[derive(Debug, PartialEq, serde::Serialize, serde::Deserialize)]
    struct Named {
        name: String,
        others: Vec<String>,
    }

    fn hostile() -> impl Strategy<Value = String> {
        let c = prop_oneof![
            any::<char>(),
            prop::sample::select(
                "\u{202e}\u{2066}\u{200b}\u{feff}\u{e0041}\u{10ff80}\u{1b}\u{7f}\u{9b}\n\r\t\"\"'''\\#a ="
                    .chars()
                    .collect::<Vec<_>>()
            ),
        ];
        prop::collection::vec(c, 0..12).prop_map(String::from_iter)
    }

    proptest! {
        #[test]
        fn toml_says_the_same_and_shows_all_of_it(name in hostile(), others in prop::collection::vec(hostile(), 0..3)) {
            let named = Named { name, others };
            let text = toml::to_string(&named).unwrap();
            let comment = named.name.replace(['\n', '\r'], " ");
            let comment: String = comment.chars().filter(|c| !c.is_control()).collect();
            let text = toml(format!("# {comment} ' \"\n{text}"));
            prop_assert!(!text.contains(is_hidden), "{text:?}");
            prop_assert_eq!(toml::from_str::<Named>(&text).unwrap(), named, "{}", text);
        }
    }

    #[test]
    fn marks_are_written_out() {
        assert_eq!(
            toml("a = 'x\u{202e}\"\\'\nb = \"\\\"\u{200b}\" # \u{202e}\n".into()),
            "a = \"x\\u202e\\\"\\\\\"\nb = \"\\\"\\u200b\" # \\u202e\n"
        );
        assert_eq!(
            json("{\"a\": \"\u{202e}\u{e0041}\"}\n".into()),
            "{\"a\": \"\\u202e\\udb40\\udc41\"}\n"
        );
    }
}
