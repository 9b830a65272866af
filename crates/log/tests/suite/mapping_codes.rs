//! Every code that a user can meet has a page, and every page of a log has a code.

use std::collections::BTreeSet;
use std::path::Path;
use stiction_log::{CODES, Kind};

const KINDS: [Kind; 8] = [
    Kind::Io,
    Kind::Format,
    Kind::Limit,
    Kind::Ambiguous,
    Kind::Missing,
    Kind::Unit,
    Kind::Time,
    Kind::Value,
];

#[test]
fn every_code_has_a_page() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/codes");
    let codes = CODES
        .iter()
        .map(|(code, _)| *code)
        .chain(KINDS.iter().map(|kind| kind.code()));
    for code in codes {
        let path = folder.join(format!("{code}.md"));
        let page =
            std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let lines: Vec<_> = page.lines().collect();
        assert_eq!(lines[0], format!("# {code}"));
        assert!(
            (10..=40).contains(&lines.len()),
            "{code}: {} lines",
            lines.len()
        );
        for heading in ["## What stiction did", "## How to fix it", "## Example"] {
            assert!(lines.contains(&heading), "{code} has no {heading:?}");
        }
    }
}

#[test]
fn codes_are_slugs_and_differ() {
    let unique: BTreeSet<_> = CODES.iter().map(|(code, _)| *code).collect();
    assert_eq!(unique.len(), CODES.len());
    for (code, meaning) in CODES {
        assert!(
            code.chars().all(|c| c.is_ascii_lowercase() || c == '-'),
            "{code}"
        );
        assert!(!meaning.is_empty() && !meaning.ends_with('.'), "{meaning}");
    }
}
