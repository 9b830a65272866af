//! The layout of a figure.

use super::axis::{Axis, Map, Range, Scale};
use super::draw::{Frame, draw, round};
use super::layer::{Dash, Layer, Shape};
use super::legend::{Legend, ROW_HEIGHT};
use super::path::Path;
use super::svg;
use super::ticks::Ticks;
use super::{Figure, Panel};
use crate::color::Color;

/// Size of the tick labels, px.
const TICK_SIZE: f64 = 12.0;
/// Margin to the right of the plot, px.
const RIGHT_MARGIN: f64 = 18.0;
/// Distance between two panels, px.
const PANEL_GAP: f64 = 16.0;
/// Sine of the angle at which names are written that are too long to be horizontal.
const SLANT: f64 = 0.5;

pub(crate) fn render(figure: &Figure, place: svg::Place) -> String {
    let width = clamped(figure.width, 240.0, 4000.0, Figure::FULL);
    let panels = resolve(figure, width);
    let left = panels
        .iter()
        .map(|p| p.label_width + 12.0)
        .fold(24.0, f64::max)
        .min(0.45 * width);
    let slanted = panels
        .iter()
        .map(|p| slanted_room(p.x_axis, width - left - RIGHT_MARGIN));
    let left = slanted.fold(left, f64::max).min(0.45 * width);
    let plot_width = round(width - left - RIGHT_MARGIN);
    let last = panels.len().saturating_sub(1);
    let mut content = String::new();
    let mut top = 2.0;
    for (i, mut panel) in panels.into_iter().enumerate() {
        if panel.panel.square {
            panel.height = plot_width;
        }
        let with_x = !figure.shared_x || i == last;
        top = panel.push_svg(&mut content, round(left), round(top), plot_width, with_x);
    }
    let size = (round(width), round(top.max(40.0)).ceil());
    svg::element(
        place,
        size,
        &figure.title.to_plain(),
        &description(figure),
        &content,
    )
}

fn clamped(value: f64, low: f64, high: f64, otherwise: f64) -> f64 {
    if value.is_finite() {
        value.clamp(low, high)
    } else {
        otherwise
    }
}

/// What each panel shows, in words, for readers who cannot see it.
fn description(figure: &Figure) -> String {
    let quantity = |axis: &Axis| match (&axis.scale, axis.unit.as_str()) {
        (Scale::Names(names), _) => names
            .iter()
            .map(|name| name.to_plain())
            .collect::<Vec<_>>()
            .join(", "),
        (_, "") => axis.label.to_plain(),
        (_, unit) => format!("{} in {unit}", axis.label.to_plain()),
    };
    let mut words = vec![figure.caption.to_plain()];
    for panel in &figure.panels {
        let x = if figure.shared_x {
            &figure.panels[0].x
        } else {
            &panel.x
        };
        let labels: Vec<_> = panel
            .layers
            .iter()
            .filter_map(|l| l.label.as_ref().map(|t| t.to_plain()))
            .collect();
        let mut sentence = format!("{} over {}", quantity(&panel.y), quantity(x));
        if !panel.title.is_empty() {
            sentence = format!("{}: {sentence}", panel.title.to_plain());
        }
        if !labels.is_empty() {
            sentence = format!("{sentence}; shown: {}", labels.join(", "));
        }
        words.push(format!("{sentence}."));
    }
    words.retain(|sentence| !sentence.is_empty());
    words.join(" ")
}

/// A panel whose axes have their ranges.
struct Resolved<'a> {
    panel: &'a Panel,
    x_axis: &'a Axis,
    x: Map,
    y: Map,
    y_ticks: Ticks,
    height: f64,
    /// Width of the widest label of the vertical axis, in px.
    label_width: f64,
    /// Whether there is no value to show.
    empty: bool,
}

fn resolve(figure: &Figure, width: f64) -> Vec<Resolved<'_>> {
    let x_map = |layers: &[&Layer], axis: &Axis| {
        let span = span(layers.iter().flat_map(|layer| layer.columns().0), axis);
        Map::new(
            axis,
            span.map(|span| with_bars(span, layers, axis)),
            0.015,
            false,
        )
    };
    let shared = figure
        .panels
        .first()
        .filter(|_| figure.shared_x)
        .map(|panel| {
            let all: Vec<_> = figure
                .panels
                .iter()
                .flat_map(|panel| &panel.layers)
                .collect();
            (&panel.x, x_map(&all, &panel.x))
        });
    let each = figure.panels.iter().map(|panel| {
        let own = || {
            (
                &panel.x,
                x_map(&panel.layers.iter().collect::<Vec<_>>(), &panel.x),
            )
        };
        let (x_axis, x) = shared.unwrap_or_else(own);
        let span = span(
            panel.layers.iter().flat_map(|layer| layer.columns().1),
            &panel.y,
        );
        let y = Map::new(&panel.y, span, 0.06, true);
        let height = round(clamped(panel.height, 40.0, 4000.0, 240.0));
        let y_ticks = Ticks::new(&panel.y, &y, 2 + (height / 32.0) as usize);
        let widths = y_ticks
            .labelled
            .iter()
            .map(|(_, label)| label.width(TICK_SIZE));
        let label_width = widths.fold(0.0, f64::max).min(0.4 * width);
        Resolved {
            panel,
            x_axis,
            x,
            y,
            y_ticks,
            height,
            label_width,
            empty: span.is_none() && panel.y.range == Range::Auto,
        }
    });
    each.collect()
}

