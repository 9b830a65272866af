//! The document: a list of blocks that becomes one HTML file.

mod html;
mod plain;
mod table;
mod width;

pub use table::{Align, Row, Table};

use crate::drawing::Drawing;
use crate::figure::Figure;
use crate::heatmap::Heatmap;
use crate::math::Math;
use crate::text::Text;

/// How much a message, a row or a value should worry the reader. Shown by a word or a sign as well
/// as by colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    /// Good to know.
    Info,
    /// As it should be.
    Good,
    /// Look at it before relying on the result.
    Warning,
    /// The result must not be relied on.
    Error,
}

/// A message with a code that can be looked up.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Callout {
    /// How serious it is.
    pub severity: Severity,
    /// The stable code; may be empty.
    pub code: String,
    /// The message.
    pub text: Text,
    /// Where the code is explained (a web address or relative path); may be empty.
    pub link: String,
}

/// One number of the summary.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyFigure {
    /// The quantity.
    pub label: Text,
    /// Its value, as it should appear.
    pub value: Text,
    /// Its unit; may be empty.
    pub unit: String,
    /// A line below, such as the interval or what it is compared with; may be empty.
    pub note: Text,
    /// Marked when set.
    pub severity: Option<Severity>,
}

impl KeyFigure {
    /// A value with its unit.
    pub fn new(label: impl Into<Text>, value: impl Into<Text>, unit: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            value: value.into(),
            unit: crate::number::unit(&unit.into()),
            note: Text::new(),
            severity: None,
        }
    }

    /// Sets the line below.
    pub fn note(mut self, note: impl Into<Text>) -> Self {
        self.note = note.into();
        self
    }

    /// Marks it.
    pub fn severity(mut self, severity: Severity) -> Self {
        self.severity = Some(severity);
        self
    }
}

/// A part of a document.
#[derive(Debug, Clone, PartialEq)]
pub enum Block {
    /// A heading of level 2 to 4, listed among the contents down to level 3.
    Heading(u8, Text),
    /// A paragraph.
    Paragraph(Text),
    /// A bulleted list.
    List(Vec<Text>),
    /// Terms with their values: file, rate, filter.
    Facts(Vec<(Text, Text)>),
    /// A table.
    Table(Table),
    /// A figure.
    Figure(Figure),
    /// A drawing.
    Drawing(Drawing),
    /// A matrix.
    Heatmap(Heatmap),
    /// Formulas under one another, with a caption that may be empty.
    Formula(Vec<Math>, Text),
    /// A message.
    Callout(Callout),
    /// Numbers side by side: the summary.
    KeyFigures(Vec<KeyFigure>),
    /// Blocks side by side where there is room, such as two figures of half width.
    Columns(Vec<Block>),
    /// Blocks behind a line that opens them; on paper they are open where the browser allows it.
    Details(Text, Vec<Block>),
}

macro_rules! block_from {
    ($($name:ident),*) => {$(
        impl From<$name> for Block {
            fn from(part: $name) -> Self {
                Block::$name(part)
            }
        }
    )*};
}
block_from!(Table, Figure, Drawing, Heatmap, Callout);

/// A report.
#[derive(Debug, Clone, PartialEq)]
pub struct Document {
    /// The title, also that of the browser tab.
    pub title: Text,
    /// A line below it; may be empty.
    pub subtitle: Text,
    /// The content.
    pub blocks: Vec<Block>,
    /// A line at the end: version, seed, date; may be empty.
    pub footer: Text,
}

impl Document {
    /// A document without content.
    pub fn new(title: impl Into<Text>) -> Self {
        Self {
            title: title.into(),
            subtitle: Text::new(),
            blocks: Vec::new(),
            footer: Text::new(),
        }
    }

    /// Sets the line below the title.
    pub fn subtitle(mut self, subtitle: impl Into<Text>) -> Self {
        self.subtitle = subtitle.into();
        self
    }

    /// Sets the line at the end.
    pub fn footer(mut self, footer: impl Into<Text>) -> Self {
        self.footer = footer.into();
        self
    }

    /// Adds a block.
    pub fn block(mut self, block: impl Into<Block>) -> Self {
        self.blocks.push(block.into());
        self
    }

    /// Adds a heading of level 2 to 4.
    pub fn heading(self, level: u8, text: impl Into<Text>) -> Self {
        self.block(Block::Heading(level, text.into()))
    }

    /// Adds a paragraph.
    pub fn paragraph(self, text: impl Into<Text>) -> Self {
        self.block(Block::Paragraph(text.into()))
    }

    /// The complete HTML file: nothing to load, no scripts, also well-formed XML.
    pub fn to_html(&self) -> String {
        html::render(self)
    }
}
