//! Escapes untrusted text for XML and HTML.

/// Appends `text` to `out` so that it is plain character data, in an element as well as in a
/// double-quoted attribute. Characters that XML 1.0 forbids, and those that reorder the text around
/// them (bidirectional overrides), become U+FFFD.
pub(crate) fn push(out: &mut String, text: &str) {
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\t' | '\n' => out.push(c),
            '\r' => out.push('\n'),
            c if c.is_control() => out.push('\u{fffd}'),
            '\u{fffe}'
            | '\u{ffff}'
            | '\u{61c}'
            | '\u{200e}'
            | '\u{200f}'
            | '\u{202a}'..='\u{202e}'
            | '\u{2066}'..='\u{2069}' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
}

/// [`push`] into a new string.
pub(crate) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    push(&mut out, text);
    out
}

/// Whether a link target may become an `href`: a web or mail address, an anchor, or a relative
/// path. Everything with another scheme (`javascript:`, `data:`, `file:`) may not.
pub(crate) fn is_safe_link(target: &str) -> bool {
    if target.chars().any(|c| c.is_control()) {
        return false;
    }
    let target = target.trim();
    match target.split_once(':') {
        None => !target.is_empty(),
        Some((scheme, _)) if scheme.contains(['/', '#', '?']) => true,
        Some((scheme, _)) => ["http", "https", "mailto"]
            .iter()
            .any(|s| scheme.eq_ignore_ascii_case(s)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_and_forbidden_characters_are_defused() {
        assert_eq!(
            escaped("<b a=\"'&'\">"),
            "&lt;b a=&quot;&#39;&amp;&#39;&quot;&gt;"
        );
        assert_eq!(
            escaped("a\0b\u{1b}c\u{ffff}\u{202e}d"),
            "a\u{fffd}b\u{fffd}c\u{fffd}\u{fffd}d"
        );
        assert_eq!(escaped("σ₀ · 5 µm\n"), "σ₀ · 5 µm\n");
    }

    #[test]
    fn only_harmless_link_targets_pass() {
        for good in [
            "https://a.b/c?d",
            "docs/codes/W12.html",
            "#sec",
            "../a:b/c",
            "MAILTO:x@y",
        ] {
            let expected = good != "../a:b/c" || is_safe_link(good);
            assert!(is_safe_link(good) && expected, "{good}");
        }
        for bad in [
            "javascript:alert(1)",
            " JaVaScRiPt:x",
            "java\nscript:x",
            "data:text/html,x",
            "",
        ] {
            assert!(!is_safe_link(bad), "{bad}");
        }
    }
}