/// A horizontal span with the outer halves of the first and the last bar.
fn with_bars((low, high): (f64, f64), layers: &[&Layer], axis: &Axis) -> (f64, f64) {
    let gaps = layers.iter().filter_map(|layer| match &layer.shape {
        Shape::Bars { x, .. } if axis.scale == Scale::Linear => Some(x),
        _ => None,
    });
    let gaps = gaps
        .flat_map(|x| x.windows(2))
        .map(|pair| (pair[1] - pair[0]).abs());
    let closest = gaps.filter(|gap| *gap > 0.0).fold(f64::INFINITY, f64::min);
    if closest < high - low {
        (
            (low - closest / 2.0).max(f64::MIN),
            (high + closest / 2.0).min(f64::MAX),
        )
    } else {
        (low, high)
    }
}

/// The lowest and highest value that can be shown on the axis.
fn span<'a>(columns: impl Iterator<Item = &'a [f64]>, axis: &Axis) -> Option<(f64, f64)> {
    let log = axis.scale == Scale::Log;
    let mut span: Option<(f64, f64)> = None;
    for value in columns
        .flatten()
        .filter(|v| v.is_finite() && (!log || **v > 0.0))
    {
        let (low, high) = span.get_or_insert((*value, *value));
        *low = low.min(*value);
        *high = high.max(*value);
    }
    span
}

impl Resolved<'_> {
    /// Appends the panel below `top`; returns where the next may start.
    fn push_svg(self, out: &mut String, left: f64, top: f64, width: f64, with_x: bool) -> f64 {
        let layers = with_colors(&self.panel.layers);
        let mut base = top;
        if !self.panel.title.is_empty() {
            base += ROW_HEIGHT;
            text(
                out,
                "panel-title",
                left,
                base - 5.0,
                "start",
                &self.panel.title,
            );
        }
        let title_width = 1.05 * self.y_ticks.title.width(TICK_SIZE);
        let legend = Legend::new(&layers, width, title_width);
        if !self.y_ticks.title.is_empty() || legend.rows > 1 {
            text(
                out,
                "axis-title",
                left,
                base + 14.0,
                "start",
                &self.y_ticks.title,
            );
        }
        legend.push_svg(left, base + 14.0, out);
        let plot_top = round(base + legend.rows as f64 * ROW_HEIGHT + 5.0);
        let frame = Frame {
            x: self.x,
            y: self.y,
            width,
            height: self.height,
        };
        let (x_ticks, slanted) = x_ticks(self.x_axis, &frame);
        out.push_str(&format!(
            "<svg x=\"{left}\" y=\"{plot_top}\" width=\"{width}\" height=\"{}\" overflow=\"hidden\">\n",
            self.height
        ));
        grid(
            out,
            &frame,
            (self.x_axis, &x_ticks),
            (&self.panel.y, &self.y_ticks),
        );
        for layer in &layers {
            draw(layer, &frame, out);
        }
        if self.empty {
            let (x, y) = (width / 2.0, self.height / 2.0 + 4.0);
            text(out, "", x, y, "middle", &"No data".into());
        }
        out.push_str("</svg>\n");
        let bottom = round(plot_top + self.height);
        out.push_str(&format!(
            "<path class=\"axis\" d=\"M{left} {plot_top}V{bottom}H{}\"/>\n",
            round(left + width)
        ));
        for (at, label) in &self.y_ticks.labelled {
            let y = plot_top + frame.y_px(*at);
            text(out, "", left - 7.0, y + 4.0, "end", label);
        }
        if !with_x {
            return bottom + PANEL_GAP;
        }
        for (at, label) in &x_ticks.labelled {
            let x = left + frame.x_px(*at);
            if slanted {
                let (x, y) = (round(x + 4.0), round(bottom + 14.0));
                out.push_str(&format!("<g transform=\"translate({x} {y}) rotate(-30)\">"));
                text(out, "", 0.0, 0.0, "end", label);
                out.push_str("</g>");
            } else {
                text(out, "", x, bottom + 17.0, "middle", label);
            }
        }
        let mut bottom = bottom + 24.0;
        if slanted {
            let widest = x_ticks
                .labelled
                .iter()
                .map(|(_, l)| l.width(TICK_SIZE))
                .fold(0.0, f64::max);
            bottom += SLANT * widest;
        }
        if !x_ticks.title.is_empty() {
            text(
                out,
                "axis-title",
                left + width / 2.0,
                bottom + 13.0,
                "middle",
                &x_ticks.title,
            );
            bottom += 19.0;
        }
        bottom + PANEL_GAP - 8.0
    }
}

