//! The report of a study.

mod axis;
mod contour;
pub(crate) mod exported;
mod load;
pub(crate) mod promise;
pub(crate) mod rates;
pub(crate) mod rows;
pub(crate) mod sweep;

use super::callout;
use axis::{axis, mass_unit, motion, parameters};
use rows::{COLORS, believed, drawn, is_worse, judged, left_out, less, tabled};
use stiction_files::study::result::{MetricEntry, ResultRow, StudyFile};
use stiction_files::symbols;
use stiction_log::Motion;
use stiction_number::quantity;
use stiction_report::{
    Align, Axis, Block, Callout, Color, Document, Figure, KeyFigure, Layer, Panel, Severity, Table,
    Text, number,
};
use stiction_workflows::study::StudyOutcome;
use stiction_workflows::study::doubt::is_misleading;
use stiction_workflows::study::{Course, Trace};

/// Most sections with figures: the rows of the others are in their tables only.
const MOST_SECTIONS_WITH_FIGURES: usize = 16;

/// The report of a study.
pub fn study(outcome: &StudyOutcome) -> Document {
    let file = &outcome.file;
    let mut document = Document::new(format!("Friction compensation: {}", file.name))
        .subtitle(format!(
            "{}, simulated at {} Hz; a {} axis of {} {}{}",
            file.axis.origin,
            number::sig(file.axis.rate_hz, 4),
            file.axis.kind,
            number::sig(file.axis.mass, 4),
            mass_unit(&file.axis),
            file.second_axis.as_ref().map_or(String::new(), |second| {
                let mass = number::sig(second.mass, 4);
                format!(" and one of {mass} {}", mass_unit(second))
            })
        ))
        .footer(format!("stiction {} · seed {}", file.version, file.seed));
    let promise = promise::blocks(file);
    document = promise
        .into_iter()
        .fold(document, |d, block| d.block(block));
    document = document.block(verdict(file));
    for warning in &file.warnings {
        document = document.block(callout(warning));
    }
    let rows = tabled(&file.results);
    let cells: Vec<&[ResultRow]> = rows
        .chunk_by(|a, b| (&a.path, &a.controller) == (&b.path, &b.controller))
        .collect();
    let figured = figured(&cells);
    if file.promise.is_empty() {
        let best = figured.iter().filter_map(|i| best_of(cells[*i]));
        document = document.block(Block::KeyFigures(best.collect()));
    }
    if figured.len() < cells.len() {
        let text = format!(
            "{} of {} motions and controllers have figures: every motion under one controller before any under a second. The \
             tables have all.",
            figured.len(),
            cells.len()
        );
        document = document.paragraph(text);
    }
    for (i, rows) in cells.iter().enumerate() {
        document = document
            .heading(2, format!("{}, {}", rows[0].path, rows[0].controller))
            .block(match contour::is_contour(rows) {
                true => contour::table(rows),
                false => table(rows),
            });
        document = rates::table(rows)
            .into_iter()
            .fold(document, |d, t| d.block(t));
        if figured.contains(&i) && contour::is_contour(rows) {
            let figures = contour::figures(outcome, rows);
            document = figures.into_iter().fold(document, |d, f| d.block(f));
            document = wrong(rows).into_iter().fold(document, |d, f| d.block(f));
        } else if figured.contains(&i) {
            let figures = in_time(outcome, rows).into_iter().chain(wrong(rows));
            document = figures.fold(document, |d, f| d.block(f));
            if let Some((figure, table)) = load::blocks(outcome, rows) {
                document = document.block(figure).block(table);
            }
        }
    }
    if file.exported_c.is_some() {
        document = document.heading(2, "The exported C");
        document = exported::blocks(outcome)
            .into_iter()
            .fold(document, |d, block| d.block(block));
    }
    document = sweep::sections(document, file)
        .heading(2, "The axis")
        .block(axis(file, &file.axis))
        .block(parameters(&file.axis));
    if let Some(second) = &file.second_axis {
        document = document
            .heading(2, "The second axis")
            .block(axis(file, second))
            .block(parameters(second));
    }
    document
        .heading(2, "What the numbers mean")
        .block(Block::List(MEANING.map(Text::from).to_vec()))
}

