//! What a sweep shows: the error that counts over the value that is swept.

use super::axis::motion;
use super::rows::COLORS;
use stiction_files::study::result::{StudyFile, SweepEntry, SweepMetric, SweepRow};
use stiction_files::symbols;
use stiction_number::{prefixed, quantity};
use stiction_report::{Align, Axis, Document, Figure, Layer, Panel, Severity, Table, Text};

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
    let (x, per_x) = spread(label, &sweep.unit, &sweep.values);
    let (y, per_y) = spread(words, unit, &errors);
    let mut panel = Panel::new(x, y).height(240.0);
    for (row, color) in rows.iter().zip(COLORS) {
        let Some(metric) = judged(row) else { continue };
        let points = sweep.values.iter().zip(&metric.values);
        let points = points.filter_map(|(x, y)| Some((x / per_x, (*y)? / per_y)));
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

/// An axis for values in SI and what they are divided by on it; logarithmic where they go over decades, in the unit whose
/// prefix suits the largest then.
fn spread(label: &str, unit: &str, values: &[f64]) -> (Axis, f64) {
    let ends = values
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(low, high), x| {
            (low.min(*x), high.max(*x))
        });
    if ends.0 <= 0.0 || ends.1 < LOGARITHMIC_FROM * ends.0 {
        return (Axis::new(label, unit), 1.0);
    }
    let power = 3 * (libm::log10(ends.1) / 3.0).floor() as i32;
    let power = power.min(0);
    match prefixed(unit, power) {
        Some(unit) => (Axis::new(label, unit).log(), libm::exp10(f64::from(power))),
        None => (Axis::new(label, unit).log(), 1.0),
    }
}

/// Whether a compensator tracks worse than none with the value of this place.
fn worse(rows: &[SweepRow], i: usize) -> bool {
    let at = |row: &SweepRow| judged(row).and_then(|m| m.values[i]);
    let without = rows.first().and_then(at);
    without.is_some_and(|without| rows.iter().filter_map(at).any(|x| x > without))
}

/// How many values there are, over all paths and controllers, with which a compensator tracks worse than none.
pub(super) fn count_worse(file: &StudyFile) -> usize {
    let each = file.sweeps.iter().flat_map(|sweep| {
        let groups = groups(sweep).into_iter();
        groups.map(|rows| (0..sweep.values.len()).filter(|i| worse(rows, *i)).count())
    });
    each.sum()
}

fn table(sweep: &SweepEntry, rows: &[SweepRow]) -> Table {
    let shown = &rows[..rows.len().min(COLORS.len())];
    let lines = lines(sweep, shown);
    let names = lines[0].iter().skip(1).map(String::as_str);
    let header: Vec<_> = std::iter::once("Value")
        .chain(names)
        .map(|text| (text, Align::Right))
        .collect();
    let table = Table::new(header)
        .caption("The same in numbers; marked where a compensator tracks worse than none.");
    lines[1..]
        .iter()
        .enumerate()
        .fold(table, |table, (i, line)| {
            let cells = line.iter().map(|cell| Text::from(cell.as_str()));
            match worse(rows, i) {
                true => table.marked(Severity::Warning, cells),
                false => table.row(cells),
            }
        })
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => String::new(),
    }
}
