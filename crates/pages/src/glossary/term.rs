//! A term of the field, and where a text uses it.

use stiction_report::Text;

/// A term of the field, as stiction uses it.
#[derive(Clone, Debug)]
pub struct Term {
    /// The term.
    pub name: &'static str,
    /// Its symbol; may be empty.
    pub symbol: &'static str,
    /// Its unit for a linear axis, `1` for a plain number; empty where it is not a quantity.
    pub unit: &'static str,
    /// Other names.
    pub others: Vec<&'static str>,
    /// What it is, in a sentence or two.
    pub meaning: &'static str,
}

impl Term {
    /// The term of a row of the table; `None` of any other line.
    pub(super) fn of_row(row: &'static str) -> Option<Self> {
        let cells = row.strip_prefix("| **")?.strip_suffix('|')?.split('|');
        let cells: Vec<&str> = cells.map(str::trim).collect();
        let [name, symbol, unit, others, meaning] = cells[..] else {
            return None;
        };
        Some(Self {
            name: name.strip_suffix("**")?,
            symbol,
            unit,
            others: others.split(", ").filter(|o| !o.is_empty()).collect(),
            meaning,
        })
    }

    /// The term with symbol and unit.
    pub(super) fn head(&self) -> Text {
        let head = Text::new().bold(self.name);
        match (self.symbol, self.unit) {
            ("", "" | "1") => head,
            ("", unit) => head.plain(format!(" ({unit})")),
            (symbol, "" | "1") => head.plain(format!(" {symbol}")),
            (symbol, unit) => head.plain(format!(" {symbol} ({unit})")),
        }
    }

    /// Whether a text in lower case has the term or another name of it as a word, in singular or plural.
    pub(super) fn is_in(&self, text: &str) -> bool {
        let mut names = std::iter::once(&self.name).chain(&self.others);
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