/// The sections that have figures, in order: every path and contour under its first controller, then under the second, as far as
/// they go.
fn figured(cells: &[&[ResultRow]]) -> Vec<usize> {
    let rank = |i: usize| {
        let before = cells[..i].iter();
        before.filter(|c| c[0].path == cells[i][0].path).count()
    };
    let mut order: Vec<usize> = (0..cells.len()).collect();
    order.sort_by_key(|&i| rank(i));
    order.truncate(MOST_SECTIONS_WITH_FIGURES);
    order.sort_unstable();
    order
}

const MEANING: [&str; 11] = [
    "Errors are reference less true position. What the encoder does not see counts.",
    "Reduction: by how much the largest error is below that without compensation, on the same path and \
     under the same controller.",
    "At reversals: the largest error within 20 ms of a change of direction, or a quarter of the way \
     before and after in time if that is longer.",
    "On a contour the error is the distance to it; coupling is control of that error above both axes. Circular: the least distance of two circles about one centre \
     that hold the whole path between them.",
    "Worst: the reduction with the largest error of all runs of a row, in place of their mean; negative where \
     compensation makes the error larger. A row with one run has none.",
    "Feed error: the largest difference of the velocity along the motion from that of the reference, and its part of the \
     fastest reference. Ripple and at rest: where the reference goes at constant velocity, the rms deviation of the \
     velocity from its mean, in parts of that of the reference, and the share of the time below a tenth of it. It jumps \
     where that would be over 1000 %.",
    "Standing error: the mean error in the second half of a rest after a move. Hunting: half the way between the outermost \
     positions of a limit cycle in a rest of 1 s or more, and the length of a cycle.",
    "Δu: rms change of the commanded force from sample to sample. Still: longest standstill about a \
     reversal.",
    "Promised: what is left of the largest error on axes that are drawn as the identification leaves them open, each \
     compared with itself without compensation. 90 % of further draws lie within the interval.",
    "Axis as modelled: if the axis were exactly the model. What it shows of a compensation is a limit, no promise.",
    "Wrong parameters are those of the compensator; the axis keeps its own. A mass that is drawn \
     with them is the one fed forward.",
];

fn verdict(file: &StudyFile) -> Callout {
    let swept = file.sweeps.iter().map(|s| s.values.len() * s.results.len());
    let runs = file
        .results
        .iter()
        .map(|r| r.runs)
        .chain(swept)
        .sum::<usize>();
    let worse = tabled(&file.results)
        .iter()
        .filter(|r| r.compensator != "none" || r.coupled)
        .filter(|r| judged(r).is_some_and(|m| is_worse(m.worst_reduction_percent)))
        .count();
    let swept_worse = sweep::count_worse(file);
    let (severity, text) = if file.status == "interrupted" {
        let text = format!(
            "Stopped early: {} runs are done.",
            number::count(runs as u64)
        );
        (Severity::Warning, text)
    } else if worse > 0 || swept_worse > 0 {
        let rows = if worse == 1 { "row holds" } else { "rows hold" };
        let values = if swept_worse == 1 { "value" } else { "values" };
        let mut text = format!("{} runs.", number::count(runs as u64));
        if worse > 0 {
            text +=
                &format!(" {worse} {rows} a run that tracks worse with compensation than without.");
        }
        if swept_worse > 0 {
            text += &format!(
                " With {swept_worse} swept {values} a compensator tracks worse than none."
            );
        }
        (Severity::Warning, text + " Marked in the tables.")
    } else if file.warnings.iter().any(is_misleading) {
        let text = format!(
            "{} runs. In no row of the tables did a compensator make the error larger, but some figures are misleading: \
             see the warnings.",
            number::count(runs as u64)
        );
        (Severity::Warning, text)
    } else {
        let text = format!(
            "{} runs. In no row of the tables did a compensator make the error larger.",
            number::count(runs as u64)
        );
        (Severity::Good, text)
    };
    Callout {
        severity,
        code: String::new(),
        text: Text::from(text),
        link: String::new(),
    }
}

