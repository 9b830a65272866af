//! The terms of reports and messages, explained: in a section of each report, since those are read without the rest of the
//! documentation, and on the page `docs/glossary.md`. Both come from one table.

mod terms;

use stiction_report::{Block, Document, Text};

/// A term of the field, as stiction uses it.
#[derive(Clone, Copy, Debug)]
pub struct Term {
    /// The term.
    pub name: &'static str,
    /// Its symbol; may be empty.
    pub symbol: &'static str,
    /// Its unit for a linear axis, `1` for a plain number; empty where it is not a quantity.
    pub unit: &'static str,
    /// Other names.
    pub others: &'static [&'static str],
    /// What it is, in a sentence or two.
    pub meaning: &'static str,
}

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
         literature; units are those of a linear axis: a rotary one has rad for m, N m for N and kg m² for kg, and where the \
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

impl Term {
    /// The term with symbol and unit.
    fn head(&self) -> Text {
        let head = Text::new().bold(self.name);
        match (self.symbol, self.unit) {
            ("", "" | "1") => head,
            ("", unit) => head.plain(format!(" ({unit})")),
            (symbol, "" | "1") => head.plain(format!(" {symbol}")),
            (symbol, unit) => head.plain(format!(" {symbol} ({unit})")),
        }
    }

    /// Whether a text in lower case has the term or another name of it as a word, in singular or plural.
    fn is_in(&self, text: &str) -> bool {
        let mut names = std::iter::once(&self.name).chain(self.others);
        names.any(|name| {
            let name = name.to_lowercase();
            text.match_indices(&name).any(|(at, _)| {
                let before = text[..at].chars().next_back();
                let rest = &text[at + name.len()..];
                let after = rest.strip_prefix('s').unwrap_or(rest).chars().next();
                let apart = |c: Option<char>| !c.is_some_and(char::is_alphanumeric);
                apart(before) && apart(after)
            })
        })
    }
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
