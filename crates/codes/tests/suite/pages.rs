//! Every code has a page and a line in the list of codes, and every page a code.

use std::collections::BTreeSet;
use std::path::PathBuf;
use stiction_codes::Code;

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/codes")
}

#[test]
fn every_code_has_a_page_and_every_page_a_code() {
    let codes: BTreeSet<String> = Code::ALL.iter().map(Code::to_string).collect();
    assert_eq!(codes.len(), Code::ALL.len(), "a code stands twice");
    let entries = std::fs::read_dir(folder()).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let pages: BTreeSet<String> = names
        .filter_map(|name| name.strip_suffix(".md").map(str::to_string))
        .filter(|name| name != "README")
        .collect();
    let missing: Vec<_> = codes.difference(&pages).collect();
    let stray: Vec<_> = pages.difference(&codes).collect();
    assert!(
        missing.is_empty() && stray.is_empty(),
        "codes without a page: {missing:?}; pages without a code: {stray:?}"
    );
}

#[test]
fn every_page_says_what_it_means_and_what_to_do() {
    for code in Code::ALL {
        let page = std::fs::read_to_string(folder().join(format!("{code}.md"))).unwrap();
        assert!(page.starts_with(&format!("# {code}\n")), "{code}");
        let lines: Vec<_> = page.lines().collect();
        let count = lines.len();
        assert!((10..=45).contains(&count), "{code}: {count} lines");
        for heading in ["## What stiction did", "## How to fix it", "## Example"] {
            assert!(lines.contains(&heading), "{code} has no {heading:?}");
        }
    }
}

#[test]
fn codes_are_short_names_with_a_meaning() {
    for code in Code::ALL {
        let name = code.as_str();
        assert!(
            name.chars()
                .all(|c| c.is_ascii_alphanumeric() && !c.is_ascii_uppercase() || c == '-'),
            "{name}"
        );
        assert_eq!(Code::from_name(name), Some(*code));
        let meaning = code.meaning();
        assert!(!meaning.is_empty() && !meaning.ends_with('.'), "{meaning}");
    }
}

#[test]
fn the_list_has_every_code_with_its_meaning_in_order() {
    let list = std::fs::read_to_string(folder().join("README.md")).unwrap();
    let mut codes = Code::ALL.to_vec();
    codes.sort_by_key(|code| code.as_str());
    let rows: Vec<&str> = list
        .lines()
        .filter(|line| line.starts_with("| ["))
        .collect();
    assert_eq!(rows.len(), codes.len());
    for (row, code) in rows.iter().zip(codes) {
        let start = format!("| [{code}]({code}.md) | {} |", code.meaning());
        assert!(row.starts_with(&start), "{row}\nshould begin with\n{start}");
    }
}

#[test]
fn a_code_is_its_text_in_json() {
    for code in Code::ALL {
        let json = serde_json::to_string(code).unwrap();
        assert_eq!(json, format!("\"{code}\""));
        assert_eq!(serde_json::from_str::<Code>(&json).unwrap(), *code);
    }
    let refused = serde_json::from_str::<Code>("\"no-such-code\"").unwrap_err();
    assert!(refused.to_string().contains("no-such-code"));
}