/// The compensator that helps most, with the parameters of the axis.
fn best_of(rows: &[ResultRow]) -> Option<KeyFigure> {
    let exact = rows.iter().filter(|r| r.parameters == "exact");
    let reduction = |r: &ResultRow| judged(r).and_then(|m| m.reduction_percent);
    let (row, percent) = exact
        .filter(|r| r.compensator != "none" || r.coupled)
        .filter_map(|r| Some((r, reduction(r)?)))
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    let error = match row.metric("contour_peak") {
        Some(_) => "contour error",
        None => "largest error",
    };
    // The risk of that compensator: its least reduction with wrong parameters.
    let same = |r: &&ResultRow| {
        r.runs > 1 && (r.coupled, &r.compensator) == (row.coupled, &row.compensator)
    };
    let worst = rows.iter().filter(same).filter_map(|r| {
        let metric = judged(r)?;
        Some((r, metric.worst_reduction_percent?))
    });
    let worst = worst.min_by(|a, b| a.1.total_cmp(&b.1));
    let risk = worst.map_or(String::new(), |(r, x)| {
        format!("; {} at the worst of {}", less(x), r.parameters)
    });
    Some(
        KeyFigure::new(
            format!("{}, {}", row.path, row.controller),
            less(percent).trim_end_matches(" %").to_string(),
            "% less",
        )
        .note(format!(
            "{error}, {}, if the axis were exactly the model{risk}",
            row.scheme()
        )),
    )
}

fn table(rows: &[ResultRow]) -> Table {
    // Without reversals there is neither an error nor a standstill about one; one run is its own worst.
    let turns = |row: &ResultRow| row.metric("reversal_peak").is_some_and(|m| m.largest > 0.0);
    let any_turns = rows.iter().any(turns);
    let several = rows.iter().any(|row| row.runs > 1);
    let columns = [
        (true, "Compensator", Align::Left),
        (true, "Parameters", Align::Left),
        (true, "Rms", Align::Right),
        (true, "Largest", Align::Right),
        (any_turns, "At reversals", Align::Right),
        (true, "Reduction", Align::Right),
        (several, "Worst", Align::Right),
        (true, "Δu", Align::Right),
        (any_turns, "Still", Align::Right),
    ];
    let shown = columns.iter().filter(|(shown, ..)| *shown);
    let mut table = Table::new(shown.map(|(_, name, align)| (*name, *align))).caption(
        "Tracking error, means over the runs of a row. Reduction and worst: of the largest error, against the row without \
         compensation. All columns are explained under \u{201c}What the numbers mean\u{201d}.",
    );
    for row in rows {
        let value = |name: &str| {
            let metric = row.metric(name);
            Text::from(metric.map_or("–".into(), |m| quantity(m.mean, &m.unit)))
        };
        let about_turns = |name: &str| {
            if turns(row) {
                value(name)
            } else {
                "–".into()
            }
        };
        let percent = |x: Option<f64>| Text::from(x.map_or("–".into(), less));
        let judged = judged(row).filter(|_| row.compensator != "none");
        let worst = judged.and_then(|m| m.worst_reduction_percent);
        let cells = [
            Text::from(row.compensator.as_str()),
            Text::from(believed(row)),
            value("rms_error"),
            value("peak_error"),
            about_turns("reversal_peak"),
            percent(judged.and_then(|m| m.reduction_percent)),
            percent(worst.filter(|_| row.runs > 1)),
            value("command_change"),
            about_turns("stick_time"),
        ];
        let shown = cells.into_iter().zip(&columns);
        let cells: Vec<Text> = shown
            .filter(|(_, (shown, ..))| *shown)
            .map(|(cell, _)| cell)
            .collect();
        table = if is_worse(worst) {
            table.marked(Severity::Warning, cells)
        } else {
            table.row(cells)
        };
    }
    table
}

