//! The terms of reports and messages, explained: in a section of each report, since those are read without the rest of the
//! documentation. The table `glossary/terms.md` is a page of the documentation too.

mod term;

use stiction_report::{Block, Document, Text};
pub use term::Term;

const PAGE: &str = include_str!("glossary/terms.md");

/// All terms.
pub fn terms() -> impl Iterator<Item = Term> {
    PAGE.lines().filter_map(Term::of_row)
}

/// The document with a section that explains those terms that it uses.
pub(crate) fn explained(document: Document) -> Document {
    let text = document.to_plain().to_lowercase();
    let facts: Vec<(Text, Text)> = terms()
        .filter(|term| term.is_in(&text))
        .map(|term| (term.head(), term.meaning.into()))
        .collect();
    if facts.is_empty() {
        return document;
    }
    document.heading(2, "Words").block(Block::Details(
        "Terms used in this report".into(),
        vec![Block::Facts(facts)],
    ))
}

#[cfg(test)]
mod tests {
    use super::{PAGE, explained, terms};
    use std::collections::BTreeSet;
    use stiction_report::Document;

    #[test]
    fn no_name_is_given_twice_and_no_cell_breaks_the_table() {
        let mut names = BTreeSet::new();
        for term in terms() {
            for name in std::iter::once(&term.name).chain(&term.others) {
                assert!(names.insert(name.to_lowercase()), "{name}");
            }
            assert!(term.meaning.ends_with('.'), "{}", term.name);
        }
        let rows = PAGE.lines().filter(|line| line.starts_with("| **"));
        assert_eq!(rows.count(), terms().count());
    }

    #[test]
    fn a_report_explains_the_terms_that_it_uses() {
        let report =
            Document::new("Friction").paragraph("Break-away forces and the quadrant glitch.");
        let text = explained(report).to_plain();
        assert!(text.contains("break-away force (N)\n"));
        assert!(text.contains("reversal spike (m)\n"));
        // Neither used nor part of a longer word.
        assert!(!text.contains("micro-damping") && !text.contains("seed"));
        let silent = Document::new("Nothing");
        assert_eq!(explained(silent.clone()), silent);
    }
}