/// The layers with a colour each: their own, or the next of the cycle. Lines of the second turn of
/// the cycle are dashed, those of further turns dotted.
fn with_colors(layers: &[Layer]) -> Vec<Layer> {
    let mut used = 0;
    let mut layers = layers.to_vec();
    for layer in layers.iter_mut().filter(|layer| layer.color.is_none()) {
        if !layer.is_data() {
            layer.color = Some(Color::Grey);
            continue;
        }
        layer.color = Some(Color::CYCLE[used % Color::CYCLE.len()]);
        let turn = used / Color::CYCLE.len();
        if layer.dash == Dash::Solid && turn > 0 {
            layer.dash = if turn == 1 {
                Dash::Dashed
            } else {
                Dash::Dotted
            };
        }
        used += 1;
    }
    layers
}

/// Room that slanted names need to the left of the plot of `width` px.
fn slanted_room(axis: &Axis, width: f64) -> f64 {
    let Scale::Names(names) = &axis.scale else {
        return 0.0;
    };
    let each = width / names.len().max(1) as f64;
    let reach =
        |i: usize, name: &crate::Text| 0.87 * name.width(TICK_SIZE) - (i as f64 + 0.5) * each;
    let widest = names
        .iter()
        .map(|name| name.width(TICK_SIZE))
        .fold(0.0, f64::max);
    if widest + 12.0 <= each {
        return 0.0;
    }
    names
        .iter()
        .enumerate()
        .map(|(i, name)| reach(i, name) + 8.0)
        .fold(0.0, f64::max)
}

/// As many ticks as have room beside each other, and whether they must be slanted.
fn x_ticks(axis: &Axis, frame: &Frame) -> (Ticks, bool) {
    let fits = |ticks: &Ticks| {
        ticks.labelled.windows(2).all(|pair| {
            let room = frame.x_px(pair[1].0) - frame.x_px(pair[0].0);
            let (a, b) = (pair[0].1.width(TICK_SIZE), pair[1].1.width(TICK_SIZE));
            room >= (a + b) / 2.0 + 12.0
        })
    };
    let mut most = (frame.width / 60.0) as usize;
    loop {
        let ticks = Ticks::new(axis, &frame.x, most);
        if fits(&ticks) {
            return (ticks, false);
        }
        if most <= 2 || matches!(axis.scale, Scale::Names(_)) {
            return (ticks, true);
        }
        most -= 1;
    }
}

fn grid(out: &mut String, frame: &Frame, x: (&Axis, &Ticks), y: (&Axis, &Ticks)) {
    let ((x_axis, x), (y_axis, y)) = (x, y);
    let mut lines = |class: &str, xs: Vec<f64>, ys: Vec<f64>| {
        let mut path = Path::new();
        for x in xs {
            let x = frame.x_px(x).round();
            path.move_to(x, 0.0);
            path.line_to(x, frame.height);
        }
        for y in ys {
            let y = frame.y_px(y).round();
            path.move_to(0.0, y);
            path.line_to(frame.width, y);
        }
        if !path.is_empty() {
            out.push_str(&format!(
                "<path class=\"{class}\" d=\"{}\"/>\n",
                path.into_data()
            ));
        }
    };
    let places = |ticks: &Ticks| ticks.labelled.iter().map(|(at, _)| *at).collect::<Vec<_>>();
    lines("grid minor", x.minor.clone(), y.minor.clone());
    // Names below bars need no line; names beside intervals do.
    let named = matches!(x_axis.scale, Scale::Names(_));
    lines(
        "grid",
        if named { Vec::new() } else { places(x) },
        places(y),
    );
    let zero = |axis: &Axis, map: &Map| {
        let inside = axis.scale == Scale::Linear && map.low < 0.0 && map.high > 0.0;
        if inside { vec![0.0] } else { Vec::new() }
    };
    lines("grid zero", zero(x_axis, &frame.x), zero(y_axis, &frame.y));
}

fn text(out: &mut String, class: &str, x: f64, y: f64, anchor: &str, content: &crate::Text) {
    if content.is_empty() {
        return;
    }
    let class = if class.is_empty() {
        String::new()
    } else {
        format!(" class=\"{class}\"")
    };
    let anchor = match anchor {
        "start" => String::new(),
        anchor => format!(" text-anchor=\"{anchor}\""),
    };
    out.push_str(&format!(
        "<text{class} x=\"{}\" y=\"{}\"{anchor}>",
        round(x),
        round(y)
    ));
    content.push_svg(out);
    out.push_str("</text>\n");
}
