//! Rows and pictures of two axes on a contour.

use super::rows::{COLORS, believed, drawn, is_worse, left_out, less};
use stiction_files::study::result::ResultRow;
use stiction_files::symbols;
use stiction_log::Motion;
use stiction_number::quantity;
use stiction_report::{
    Align, Axis, Block, Color, Dash, Figure, Layer, Panel, Severity, Table, Text, number,
};
use stiction_workflows::study::{ContourTrace, Plane, StudyOutcome};

/// Height of the picture of the contour, and of the deviation beside it, px.
const PICTURE_HEIGHT: f64 = 340.0;

/// Whether rows are of a contour.
pub(super) fn is_contour(rows: &[ResultRow]) -> bool {
    rows[0].metric("contour_peak").is_some()
}

pub(super) fn table(rows: &[ResultRow]) -> Table {
    let circular = rows[0].metric("circular_deviation").is_some();
    let mut columns = vec![
        ("Compensator", Align::Left),
        ("Parameters", Align::Left),
        ("Rms", Align::Right),
        ("Largest", Align::Right),
    ];
    if circular {
        columns.push(("Circular", Align::Right));
    }
    columns.extend([
        ("x at reversals", Align::Right),
        ("y at reversals", Align::Right),
        ("Reduction", Align::Right),
    ]);
    // One run is its own worst.
    let several = rows.iter().any(|row| row.runs > 1);
    if several {
        columns.push(("Worst", Align::Right));
    }
    let mut table = Table::new(columns).caption(
        "Deviation from the contour and tracking errors of both axes, means over the runs of a row. Reduction and worst: of \
         the largest deviation, against the row without compensation. All columns are explained under \u{201c}What the \
         numbers mean\u{201d}.",
    );
    for row in rows {
        let value = |name: &str| {
            // Without reversals there is no error about one.
            let metric = row.metric(name).filter(|m| m.largest > 0.0);
            Text::from(metric.map_or("–".into(), |m| quantity(m.mean, &m.unit)))
        };
        let less = |x: Option<f64>| Text::from(x.map_or("–".into(), less));
        let without = row.compensator == "none" && !row.coupled;
        let judged = row.metric("contour_peak").filter(|_| !without);
        let worst = judged.and_then(|m| m.worst_reduction_percent);
        let mut cells = vec![
            Text::from(row.scheme()),
            Text::from(believed(row)),
            value("contour_rms"),
            value("contour_peak"),
        ];
        if circular {
            cells.push(value("circular_deviation"));
        }
        cells.extend([
            value("reversal_peak_x"),
            value("reversal_peak_y"),
            less(judged.and_then(|m| m.reduction_percent)),
        ]);
        if several {
            cells.push(less(worst.filter(|_| row.runs > 1)));
        }
        table = if is_worse(worst) {
            table.marked(Severity::Warning, cells)
        } else {
            table.row(cells)
        };
    }
    table
}

/// The contour with its deviations magnified, beside the deviations over time.
pub(super) fn figures(outcome: &StudyOutcome, rows: &[ResultRow]) -> Option<Block> {
    let (rows, all) = drawn(rows);
    let traces: Vec<(String, &ContourTrace)> = rows
        .iter()
        .filter_map(|r| Some((r.scheme(), outcome.contour(r)?)))
        .collect();
    let drawn: Vec<&ContourTrace> = traces.iter().map(|(_, trace)| *trace).collect();
    let drawn = Plane::of(&drawn)?;
    let length = symbols::length_unit(match outcome.file.axis.kind.as_str() {
        "rotary" => Motion::Rotary,
        _ => Motion::Linear,
    });
    let side = |i: usize| {
        let reach = 0.7 * drawn.size;
        let middle = drawn.middle[i];
        Axis::new(["x", "y"][i], length).range(middle - reach, middle + reach)
    };
    let mut plane = Panel::new(side(0), side(1)).square();
    plane = plane.layer(
        Layer::line(drawn.reference.x, drawn.reference.y)
            .color(Color::Blue)
            .dash(Dash::Dotted)
            .label("Reference"),
    );
    let time = Axis::new("Time", "s");
    let mut course = Panel::new(time, Axis::new("Contour error", length)).height(PICTURE_HEIGHT);
    for (((name, trace), line), color) in traces.iter().zip(drawn.runs).zip(COLORS) {
        plane = plane.layer(
            Layer::line(line.x, line.y)
                .color(color)
                .label(name.as_str()),
        );
        let line = Layer::line(trace.time.clone(), trace.deviation.clone());
        course = course.layer(line.color(color).label(name.as_str()));
    }
    let plane = Figure::new(format!("Deviations × {}", number::sig(drawn.magnified, 1)))
        .half()
        .panel(plane)
        .caption("Drawn from the reference across the contour.");
    let course = Figure::new("Contour error")
        .half()
        .panel(course)
        .caption(format!(
            "Positive where the contour lies to the left of the axes.{}",
            left_out(traces.len(), all)
        ));
    Some(Block::Columns(vec![plane.into(), course.into()]))
}
