//! The marks of one layer, in the coordinates of its plot.

use super::axis::Map;
use super::band::{band, outline};
use super::cloud::{Cloud, cloud};
use super::layer::{Dash, Layer, Shape, shortest};
use super::path::Path;
use super::trace::{Place, Trace, trace};
use crate::color::Color;
use crate::text::Text;

/// Most bars or intervals drawn one by one, above twice the width of a figure in px; more are merged by pixel.
const MAX_STROKES: usize = 2000;

/// The plot area of a panel: the maps of its axes and its size in px.
pub(crate) struct Frame {
    pub x: Map,
    pub y: Map,
    pub width: f64,
    pub height: f64,
}

impl Frame {
    pub fn x_px(&self, x: f64) -> f64 {
        self.x.place(x) * self.width
    }

    pub fn y_px(&self, y: f64) -> f64 {
        (1.0 - self.y.place(y)) * self.height
    }

    fn place(&self, x: f64, y: f64) -> Place {
        let (x, y) = (self.x_px(x), self.y_px(y));
        (x.is_finite() && y.is_finite()).then_some((x, y))
    }

    /// The height of an edge that may be open: infinite values, and values that a logarithmic axis
    /// has no place for, lie beyond the end of the axis.
    pub fn edge(&self, y: f64) -> Option<f64> {
        let far = 20.0;
        if y.is_nan() {
            return None;
        }
        let px = self.y_px(y);
        Some(if px.is_nan() {
            self.height + far
        } else {
            px.clamp(-far, self.height + far)
        })
    }
}

/// One stroke between two values at a position: a bar, an interval.
pub(crate) type Stroke = (f64, f64, f64);

/// Appends the marks of `layer`.
pub(crate) fn draw(layer: &Layer, frame: &Frame, out: &mut String) {
    let ink = Ink {
        layer,
        class: layer.color.unwrap_or(Color::Ink).class(),
    };
    match &layer.shape {
        Shape::Line { x, y } => {
            let [x, y] = shortest([x, y]);
            let places = x.iter().zip(y).map(|(x, y)| frame.place(*x, *y));
            ink.trace(trace(places, frame.width, frame.height), out);
        }
        Shape::Steps { x, y } => {
            let [x, y] = shortest([x, y]);
            let places = (0..x.len()).flat_map(|i| {
                let held = i
                    .checked_sub(1)
                    .and_then(|before| frame.place(x[i], y[before]));
                [held, frame.place(x[i], y[i])]
            });
            ink.trace(trace(places, frame.width, frame.height), out);
        }
        Shape::Points { x, y } => {
            let [x, y] = shortest([x, y]);
            let places = x.iter().zip(y).map(|(x, y)| frame.place(*x, *y));
            ink.cloud(cloud(places, frame.width, frame.height), out);
        }
        Shape::Bars { x, y, base } => {
            let [x, y] = shortest([x, y]);
            let width = bar_width(x, frame);
            let base = frame.edge(*base).unwrap_or(frame.height);
            let bars = x.iter().zip(y).filter_map(|(x, y)| {
                frame
                    .place(*x, *y)
                    .map(|(x, y)| (x, y.min(base), y.max(base)))
            });
            let path = strokes(bars, frame.width, None, false);
            ink.stroked("bars", path, width, out);
        }
        Shape::ErrorBars { x, low, high } => {
            let [x, low, high] = shortest([x, low, high]);
            let bars = (0..x.len()).filter_map(|i| {
                let (x, low, high) = (frame.x_px(x[i]), frame.edge(low[i])?, frame.edge(high[i])?);
                x.is_finite().then_some((x, low, high))
            });
            let path = strokes(bars, frame.width, Some(3.5), false);
            ink.stroked("line", path, layer.width, out);
        }
        Shape::Intervals { y, low, high } => {
            let [y, low, high] = shortest([y, low, high]);
            let end = |x: f64| frame.x_px(x).clamp(-20.0, frame.width + 20.0);
            let bars = (0..y.len()).filter_map(|i| {
                let (y, low, high) = (frame.y_px(y[i]), end(low[i]), end(high[i]));
                (y.is_finite() && !low.is_nan() && !high.is_nan()).then_some((y, low, high))
            });
            let path = strokes(bars, frame.height, Some(4.0), true);
            ink.stroked("line", path, layer.width, out);
        }
        Shape::Band { x, low, high } => {
            let [x, low, high] = shortest([x, low, high]);
            ink.area(band(x, low, high, frame), out);
        }
        Shape::HLine(y) => {
            let y = frame.y_px(*y);
            ink.across(&[(0.0, y), (frame.width, y)], out);
        }
        Shape::VLine(x) => {
            let x = frame.x_px(*x);
            ink.across(&[(x, 0.0), (x, frame.height)], out);
        }
        Shape::HBand(a, b) => {
            if let (Some(a), Some(b)) = (frame.edge(*a), frame.edge(*b)) {
                ink.area(
                    outline(&[(0.0, a), (frame.width, a), (frame.width, b), (0.0, b)]),
                    out,
                );
            }
        }
        Shape::VBand(a, b) => {
            let end = |x: f64| frame.x_px(x).clamp(-20.0, frame.width + 20.0);
            let (a, b) = (end(*a), end(*b));
            if !a.is_nan() && !b.is_nan() {
                ink.area(
                    outline(&[(a, 0.0), (b, 0.0), (b, frame.height), (a, frame.height)]),
                    out,
                );
            }
        }
        Shape::Note { x, y } => {
            if let (Some((x, y)), Some(text)) = (frame.place(*x, *y), &layer.label) {
                ink.note(x, y, frame.width, text, out);
            }
        }
    }
}

