//! A matrix of shares or correlations as coloured cells with their numbers.

use crate::figure::{Figure, round, svg};
use crate::text::Text;

/// Most rows and columns drawn.
const MAX_CELLS: usize = 60;
/// Size of the text, px.
const TEXT_SIZE: f64 = 12.0;

/// A matrix of values from -1 to 1 (two colours) or 0 to 1 (one).
///
/// ```
/// use stiction_report::Heatmap;
/// let svg = Heatmap::square("Correlation", ["a", "b"], [1.0, -0.4, -0.4, 1.0]).to_svg();
/// assert!(svg.contains("−0.40"));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Heatmap {
    /// What it shows: the start of the caption.
    pub title: Text,
    /// What the reader should see in it; may be empty.
    pub caption: Text,
    /// Names of the rows.
    pub rows: Vec<Text>,
    /// Names of the columns.
    pub columns: Vec<Text>,
    /// Row after row, in -1 ... 1. Values beyond are coloured like the end; missing ones and those
    /// that are not finite are left open. Of more than 60 rows or columns the first 60 are drawn,
    /// and the figure says so.
    pub values: Vec<f64>,
}

impl Heatmap {
    /// A matrix with its own names for rows and columns.
    pub fn new(
        title: impl Into<Text>,
        rows: impl IntoIterator<Item = impl Into<Text>>,
        columns: impl IntoIterator<Item = impl Into<Text>>,
        values: impl Into<Vec<f64>>,
    ) -> Self {
        Self {
            title: title.into(),
            caption: Text::new(),
            rows: rows.into_iter().map(Into::into).collect(),
            columns: columns.into_iter().map(Into::into).collect(),
            values: values.into(),
        }
    }

    /// A matrix over the same names twice.
    pub fn square(
        title: impl Into<Text>,
        names: impl IntoIterator<Item = impl Into<Text>>,
        values: impl Into<Vec<f64>>,
    ) -> Self {
        let names: Vec<Text> = names.into_iter().map(Into::into).collect();
        Self::new(title, names.clone(), names, values)
    }

    /// Sets the caption.
    pub fn caption(mut self, caption: impl Into<Text>) -> Self {
        self.caption = caption.into();
        self
    }

    /// A complete SVG file with its own style, for light and dark surroundings.
    pub fn to_svg(&self) -> String {
        self.render(svg::Place::Alone).1
    }

    /// Natural width in px and the `svg` element for a document that holds the style.
    pub(crate) fn to_inline_svg(&self) -> (f64, String) {
        self.render(svg::Place::InDocument)
    }

    fn render(&self, place: svg::Place) -> (f64, String) {
        let rows = &self.rows[..self.rows.len().min(MAX_CELLS)];
        let columns = &self.columns[..self.columns.len().min(MAX_CELLS)];
        let widest = |names: &[Text]| names.iter().map(|n| n.width(TEXT_SIZE)).fold(0.0, f64::max);
        let left = round((widest(rows) + 14.0).clamp(20.0, 300.0));
        let room = (Figure::FULL - left - 90.0) / columns.len().max(1) as f64;
        let wide = round(room.clamp(6.0, 62.0));
        let high = round(wide.min(38.0));
        let numbers = wide >= 36.0;
        let slanted = widest(columns) + 6.0 > wide;
        let top = if slanted {
            round((0.5 * widest(columns) + 16.0).min(200.0))
        } else {
            26.0
        };
        let mut out = String::new();
        for (i, name) in columns.iter().enumerate() {
            let x = round(left + (i as f64 + 0.5) * wide);
            let y = top - 9.0;
            out.push_str(&if slanted {
                format!("<text transform=\"translate({x} {y}) rotate(-30)\">")
            } else {
                format!("<text x=\"{x}\" y=\"{y}\" text-anchor=\"middle\">")
            });
            name.push_svg(&mut out);
            out.push_str("</text>\n");
        }
        for (i, name) in rows.iter().enumerate() {
            let y = round(top + (i as f64 + 0.5) * high + 4.0);
            out.push_str(&format!(
                "<text x=\"{}\" y=\"{y}\" text-anchor=\"end\">",
                left - 9.0
            ));
            name.push_svg(&mut out);
            out.push_str("</text>\n");
            for j in 0..columns.len() {
                let value = self.values.get(i * self.columns.len() + j).copied();
                let corner = (round(left + j as f64 * wide), round(top + i as f64 * high));
                cell(
                    &mut out,
                    corner,
                    (wide, high),
                    value.unwrap_or(f64::NAN),
                    numbers,
                );
            }
        }
        let right = left + wide * columns.len() as f64;
        let slant_room = if slanted {
            0.87 * widest(columns) - wide / 2.0
        } else {
            0.0
        };
        let key = round(right + slant_room.max(0.0) + 18.0);
        scale(
            &mut out,
            key,
            top,
            (high * rows.len() as f64).clamp(60.0, 220.0),
            self.signed(),
        );
        let mut bottom = top + (high * rows.len() as f64).max(66.0) + 8.0;
        if (rows.len(), columns.len()) != (self.rows.len(), self.columns.len()) {
            bottom += 18.0;
            let (r, c) = (self.rows.len(), self.columns.len());
            let note = format!(
                "The first {} of {r} rows, {} of {c} columns",
                rows.len(),
                columns.len()
            );
            out.push_str(&format!(
                "<text x=\"2\" y=\"{}\">{note}</text>\n",
                round(bottom - 8.0)
            ));
        }
        // The note must fit beside few columns, too.
        let width = (key + 56.0)
            .max(if bottom > top + 330.0 { 360.0 } else { 0.0 })
            .ceil();
        let description = self.description(rows, columns);
        let title = self.title.to_plain();
        (
            width,
            svg::element(place, (width, bottom.ceil()), &title, &description, &out),
        )
    }

