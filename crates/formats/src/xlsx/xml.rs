//! Tags and texts of XML, one after the other, as far as workbooks need them.

use std::io::{self, BufRead, Read};

/// Longest tag or text in bytes.
const MAX_PART: u64 = 1 << 20;

/// What comes next.
pub(super) enum Part {
    /// A tag as it stands between its brackets, without the slash that ends an empty one, and whether it is empty.
    Open(String, bool),
    /// The name of a tag that ends.
    Close(String),
    Text(String),
}

/// A stream of XML.
pub(super) struct Xml<R> {
    reader: R,
    in_tag: bool,
}

impl<R: BufRead> Xml<R> {
    pub(super) fn new(reader: R) -> Self {
        Self {
            reader,
            in_tag: false,
        }
    }

    /// The next tag or text; comments and declarations are passed over.
    pub(super) fn next(&mut self) -> io::Result<Option<Part>> {
        loop {
            let end = if self.in_tag { b'>' } else { b'<' };
            let mut bytes = Vec::new();
            let read = (&mut self.reader)
                .take(MAX_PART)
                .read_until(end, &mut bytes)?;
            if read == 0 {
                return match self.in_tag {
                    true => Err(io::ErrorKind::UnexpectedEof.into()),
                    false => Ok(None),
                };
            }
            if bytes.pop_if(|byte| *byte == end).is_none()
                && (self.in_tag || read as u64 == MAX_PART)
            {
                return Err(io::Error::other("a tag or text that does not end"));
            }
            self.in_tag = !self.in_tag;
            let text = String::from_utf8_lossy(&bytes);
            if self.in_tag {
                if !text.is_empty() {
                    return Ok(Some(Part::Text(plain(&text))));
                }
            } else if let Some(name) = text.strip_prefix('/') {
                return Ok(Some(Part::Close(local(name.trim()).to_owned())));
            } else if !text.starts_with(['?', '!']) {
                let empty = text.ends_with('/');
                return Ok(Some(Part::Open(
                    text.trim_end_matches('/').to_owned(),
                    empty,
                )));
            }
        }
    }
}

/// The name of a tag without its namespace.
pub(super) fn name(tag: &str) -> &str {
    local(tag.split_ascii_whitespace().next().unwrap_or(""))
}

fn local(name: &str) -> &str {
    name.rsplit_once(':').map_or(name, |(_, local)| local)
}

/// The value of an attribute of a tag.
pub(super) fn attribute(tag: &str, wanted: &str) -> Option<String> {
    let mut rest = tag.split_once(char::is_whitespace)?.1;
    loop {
        let (key, after) = rest.split_once('=')?;
        let after = after.trim_start();
        let quote = after.chars().next().filter(|c| matches!(c, '"' | '\''))?;
        let (value, after) = after[1..].split_once(quote)?;
        if key.trim() == wanted {
            return Some(plain(value));
        }
        rest = after;
    }
}

/// Text without entities.
fn plain(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('&') {
        out.push_str(before);
        let Some((entity, behind)) = after.split_once(';') else {
            out.push('&');
            rest = after;
            continue;
        };
        let code = entity
            .strip_prefix('#')
            .and_then(|code| match code.strip_prefix('x') {
                Some(code) => u32::from_str_radix(code, 16).ok(),
                None => code.parse().ok(),
            });
        out.push(match entity {
            "lt" => '<',
            "gt" => '>',
            "quot" => '"',
            "apos" => '\'',
            "amp" => '&',
            _ => code
                .and_then(char::from_u32)
                .unwrap_or(char::REPLACEMENT_CHARACTER),
        });
        rest = behind;
    }
    out.push_str(rest);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_attributes_and_entities() {
        let mut xml =
            Xml::new(&b"<?xml?><a:c r='B2' t=\"s &lt;\"><v>1 &amp; &#x41;</v><e/></a:c>"[..]);
        let Some(Part::Open(tag, false)) = xml.next().unwrap() else {
            panic!("a tag");
        };
        assert_eq!(name(&tag), "c");
        assert_eq!(attribute(&tag, "r").as_deref(), Some("B2"));
        assert_eq!(attribute(&tag, "t").as_deref(), Some("s <"));
        assert_eq!(attribute(&tag, "x"), None);
        assert!(matches!(xml.next().unwrap(), Some(Part::Open(tag, false)) if tag == "v"));
        assert!(matches!(xml.next().unwrap(), Some(Part::Text(text)) if text == "1 & A"));
        assert!(matches!(xml.next().unwrap(), Some(Part::Close(tag)) if tag == "v"));
        assert!(matches!(xml.next().unwrap(), Some(Part::Open(tag, true)) if tag == "e"));
        assert!(matches!(xml.next().unwrap(), Some(Part::Close(tag)) if tag == "c"));
        assert!(xml.next().unwrap().is_none());
        assert!(Xml::new(&b"<a"[..]).next().is_err());
    }
}