struct Ink<'a> {
    layer: &'a Layer,
    class: &'static str,
}

impl Ink<'_> {
    fn stroked(&self, kind: &str, data: String, width: f64, out: &mut String) {
        if data.is_empty() {
            return;
        }
        let (class, width) = (self.class, size(width));
        let (opacity, dash) = (self.opacity(), dashes(self.layer.dash, width));
        out.push_str(&format!(
            "<path class=\"{kind} {class}\" stroke-width=\"{width}\"{opacity}{dash} d=\"{data}\"/>\n"
        ));
    }

    fn opacity(&self) -> String {
        match share(self.layer.opacity) {
            1.0 => String::new(),
            opacity => format!(" opacity=\"{opacity}\""),
        }
    }

    fn trace(&self, trace: Trace, out: &mut String) {
        match trace {
            Trace::Path(data) => self.stroked("line", data, self.layer.width, out),
            // A cell is a little higher than its row, so that rows join without seams.
            Trace::Cells(data) => self.stroked("bars", data, 1.15, out),
        }
    }

    fn cloud(&self, cloud: Cloud, out: &mut String) {
        match cloud {
            Cloud::Dots(data) => self.stroked("line", data, self.layer.width, out),
            Cloud::Density(cell, levels) => {
                out.push_str(&format!(
                    "<g class=\"bars {}\" stroke-width=\"{cell}\">",
                    self.class
                ));
                for (opacity, data) in levels {
                    out.push_str(&format!("<path opacity=\"{opacity}\" d=\"{data}\"/>"));
                }
                out.push_str("</g>\n");
            }
        }
    }

    fn area(&self, data: String, out: &mut String) {
        if !data.is_empty() {
            let (class, opacity) = (self.class, self.opacity());
            out.push_str(&format!(
                "<path class=\"area {class}\"{opacity} d=\"{data}\"/>\n"
            ));
        }
    }

    fn across(&self, ends: &[(f64, f64); 2], out: &mut String) {
        if ends.iter().all(|(x, y)| x.is_finite() && y.is_finite()) {
            let mut path = Path::new();
            path.move_to(ends[0].0, ends[0].1);
            path.line_to(ends[1].0, ends[1].1);
            self.stroked("line", path.into_data(), self.layer.width, out);
        }
    }

    /// Text beside a place, on the side where there is room.
    fn note(&self, x: f64, y: f64, width: f64, text: &Text, out: &mut String) {
        let left = x + 6.0 + text.width(12.0) > width;
        let (x, anchor) = if left {
            (x - 6.0, " text-anchor=\"end\"")
        } else {
            (x + 6.0, "")
        };
        let (x, y) = (round(x), round(y - 5.0));
        out.push_str(&format!(
            "<text class=\"note {}\" x=\"{x}\" y=\"{y}\"{anchor}>",
            self.class
        ));
        text.push_svg(out);
        out.push_str("</text>\n");
    }
}

/// A finite number of px with one decimal.
pub(crate) fn round(px: f64) -> f64 {
    let tenths = (px.clamp(-1e5, 1e5) * 10.0).round();
    if tenths.is_nan() || tenths == 0.0 {
        0.0
    } else {
        tenths / 10.0
    }
}

/// A stroke width or diameter that can be seen.
fn size(px: f64) -> f64 {
    if px.is_nan() {
        1.0
    } else {
        round(px.clamp(0.2, 100.0))
    }
}

fn share(opacity: f64) -> f64 {
    if opacity.is_nan() {
        1.0
    } else {
        (opacity.clamp(0.0, 1.0) * 100.0).round() / 100.0
    }
}

pub(crate) fn dashes(dash: Dash, width: f64) -> String {
    let (on, off) = match dash {
        Dash::Solid => return String::new(),
        Dash::Dashed => (round(4.0 * width), round(3.5 * width)),
        Dash::Dotted => (0.1, round(2.6 * width)),
    };
    format!(" stroke-dasharray=\"{on} {off}\"")
}

