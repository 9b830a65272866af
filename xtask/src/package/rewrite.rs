//! Source of a crate as that of a module: its paths, and nothing in its strings and comments.

/// Where names of crates lead in the package.
pub struct Paths<'a> {
    /// The module that this source is, such as `internal::log`; empty where it is the crate itself.
    pub own: &'a str,
    /// The path of a crate of the workspace by its name with underscores, where it is no crate there.
    pub of: &'a dyn Fn(&str) -> Option<String>,
}

/// The source with its paths as they are in the package.
pub fn rewritten(source: &str, paths: &Paths) -> String {
    let mut out = String::with_capacity(source.len() + source.len() / 50);
    let mut fence = false;
    let mut rest = source;
    while let Some(first) = rest.chars().next() {
        let (piece, text) = match token(rest) {
            Token::Doc(length) => (length, doc(&rest[..length], paths, &mut fence)),
            Token::Text(length) => (length, text(&rest[..length], paths)),
            Token::Kept(length) => (length, rest[..length].to_owned()),
            Token::Word(length) => {
                let after = &rest[length..];
                (length, word(&rest[..length], after, paths))
            }
            Token::Other => (first.len_utf8(), first.to_string()),
        };
        out.push_str(&text);
        rest = &rest[piece..];
    }
    out
}

/// What source begins with, and its length in bytes.
enum Token {
    /// A line of documentation.
    Doc(usize),
    /// A string with its quotes.
    Text(usize),
    /// A comment, or a character in quotes.
    Kept(usize),
    /// A name or number.
    Word(usize),
    Other,
}

fn token(source: &str) -> Token {
    let bytes = source.as_bytes();
    let line = || source.find('\n').unwrap_or(source.len());
    match bytes {
        [b'/', b'/', b'!' | b'/', ..] => Token::Doc(line()),
        [b'/', b'/', ..] => Token::Kept(line()),
        [b'/', b'*', ..] => Token::Kept(source.find("*/").map_or(source.len(), |at| at + 2)),
        [b'"', ..] => Token::Text(quoted(bytes, b'"')),
        [b'\'', b'\\', ..] => Token::Kept(quoted(bytes, b'\'')),
        [b'\'', ..] => {
            // A lifetime has no quote behind its first letter.
            let letter = source[1..].chars().next().map_or(0, char::len_utf8);
            match bytes.get(1 + letter) {
                Some(b'\'') => Token::Kept(letter + 2),
                _ => Token::Other,
            }
        }
        [b'r', b'"' | b'#', ..] | [b'b', b'r', b'"' | b'#', ..] => match raw(source) {
            Some(length) => Token::Kept(length),
            None => Token::Word(word_length(source)),
        },
        [first, ..] if first.is_ascii_alphanumeric() || *first == b'_' => {
            Token::Word(word_length(source))
        }
        _ => Token::Other,
    }
}

fn word_length(source: &str) -> usize {
    let end = source.find(|c: char| !c.is_alphanumeric() && c != '_');
    end.unwrap_or(source.len())
}

/// Length up to the quote that is not escaped.
fn quoted(bytes: &[u8], quote: u8) -> usize {
    let mut at = 1;
    while at < bytes.len() && bytes[at] != quote {
        at += 1 + usize::from(bytes[at] == b'\\');
    }
    (at + 1).min(bytes.len())
}

/// Length of a raw string, which has as many `#` at its end as at its beginning.
fn raw(source: &str) -> Option<usize> {
    let begun = source.find('"')?;
    let hashes = source[..begun].trim_start_matches(['b', 'r']);
    if hashes.bytes().any(|byte| byte != b'#') {
        return None;
    }
    let end = format!("\"{hashes}");
    let at = source[begun + 1..].find(&end)?;
    Some(begun + 1 + at + end.len())
}

/// A name: the root of a path leads elsewhere.
fn word(word: &str, after: &str, paths: &Paths) -> String {
    match word {
        "crate" if after.starts_with("::") && !paths.own.is_empty() => {
            format!("crate::{}", paths.own)
        }
        _ => (paths.of)(word).unwrap_or_else(|| word.to_owned()),
    }
}

/// A string that is a path and nothing else, as serde takes them in attributes.
fn text(text: &str, paths: &Paths) -> String {
    let inside = text.trim_matches('"');
    let path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    match inside.starts_with("crate::") && inside.chars().all(path) {
        true => format!("\"{}\"", path_of(inside, paths)),
        false => text.to_owned(),
    }
}

fn path_of(path: &str, paths: &Paths) -> String {
    let (first, rest) = path.split_at(word_length(path));
    word(first, rest, paths) + rest
}

