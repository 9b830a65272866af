//! The terms of reports and messages, explained: in a section of each report, since those are read without the rest of the
//! documentation, and on the page `docs/glossary.md`. Both come from one table.

mod term;
mod terms;

use stiction_report::{Block, Document, Text};
pub use term::Term;

/// All terms, by topic.
pub const TOPICS: [(&str, &[Term]); 5] = [
    ("Friction and its laws", terms::FRICTION),
    ("The axis", terms::AXIS),
    ("Identification", terms::IDENTIFICATION),
    ("Searches", terms::SEARCH),
    ("Compensation and tracking", terms::COMPENSATION),
];

/// The document with a section that explains those terms that it uses.
pub(crate) fn explained(document: Document) -> Document {
    let text = document.to_plain().to_lowercase();
    let used = TOPICS.iter().flat_map(|(_, terms)| *terms);
    let facts: Vec<(Text, Text)> = used
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

/// `docs/glossary.md`.
pub fn page() -> String {
    let mut page = String::from(
        "# Glossary\n\nThe terms of messages, reports and these pages, as stiction uses them. Symbols are those of the LuGre \
         literature; units are those of a linear axis: a rotary one has rad for m, N·m for N and kg·m² for kg, and where the \
         force was logged in another unit, that unit takes the place of N. Each report explains the terms that it uses, too.\n",
    );
    for (topic, terms) in TOPICS {
        page += &format!(
            "\n## {topic}\n\n| term | symbol | unit | other names | meaning |\n|---|---|---|---|---|\n"
        );
        for term in terms {
            page += &format!(
                "| **{}** | {} | {} | {} | {} |\n",
                term.name,
                term.symbol,
                term.unit,
                term.others.join(", "),
                term.meaning
            );
        }
    }
    page
}

#[cfg(test)]
mod tests {
    use super::{TOPICS, explained, page};
    use std::collections::BTreeSet;
    use stiction_report::Document;

    #[test]
    fn the_page_of_the_documentation_is_made_from_the_table() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/glossary.md");
        if std::env::var_os("STICTION_WRITE_DOCS").is_some() {
            std::fs::write(path, page()).unwrap();
        }
        let kept = std::fs::read_to_string(path).unwrap();
        assert!(
            kept == page(),
            "docs/glossary.md is not that of the table; STICTION_WRITE_DOCS=1 writes it"
        );
    }

    #[test]
    fn no_name_is_given_twice_and_no_cell_breaks_the_table() {
        let mut names = BTreeSet::new();
        for term in TOPICS.iter().flat_map(|(_, terms)| *terms) {
            for name in std::iter::once(&term.name).chain(term.others) {
                assert!(names.insert(name.to_lowercase()), "{name}");
            }
            assert!(term.meaning.ends_with('.') && !term.meaning.contains('|'));
        }
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
