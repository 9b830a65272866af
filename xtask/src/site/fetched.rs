//! What a page has a browser fetch from another place.

/// How a reference begins, and the character that it ends before.
pub type Mark = (&'static str, char);

/// In a page.
pub const HTML: &[Mark] = &[
    ("<script", '>'),
    ("<link", '>'),
    ("<img", '>'),
    ("<iframe", '>'),
];
/// In a style.
pub const CSS: &[Mark] = &[("url(", ')'), ("@import", ';')];

/// The first reference that leads to another place.
pub fn first<'a>(page: &'a str, marks: &[Mark]) -> Option<&'a str> {
    let all = marks.iter().flat_map(|&(mark, end)| {
        page.split(mark)
            .skip(1)
            .filter_map(move |part| part.split(end).next())
    });
    let mut elsewhere = all.filter(|part| {
        let starts = ["=\"http", "=http", "=\"//", "=//"];
        let of_style = part.trim_start_matches(['"', '\'', ' ']);
        let is_elsewhere = starts.iter().any(|start| part.contains(start))
            || of_style.starts_with("http")
            || of_style.starts_with("//");
        // Where a page is, said to search engines, is fetched by nobody, and a drawing in a style only names its kind.
        is_elsewhere && !part.contains("canonical") && !of_style.starts_with("data:")
    });
    elsewhere.next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_fetched_from_elsewhere_is_found() {
        let here = r#"<link rel="canonical" href="https://x.org/"><script src="a.js"></script><a href="https://x.org/">"#;
        assert_eq!(first(here, HTML), None);
        for page in [
            r#"<script src="https://x.org/a.js">"#,
            r#"<link href="//x.org/a.css">"#,
            "<img alt=x src=http://x.org/a.png>",
        ] {
            assert!(first(page, HTML).is_some(), "{page}");
        }
        assert_eq!(
            first(
                "a{src:url(../a.woff2)}b{src:url('data:image/svg+xml,<svg xmlns=\"http://www.w3.org/2000/svg\">')}",
                CSS
            ),
            None
        );
        for style in [
            "a{src:url(https://x.org/a.woff2)}",
            "@import 'http://x.org/a.css';",
        ] {
            assert!(first(style, CSS).is_some(), "{style}");
        }
    }
}