/// A line of documentation: the targets of its links. An example of a module cannot be run from outside and is marked so.
fn doc(line: &str, paths: &Paths, fence: &mut bool) -> String {
    let content = line[3..].trim();
    if content.starts_with("```") {
        *fence = !*fence;
        let runs = matches!(content, "```" | "```no_run" | "```should_panic");
        return match *fence && runs && !paths.own.is_empty() {
            true => format!("{}```ignore", &line[..line.find("```").unwrap_or(0)]),
            false => line.to_owned(),
        };
    }
    if *fence {
        return line.to_owned();
    }
    let mut out = String::new();
    let mut rest = line;
    while let Some(at) = rest.find(['[', ']']) {
        out.push_str(&rest[..at]);
        rest = &rest[at..];
        let (begun, ends) = match rest {
            _ if rest.starts_with("[`") => ("[`", "`]"),
            _ if rest.starts_with("](") => ("](", ")"),
            _ if rest.starts_with("]: ") => ("]: ", "\n"),
            _ => ("", ""),
        };
        let inside = &rest[begun.len()..];
        let end = inside.find(ends).unwrap_or(inside.len());
        let path = &inside[..end];
        let moved = path_of(path, paths);
        if begun.is_empty() || moved == path {
            out.push_str(&rest[..1]);
            rest = &rest[1..];
            continue;
        }
        let after = &inside[end..];
        if begun == "[`" && !after.starts_with("`](") {
            let name = path.rsplit("::").next().unwrap_or(path);
            out.push_str(&format!("[`{name}`]({moved})"));
            rest = after.get(2..).unwrap_or_default();
        } else if begun == "[`" {
            out.push_str(&format!("[`{path}"));
            rest = after;
        } else {
            out.push_str(&format!("{begun}{moved}"));
            rest = after;
        }
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moved(source: &str) -> String {
        let of = |name: &str| match name {
            "stiction_codes" => Some("stiction_formats::internal::codes".into()),
            "stiction_log" => Some("crate::internal::log".into()),
            _ => None,
        };
        let paths = Paths {
            own: "internal::say",
            of: &of,
        };
        rewritten(source, &paths)
    }

    #[test]
    fn paths_lead_into_the_package() {
        for (source, expected) in [
            (
                "use crate::{A, b::C};",
                "use crate::internal::say::{A, b::C};",
            ),
            ("pub(crate) fn f() {}", "pub(crate) fn f() {}"),
            (
                "pub(in crate::a) struct B;",
                "pub(in crate::internal::say::a) struct B;",
            ),
            ("$crate::A", "$crate::internal::say::A"),
            (
                "use stiction_log as log;",
                "use crate::internal::log as log;",
            ),
            (
                "stiction_codes::Code::A",
                "stiction_formats::internal::codes::Code::A",
            ),
            (
                "my_stiction_log::A + stiction_friction::B",
                "my_stiction_log::A + stiction_friction::B",
            ),
            (
                "#[serde(with = \"crate::bits\")]",
                "#[serde(with = \"crate::internal::say::bits\")]",
            ),
        ] {
            assert_eq!(moved(source), expected);
        }
    }

    #[test]
    fn strings_and_comments_stay() {
        for source in [
            "\"see crate::a, \\\" stiction_log::b\"",
            "r#\"a \" crate::b \"#",
            "br\"crate::b\"",
            "// crate::a: stiction_log::b",
            "/* crate::a */",
            "'\"' // crate::b",
            "b'\"' + b'\\'' // \" crate::b",
            "fn f<'a>(x: &'a str) -> &'a str { \"crate::b, and more\" }",
            "/// `stiction_log` in words, crate::a too",
            "/// ```text\n/// crate::a\n/// ```",
        ] {
            assert_eq!(moved(source), source);
        }
        let raw = "r#\"x\"# + crate::b";
        assert_eq!(moved(raw), "r#\"x\"# + crate::internal::say::b");
        assert_eq!(moved("'x' + crate::b"), "'x' + crate::internal::say::b");
    }

    #[test]
    fn links_of_documentation_lead_into_the_package() {
        for (source, expected) in [
            (
                "/// A [`crate::A::b`] here",
                "/// A [`b`](crate::internal::say::A::b) here",
            ),
            (
                "/// [words](crate::A), [`Own`]",
                "/// [words](crate::internal::say::A), [`Own`]",
            ),
            (
                "/// [`A`](stiction_log::A)",
                "/// [`A`](crate::internal::log::A)",
            ),
            ("//! [a]: crate::A", "//! [a]: crate::internal::say::A"),
            (
                "/// ```\n/// crate::a\n/// ```",
                "/// ```ignore\n/// crate::a\n/// ```",
            ),
        ] {
            assert_eq!(moved(source), expected);
        }
    }
}