/// Error and compensating force with the parameters of the axis: over all that counts, and about a reversal.
fn in_time(outcome: &StudyOutcome, rows: &[ResultRow]) -> Vec<Figure> {
    let (rows, all) = drawn(rows);
    let traces: Vec<&Trace> = rows.iter().filter_map(|r| outcome.trace(r)).collect();
    let motion = motion(&outcome.file.axis);
    let counted = traces.first().and_then(|t| t.whole.time.first()).copied();
    let last = traces.first().and_then(|t| t.whole.time.last()).copied();
    let events = outcome.file.events.iter().map(|e| e.time_s);
    let events: Vec<f64> = events
        .filter(|t| counted.is_some_and(|from| *t >= from) && last.is_some_and(|to| *t <= to))
        .collect();
    let caption = format!(
        "The part of the run that counts, with the parameters of the axis itself.{}",
        left_out(traces.len(), all)
    );
    let mut figures =
        vec![courses("Tracking error", &traces, motion, &|t| &t.whole, &events).caption(caption)];
    if traces.iter().any(|t| !t.reversal.time.is_empty()) {
        let title = "The same about a reversal";
        figures.push(courses(title, &traces, motion, &|t| &t.reversal, &[]));
    }
    figures
}

fn courses(
    title: &str,
    traces: &[&Trace],
    motion: Motion,
    of: &dyn Fn(&Trace) -> &Course,
    events: &[f64],
) -> Figure {
    let length = symbols::length_unit(motion);
    let force = match motion {
        Motion::Linear => "N",
        Motion::Rotary => "N·m",
    };
    let time = || Axis::new("Time", "s");
    let mut reference = Panel::new(time(), Axis::new("Reference", length)).height(80.0);
    let mut error = Panel::new(time(), Axis::new("Error", length)).height(220.0);
    let mut added = Panel::new(time(), Axis::new("Compensating force", force)).height(130.0);
    for (i, (trace, color)) in traces.iter().zip(COLORS).enumerate() {
        let course = of(trace);
        let line = |y: &[f64]| Layer::line(course.time.clone(), y);
        if i == 0 {
            reference = reference.layer(line(&course.reference).color(Color::Grey));
        } else {
            added = added.layer(line(&course.compensation).color(color).width(1.0));
        }
        let line = line(&course.error).color(color);
        error = error.layer(line.label(trace.compensator.as_str()));
    }
    for (i, time) in events.iter().enumerate() {
        let line = Layer::vline(*time);
        error = error.layer(match i {
            0 => line.label("Event"),
            _ => line,
        });
    }
    let figure = Figure::new(title).panel(reference).panel(error).shared_x();
    match traces.len() {
        0 | 1 => figure,
        _ => figure.panel(added),
    }
}

/// What is left of the error with wrong parameters.
fn wrong(rows: &[ResultRow]) -> Option<Figure> {
    let without = rows.first().and_then(judged)?.mean;
    let several: Vec<&ResultRow> = rows.iter().filter(|r| r.runs > 1).collect();
    if several.is_empty() || without == 0.0 {
        return None;
    }
    let share = |x: f64| 100.0 * x / without;
    let of = |f: &dyn Fn(&MetricEntry) -> f64| -> Vec<f64> {
        let metrics = several.iter().filter_map(|r| judged(r));
        metrics.map(|m| share(f(m))).collect()
    };
    let place: Vec<f64> = (0..several.len()).map(|i| i as f64).collect();
    let names = several
        .iter()
        .map(|r| format!("{}, {}", r.scheme(), r.parameters));
    let height = (34.0 * several.len() as f64 + 20.0).max(90.0);
    let panel = Panel::new(
        Axis::new(
            match contour::is_contour(rows) {
                true => "Largest contour error, of that without compensation",
                false => "Largest error, of that without compensation",
            },
            "%",
        ),
        Axis::names(names.collect::<Vec<_>>()),
    )
    .layer(
        Layer::intervals(place.clone(), of(&|m| m.least), of(&|m| m.largest))
            .color(Color::Blue)
            .label("All sets"),
    )
    .layer(
        Layer::points(of(&|m| m.mean), place)
            .color(Color::Vermilion)
            .width(8.0)
            .opacity(1.0)
            .label("Mean"),
    )
    .layer(Layer::vline(100.0))
    .layer(Layer::vline(0.0))
    .height(height);
    Some(
        Figure::new("What wrong parameters leave").panel(panel).caption(
            "From the best to the worst set of parameters; beyond 100 % the axis tracks worse than \
             without compensation.",
        ),
    )
}