/// Four fifths of the closest spacing.
fn bar_width(x: &[f64], frame: &Frame) -> f64 {
    let px: Vec<f64> = x
        .iter()
        .map(|x| frame.x_px(*x))
        .filter(|x| x.is_finite())
        .collect();
    let gaps = px
        .windows(2)
        .map(|w| (w[1] - w[0]).abs())
        .filter(|gap| *gap > 0.0);
    (0.8 * gaps.fold(f64::INFINITY, f64::min)).clamp(1.0, 40.0)
}

/// Path data of strokes with caps of a half-length at both ends; `sideways` swaps the axes.
fn strokes(
    bars: impl Iterator<Item = Stroke> + Clone,
    extent: f64,
    cap: Option<f64>,
    sideways: bool,
) -> String {
    let many = bars.clone().nth(MAX_STROKES).is_some();
    let mut merged: Vec<Option<Stroke>> = Vec::new();
    if many {
        merged.resize(extent.ceil().max(1.0) as usize, None);
        for (at, low, high) in bars.clone().filter(|(at, ..)| (0.0..extent).contains(at)) {
            let (low, high) = (low.min(high), low.max(high));
            let stroke = merged[at as usize].get_or_insert((at.floor() + 0.5, low, high));
            (stroke.1, stroke.2) = (stroke.1.min(low), stroke.2.max(high));
        }
    }
    let mut path = Path::new();
    let mut write = |(at, low, high): Stroke| {
        let mut segment = |a: (f64, f64), b: (f64, f64)| {
            let turn = |p: (f64, f64)| if sideways { (p.1, p.0) } else { p };
            let (a, b) = (turn(a), turn(b));
            path.move_to(a.0, a.1);
            path.line_to(b.0, b.1);
        };
        segment((at, low), (at, high));
        if let Some(cap) = cap.filter(|_| !many) {
            segment((at - cap, low), (at + cap, low));
            segment((at - cap, high), (at + cap, high));
        }
    };
    if many {
        merged.into_iter().flatten().for_each(&mut write);
    } else {
        bars.filter(|(at, ..)| (-50.0..extent + 50.0).contains(at))
            .for_each(&mut write);
    }
    path.into_data()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::Axis;

    fn frame() -> Frame {
        let map = Map::new(&Axis::new("", "").range(0.0, 10.0), None, 0.0, false);
        Frame {
            x: map,
            y: map,
            width: 100.0,
            height: 100.0,
        }
    }

    fn drawn(layer: Layer) -> String {
        let mut out = String::new();
        draw(&layer, &frame(), &mut out);
        out
    }

    fn data(layer: Layer) -> String {
        let svg = drawn(layer);
        let path = svg.split(" d=\"").nth(1).unwrap_or("");
        path.split('"').next().unwrap_or("").to_string()
    }

    #[test]
    fn steps_hold_the_value() {
        assert_eq!(
            data(Layer::steps([0.0, 5.0, 10.0], [1.0, 3.0, 2.0])),
            "m0 90h50v-20h50v10"
        );
    }

    #[test]
    fn open_bands_reach_the_end_of_the_axis() {
        let band = Layer::band([0.0, 10.0], [-f64::INFINITY, 2.0], [5.0, f64::INFINITY]);
        assert_eq!(data(band), "m0 50 100-70v100l-100 40z");
    }

    #[test]
    fn bands_break_and_sort() {
        let x = [6.0, 0.0, 2.0, 8.0, 4.0];
        let band = Layer::band(x, [1.0, 1.0, 1.0, 1.0, f64::NAN], [2.0; 5]);
        // From 0 to 2 and from 6 to 8, both from 2 down to 1.
        assert_eq!(data(band), "m0 80h20v10h-20zm60 0h20v10h-20z");
    }

    #[test]
    fn the_shortest_column_counts() {
        assert_eq!(data(Layer::line([0.0, 1.0, 2.0], [0.0, 0.0])), "m0 100h10");
    }

    #[test]
    fn half_a_million_bars_are_merged_by_pixel() {
        let n = 500_000;
        let x: Vec<f64> = (0..n).map(|i| 10.0 * i as f64 / n as f64).collect();
        let mut y = vec![1.0; n];
        y[250_000] = 9.0;
        let data = data(Layer::bars(x, y));
        assert!(data.len() < 2000 && data.contains("v90"), "{data}");
    }

    #[test]
    fn nothing_to_show_draws_nothing() {
        for layer in [
            Layer::line([], []),
            Layer::points([f64::NAN], [1.0]),
            Layer::hline(f64::INFINITY),
            Layer::vband(f64::NAN, 1.0),
            Layer::band([1.0], [1.0], [2.0]),
        ] {
            assert_eq!(drawn(layer), "");
        }
    }
}
