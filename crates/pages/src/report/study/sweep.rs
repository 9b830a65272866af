//! What a sweep shows: the error that counts over the value that is swept.

use super::axis::motion;
use super::rows::COLORS;
use stiction_files::study::result::{StudyFile, SweepEntry, SweepMetric, SweepRow};
use stiction_files::symbols;
use stiction_number::quantity;
use stiction_report::{Align, Axis, Document, Figure, Layer, Panel, Table, Text};

/// Most paths and controllers of a sweep that are shown.
const MOST_SHOWN: usize = 12;
/// Ratio of the ends of an axis from which on it is logarithmic, dimensionless.
const LOGARITHMIC_FROM: f64 = 20.0;

/// The metric by which compensators are compared.
fn judged(row: &SweepRow) -> Option<&SweepMetric> {
    row.metric("contour_peak")
        .or_else(|| row.metric("peak_error"))
}

/// What is swept, in words: `stiffness of the bristles σ₀`, `amplitude of the path`.
pub(crate) fn label(file: &StudyFile, sweep: &SweepEntry) -> String {
    match sweep.key.rsplit_once('.') {
        Some(("law", name)) => {
            let meaning = symbols::meaning(name, motion(&file.axis));
            format!("{meaning} {}", symbols::symbol(name))
        }
        Some((table, key)) => format!(
            "{} of the {}",
            key.replace('_', " "),
            table.replace('.', ", ")
        ),
        None => sweep.key.clone(),
    }
}

/// The rows of each path and controller.
pub(crate) fn groups(sweep: &SweepEntry) -> Vec<&[SweepRow]> {
    let same = |a: &SweepRow, b: &SweepRow| (&a.path, &a.controller) == (&b.path, &b.controller);
    sweep.results.chunk_by(same).collect()
}

/// The errors of a path and controller in words: a header of compensators, and a line for each value.
pub(crate) fn lines(sweep: &SweepEntry, rows: &[SweepRow]) -> Vec<Vec<String>> {
    let header = rows.iter().map(SweepRow::scheme);
    let mut lines = vec![std::iter::once("value".into()).chain(header).collect()];
    for (i, value) in sweep.values.iter().enumerate() {
        let cell = |row: &SweepRow| {
            let found = judged(row).and_then(|m| Some(quantity(m.values[i]?, &m.unit)));
            found.unwrap_or_else(|| "n/a".into())
        };
        let value = quantity(*value, &sweep.unit);
        lines.push(
            std::iter::once(value)
                .chain(rows.iter().map(cell))
                .collect(),
        );
    }
    lines
}

/// The sections of all sweeps.
pub(super) fn sections(mut document: Document, file: &StudyFile) -> Document {
    for sweep in &file.sweeps {
        let label = capital(&label(file, sweep));
        document = document.heading(2, format!("Influence: {label}"));
        for rows in groups(sweep).into_iter().take(MOST_SHOWN) {
            document = document
                .block(figure(&label, sweep, rows))
                .block(table(sweep, rows));
        }
    }
    document
}

/// What is said where not all is shown.
fn left_out(sweep: &SweepEntry, rows: &[SweepRow]) -> String {
    let groups = groups(sweep).len();
    let mut text = String::new();
    if rows.len() > COLORS.len() {
        text += &format!(" {} of {} compensators.", COLORS.len(), rows.len());
    }
    if groups > MOST_SHOWN {
        text += &format!(
            " {MOST_SHOWN} of {groups} paths and controllers are shown; study.json has all."
        );
    }
    text
}

fn figure(label: &str, sweep: &SweepEntry, rows: &[SweepRow]) -> Figure {
    let metric = rows.iter().find_map(judged);
    let unit = metric.map_or("", |m| m.unit.as_str());
    let words = match metric.is_some_and(|m| m.name == "contour_peak") {
        true => "Largest contour error",
        false => "Largest error",
    };
    let found = rows.iter().filter_map(judged).flat_map(|m| &m.values);
    let errors: Vec<f64> = found.copied().flatten().collect();
    let x = spread(Axis::new(label, sweep.unit.as_str()), &sweep.values);
    let y = spread(Axis::new(words, unit), &errors);
    let mut panel = Panel::new(x, y).height(240.0);
    for (row, color) in rows.iter().zip(COLORS) {
        let Some(metric) = judged(row) else { continue };
        let points = sweep.values.iter().zip(&metric.values);
        let points = points.filter_map(|(x, y)| Some((*x, (*y)?)));
        let (x, y): (Vec<f64>, Vec<f64>) = points.unzip();
        panel = panel
            .layer(
                Layer::line(x.clone(), y.clone())
                    .color(color)
                    .label(row.scheme()),
            )
            .layer(Layer::points(x, y).color(color).width(5.0).opacity(1.0));
    }
    Figure::new(format!("{}, {}", rows[0].path, rows[0].controller))
        .panel(panel)
        .caption(format!(
            "Every point is a run of the whole study with that value; controllers tuned by a bandwidth and the compensators \
             know it.{}",
            left_out(sweep, rows)
        ))
}

/// Logarithmic where the values go over decades.
fn spread(axis: Axis, values: &[f64]) -> Axis {
    let ends = values
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(low, high), x| {
            (low.min(*x), high.max(*x))
        });
    match ends.0 > 0.0 && ends.1 >= LOGARITHMIC_FROM * ends.0 {
        true => axis.log(),
        false => axis,
    }
}

fn table(sweep: &SweepEntry, rows: &[SweepRow]) -> Table {
    let rows = &rows[..rows.len().min(COLORS.len())];
    let lines = lines(sweep, rows);
    let header = lines[0].iter().map(|text| (capital(text), Align::Right));
    let header: Vec<_> = header.collect();
    let header = header.iter().map(|(text, align)| (text.as_str(), *align));
    lines[1..].iter().fold(
        Table::new(header).caption("The same in numbers."),
        |table, line| table.row(line.iter().map(|cell| Text::from(cell.as_str()))),
    )
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => String::new(),
    }
}
