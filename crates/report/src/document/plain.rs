//! The words of a document without its marks.

use super::{Block, Document};
use crate::{Figure, Text};

impl Document {
    /// The characters of titles, paragraphs, tables, captions, labels and messages, separated by line ends: for search in a
    /// document. Numbers along axes and formulas are left out.
    pub fn to_plain(&self) -> String {
        let mut out = String::new();
        push(&mut out, &self.title);
        push(&mut out, &self.subtitle);
        blocks(&mut out, &self.blocks);
        push(&mut out, &self.footer);
        out
    }
}

fn push(out: &mut String, text: &Text) {
    out.push_str(&text.to_plain());
    out.push('\n');
}

fn blocks(out: &mut String, parts: &[Block]) {
    for part in parts {
        match part {
            Block::Heading(_, text) | Block::Paragraph(text) | Block::Formula(_, text) => {
                push(out, text);
            }
            Block::List(items) => items.iter().for_each(|text| push(out, text)),
            Block::Facts(facts) => {
                for (term, value) in facts {
                    push(out, term);
                    push(out, value);
                }
            }
            Block::Table(table) => {
                push(out, &table.caption);
                let heads = table.columns.iter().map(|(head, _)| head);
                let cells = table.rows.iter().flat_map(|row| &row.cells);
                heads.chain(cells).for_each(|text| push(out, text));
            }
            Block::Figure(shown) => figure(out, shown),
            Block::Drawing(drawing) => {
                push(out, &drawing.title);
                push(out, &drawing.caption);
            }
            Block::Heatmap(map) => {
                let names = map.rows.iter().chain(&map.columns);
                [&map.title, &map.caption]
                    .into_iter()
                    .chain(names)
                    .for_each(|text| push(out, text));
            }
            Block::Callout(callout) => push(out, &callout.text),
            Block::KeyFigures(figures) => {
                for figure in figures {
                    push(out, &figure.label);
                    push(out, &figure.note);
                }
            }
            Block::Columns(inner) => blocks(out, inner),
            Block::Details(text, inner) => {
                push(out, text);
                blocks(out, inner);
            }
        }
    }
}

fn figure(out: &mut String, figure: &Figure) {
    push(out, &figure.title);
    push(out, &figure.caption);
    for panel in &figure.panels {
        push(out, &panel.title);
        push(out, &panel.x.label);
        push(out, &panel.y.label);
        let labels = panel.layers.iter().filter_map(|layer| layer.label.as_ref());
        labels.for_each(|label| push(out, label));
    }
}