    fn signed(&self) -> bool {
        self.values.iter().any(|v| *v < 0.0)
    }

    /// The strongest relations in words.
    fn description(&self, rows: &[Text], columns: &[Text]) -> String {
        let mut strong = Vec::new();
        for (i, row) in rows.iter().enumerate() {
            for (j, column) in columns.iter().enumerate() {
                let value = self.values.get(i * self.columns.len() + j).copied();
                if let Some(value) = value.filter(|v| {
                    v.is_finite() && v.abs() >= 0.7 && row != column && strong.len() < 12
                }) {
                    let (row, column) = (row.to_plain(), column.to_plain());
                    strong.push(format!("{row} and {column} {value:.2}"));
                }
            }
        }
        let caption = self.caption.to_plain();
        let space = if caption.is_empty() { "" } else { " " };
        let strong = if strong.is_empty() {
            "none".into()
        } else {
            strong.join(", ")
        };
        format!("{caption}{space}Values of 0.7 and more: {strong}.")
    }
}

fn cell(out: &mut String, (x, y): (f64, f64), (w, h): (f64, f64), value: f64, numbers: bool) {
    let mut rect = |class: &str, opacity: f64| {
        out.push_str(&format!(
            "<rect class=\"area {class}\" x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" \
             opacity=\"{opacity}\"/>\n"
        ));
    };
    let share = if value.is_finite() {
        value.abs().min(1.0)
    } else {
        0.0
    };
    let opacity = (share * 100.0).round() / 100.0;
    if opacity > 0.0 {
        rect(if value < 0.0 { "vermilion" } else { "blue" }, opacity);
    }
    out.push_str(&format!(
        "<path class=\"cell-line\" d=\"M{x} {y}h{w}v{h}h-{w}z\"/>\n"
    ));
    if numbers {
        let text = match value {
            v if !v.is_finite() => "–".to_string(),
            v => format!("{:.2}", v.clamp(-99.0, 99.0))
                .replace('-', "−")
                .replace("−0.00", "0.00"),
        };
        // The classes in which the number is written, so that it has contrast in light and dark.
        let class = match share {
            s if s > 0.85 => "on-strong",
            s if s > 0.66 => "on-middle",
            _ => "on-weak",
        };
        let (x, y) = (round(x + w / 2.0), round(y + h / 2.0 + 4.0));
        out.push_str(&format!(
            "<text class=\"{class}\" x=\"{x}\" y=\"{y}\" text-anchor=\"middle\">{text}</text>\n"
        ));
    }
}

/// The key to the colours.
fn scale(out: &mut String, x: f64, top: f64, height: f64, signed: bool) {
    let steps = 20;
    let (high, low) = (1.0, if signed { -1.0 } else { 0.0 });
    let step = height / steps as f64;
    for i in 0..steps {
        let value: f64 = high - (i as f64 + 0.5) / steps as f64 * (high - low);
        let class = if value < 0.0 { "vermilion" } else { "blue" };
        out.push_str(&format!(
            "<rect class=\"area {class}\" x=\"{x}\" y=\"{}\" width=\"10\" height=\"{}\" opacity=\"{}\"/>\n",
            round(top + i as f64 * step),
            round(step),
            (value.abs() * 100.0).round() / 100.0
        ));
    }
    let labels: &[(&str, f64)] = if signed {
        &[("1", 0.0), ("0", 0.5), ("−1", 1.0)]
    } else {
        &[("1", 0.0), ("0", 1.0)]
    };
    for (label, at) in labels {
        let (x, y) = (x + 16.0, round(top + 4.0 + at * height));
        out.push_str(&format!("<text x=\"{x}\" y=\"{y}\">{label}</text>\n"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(svg: &str) -> usize {
        roxmltree::Document::parse(svg).unwrap();
        svg.matches("cell-line\" d").count()
    }

    #[test]
    fn missing_and_impossible_values_leave_cells_open() {
        let map = Heatmap::square("m", ["a", "b"], [1.0, f64::NAN, f64::INFINITY]);
        let svg = map.to_svg();
        assert_eq!(cells(&svg), 4);
        assert_eq!(svg.matches(">–</text>").count(), 3);
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }

    #[test]
    fn large_and_empty_matrices_are_bounded() {
        let names: Vec<String> = (0..500).map(|i| format!("column {i}")).collect();
        let svg = Heatmap::square("m", names, vec![-0.5; 250_000]).to_svg();
        assert_eq!(cells(&svg), MAX_CELLS * MAX_CELLS);
        assert!(svg.contains("The first 60 of 500 rows"));
        assert_eq!(cells(&Heatmap::square("m", [""; 0], []).to_svg()), 0);
    }
}
