//! Tables.

use super::Severity;
use super::width::Setting;
use crate::text::Text;

/// How the cells of a column are aligned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// Words.
    Left,
    /// Numbers.
    Right,
    /// Signs.
    Center,
}

/// A row of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Row {
    /// Its cells; the first names the row. Missing cells are empty.
    pub cells: Vec<Text>,
    /// Marked when set.
    pub severity: Option<Severity>,
}

/// A table with a header row. The first cell of each row is its header.
///
/// ```
/// use stiction_report::{Align, Severity, Table};
/// let table = Table::new([("Parameter", Align::Left), ("Value", Align::Right), ("Unit", Align::Left)])
///     .row(["Coulomb force", "20.4", "N"])
///     .marked(Severity::Warning, ["Stiffness", "2.4×10⁸", "N/m"]);
/// assert_eq!(table.rows.len(), 2);
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Table {
    /// What it shows; may be empty, then it has no number.
    pub caption: Text,
    /// Names and alignment of the columns.
    pub columns: Vec<(Text, Align)>,
    /// The rows.
    pub rows: Vec<Row>,
}

impl Table {
    /// A table without rows.
    pub fn new<T: Into<Text>>(columns: impl IntoIterator<Item = (T, Align)>) -> Self {
        Self {
            caption: Text::new(),
            columns: columns
                .into_iter()
                .map(|(name, align)| (name.into(), align))
                .collect(),
            rows: Vec::new(),
        }
    }

    /// Sets the caption.
    pub fn caption(mut self, caption: impl Into<Text>) -> Self {
        self.caption = caption.into();
        self
    }

    /// Adds a row.
    pub fn row<T: Into<Text>>(mut self, cells: impl IntoIterator<Item = T>) -> Self {
        let cells = cells.into_iter().map(Into::into).collect();
        self.rows.push(Row {
            cells,
            severity: None,
        });
        self
    }

    /// Adds a marked row.
    pub fn marked<T: Into<Text>>(
        mut self,
        severity: Severity,
        cells: impl IntoIterator<Item = T>,
    ) -> Self {
        let cells = cells.into_iter().map(Into::into).collect();
        self.rows.push(Row {
            cells,
            severity: Some(severity),
        });
        self
    }

    /// Appends the `table` element; `number` stands before the caption.
    pub(crate) fn push_html(&self, number: &str, out: &mut String) {
        let wide = self
            .rows
            .iter()
            .map(|row| row.cells.len())
            .max()
            .unwrap_or(0);
        let wide = wide.max(self.columns.len());
        let class = |i: usize| match self.columns.get(i).map(|(_, align)| align) {
            Some(Align::Right) => " class=\"right\"",
            Some(Align::Center) => " class=\"center\"",
            _ => "",
        };
        let empty = Text::new();
        out.push_str(match Setting::of(self) {
            Setting::Normal => "<table>\n",
            Setting::Dense => "<table class=\"dense\">\n",
            Setting::Scrolling => "<table class=\"dense scrolling\">\n",
        });
        if !self.caption.is_empty() {
            out.push_str(&format!(
                "<caption><span><b>{number}</b> {}</span></caption>\n",
                self.caption.to_html()
            ));
        }
        if self.columns.iter().any(|(name, _)| !name.is_empty()) {
            out.push_str("<thead><tr>");
            for i in 0..wide {
                let name = self.columns.get(i).map_or(&empty, |(name, _)| name);
                out.push_str(&format!(
                    "<th scope=\"col\"{}>{}</th>",
                    class(i),
                    name.to_html()
                ));
            }
            out.push_str("</tr></thead>\n");
        }
        out.push_str("<tbody>\n");
        for row in &self.rows {
            let mark = match row.severity {
                Some(severity) => format!(" class=\"marked {}\"", severity.class()),
                None => String::new(),
            };
            out.push_str(&format!("<tr{mark}>"));
            for i in 0..wide {
                let mut cell = String::new();
                row.cells
                    .get(i)
                    .unwrap_or(&empty)
                    .push_html_breaking(&mut cell);
                if i == 0 {
                    let word = row
                        .severity
                        .map_or(String::new(), |severity| severity.sign());
                    out.push_str(&format!("<th scope=\"row\"{}>{word}{cell}</th>", class(i)));
                } else {
                    out.push_str(&format!("<td{}>{cell}</td>", class(i)));
                }
            }
            out.push_str("</tr>\n");
        }
        out.push_str("</tbody>\n</table>\n");
    }
}

impl Severity {
    pub(crate) fn class(self) -> &'static str {
        match self {
            Severity::Info => "info",
            Severity::Good => "good",
            Severity::Warning => "warning",
            Severity::Error => "error",
        }
    }

    pub(crate) fn word(self) -> &'static str {
        match self {
            Severity::Info => "Note",
            Severity::Good => "Good",
            Severity::Warning => "Warning",
            Severity::Error => "Error",
        }
    }

    /// A sign of its own shape with the word for screen readers.
    pub(crate) fn sign(self) -> String {
        let path = match self {
            Severity::Info => {
                "M8 1.5a6.5 6.5 0 1 0 0 13a6.5 6.5 0 1 0 0-13zM7.1 7h1.8v4.6h-1.8zM7.1 4.2h1.8v1.8h-1.8z"
            }
            Severity::Good => {
                "M8 1.5a6.5 6.5 0 1 0 0 13a6.5 6.5 0 1 0 0-13zM7.1 11.2l-3-2.9 1.2-1.2 1.8 1.7 3.7-3.7 1.2 1.2z"
            }
            Severity::Warning => "M8 1.4l7 12.8h-14zM7.1 6h1.8v4h-1.8zM7.1 11h1.8v1.7h-1.8z",
            Severity::Error => {
                "M5.2 1.5h5.6l3.7 3.7v5.6l-3.7 3.7h-5.6l-3.7-3.7v-5.6zM7.1 4h1.8v4.8h-1.8zM7.1 10.2h1.8v1.8h-1.8z"
            }
        };
        format!(
            "<svg class=\"sign {}\" viewBox=\"0 0 16 16\" role=\"img\"><title>{}</title>\
             <path fill-rule=\"evenodd\" d=\"{path}\"/></svg>",
            self.class(),
            self.word()
        )
    }
}
