//! The key to the layers of a panel, beside its vertical title and never over the data.

use super::draw::{dashes, round};
use super::layer::{Dash, Layer, Shape};
use crate::color::Color;
use crate::text::Text;

/// Size of the text, px.
const TEXT_SIZE: f64 = 12.0;
/// Width of the mark before a label, px.
const SWATCH_WIDTH: f64 = 22.0;
/// Distance between two entries, px.
const ENTRY_GAP: f64 = 18.0;
/// Height of a row of text, in px.
pub(crate) const ROW_HEIGHT: f64 = 19.0;

/// A legend laid out in rows.
pub(crate) struct Legend<'a> {
    entries: Vec<(&'a Layer, &'a Text, f64, f64)>,
    /// Rows, the first of which holds the vertical title.
    pub rows: usize,
}

impl<'a> Legend<'a> {
    /// Lays out the labelled layers in a panel of `width` px whose vertical title takes `title` px.
    /// What fits follows the title; otherwise the rows below are used.
    pub fn new(layers: &'a [Layer], width: f64, title: f64) -> Self {
        let listed = layers.iter().filter_map(|layer| {
            let text = layer.label.as_ref()?;
            let note = matches!(layer.shape, Shape::Note { .. });
            (!note && !text.is_empty()).then(|| (layer, text, text.width(TEXT_SIZE) + SWATCH_WIDTH))
        });
        let listed: Vec<_> = listed.collect();
        let total: f64 = listed.iter().map(|entry| entry.2 + ENTRY_GAP).sum::<f64>() - ENTRY_GAP;
        let beside = total + title + 2.0 * ENTRY_GAP <= width;
        let mut rows = if beside || listed.is_empty() { 1 } else { 2 };
        let after_title = if title > 0.0 {
            title + 2.0 * ENTRY_GAP
        } else {
            0.0
        };
        let mut x = if beside { after_title } else { 0.0 };
        let mut entries = Vec::new();
        for (layer, text, wide) in listed {
            if x > 0.0 && x + wide > width + 0.5 {
                x = 0.0;
                rows += 1;
            }
            entries.push((layer, text, x, (rows - 1) as f64 * ROW_HEIGHT));
            x += wide + ENTRY_GAP;
        }
        Self { entries, rows }
    }

    /// Appends the entries; the first row's base line is at `top` px, its left end at `left` px.
    pub fn push_svg(&self, left: f64, top: f64, out: &mut String) {
        for (layer, text, x, y) in &self.entries {
            let (x, y) = (round(left + x), round(top + y));
            out.push_str(&swatch(layer, x, y - 4.0));
            out.push_str(&format!(
                "<text x=\"{}\" y=\"{y}\">",
                round(x + SWATCH_WIDTH)
            ));
            text.push_svg(out);
            out.push_str("</text>\n");
        }
    }
}

/// The mark of a layer in 16 px around the height `y`.
fn swatch(layer: &Layer, x: f64, y: f64) -> String {
    let class = layer.color.unwrap_or(Color::Ink).class();
    let opacity = if layer.opacity.is_nan() {
        1.0
    } else {
        layer.opacity.clamp(0.25, 1.0)
    };
    let opacity = (opacity * 100.0).round() / 100.0;
    let x = round(x);
    match layer.shape {
        Shape::Points { .. } => {
            let (x, y) = (round(x + 8.0), round(y));
            format!("<circle class=\"area {class}\" cx=\"{x}\" cy=\"{y}\" r=\"3.2\"/>\n")
        }
        Shape::Band { .. } | Shape::HBand(..) | Shape::VBand(..) | Shape::Bars { .. } => {
            let y = round(y - 5.0);
            format!(
                "<rect class=\"area {class}\" opacity=\"{opacity}\" x=\"{x}\" y=\"{y}\" \
                 width=\"16\" height=\"10\" rx=\"2\"/>\n"
            )
        }
        _ => {
            let width = round(if layer.width.is_nan() {
                1.5
            } else {
                layer.width.clamp(1.2, 3.0)
            });
            let dash = match layer.dash {
                Dash::Dashed => " stroke-dasharray=\"5 4\"".to_string(),
                other => dashes(other, width),
            };
            let y = round(y);
            format!(
                "<path class=\"line {class}\" stroke-width=\"{width}\"{dash} d=\"M{x} {y}h16\"/>\n"
            )
        }
    }
}
