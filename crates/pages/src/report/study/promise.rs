//! What the identification of an axis allows to promise of its compensation.

use stiction_files::study::result::{PromiseEntry, StudyFile};
use stiction_number::Percent;
use stiction_report::{
    Axis, Block, Callout, Color, Figure, KeyFigure, Layer, Panel, Severity, Text,
};

/// Most entries that have a key figure.
const MOST_KEY_FIGURES: usize = 12;

/// What is left of the error, as an interval: `12–21 %`.
pub(crate) fn left([least, most]: [f64; 2]) -> String {
    let fine = if most - least < 2.0 { 1 } else { 0 };
    let text = |x: f64| Percent::error(x).decimals(fine).replace('-', "−");
    let (least, most) = (text(least), text(most));
    if least == most {
        return most;
    }
    format!("{}–{most}", least.trim_end_matches(" %"))
}

/// What an entry promises; where the interval reaches 100 %, nothing.
pub(crate) fn said(entry: &PromiseEntry) -> String {
    let (error, left) = (error(entry), left(entry.left90_percent));
    if entry.left90_percent[0] >= 100.0 {
        format!("no reduction: {error} at {left} of that without compensation")
    } else if entry.left90_percent[1] >= 100.0 {
        format!("no reduction promised: {error} at {left} of that without compensation")
    } else {
        format!("promised: {error} reduced to {left}")
    }
}

/// The error that a promise is about.
pub(crate) fn error(entry: &PromiseEntry) -> &'static str {
    match entry.metric.as_str() {
        "contour_peak" => "largest contour error",
        _ => "largest tracking error",
    }
}

/// The compensator that promises most on each path under each controller.
pub(crate) fn best(file: &StudyFile) -> Vec<&PromiseEntry> {
    let same =
        |a: &PromiseEntry, b: &PromiseEntry| (&a.path, &a.controller) == (&b.path, &b.controller);
    let most = |entry: &&PromiseEntry| entry.left90_percent[1];
    let best = |all: &'_ [PromiseEntry]| -> usize {
        let ends = all.iter().map(|entry| most(&entry)).enumerate();
        ends.min_by(|a, b| a.1.total_cmp(&b.1))
            .map_or(0, |(i, _)| i)
    };
    let groups = file.promise.chunk_by(same);
    groups.map(|all| &all[best(all)]).collect()
}

/// What to do where nothing is promised.
pub(crate) fn lacking(reason: &str) -> String {
    format!(
        "Nothing is promised: {reason}. What follows is how it would be if the axis were exactly the model. A promise takes a log of \
         the axis; where the model is of one, a longer one, with more motion both ways (docs/procedures.md): identify it, and simulate \
         the study.toml beside its model."
    )
}

/// The promise of the report, before everything else.
pub(super) fn blocks(file: &StudyFile) -> Vec<Block> {
    if let Some(reason) = &file.not_promised {
        return vec![Block::from(callout(Severity::Warning, lacking(reason)))];
    }
    let best = best(file);
    let Some(first) = best.first() else {
        return Vec::new();
    };
    let text = format!(
        "{}{} (90 % interval of {} draws, under the controller of the study).",
        match first.left90_percent[1] >= 100.0 {
            true => capital(&said(first)),
            false => format!("{} of that without compensation", capital(&said(first))),
        },
        match best.len() {
            1 => format!(", with {}", first.scheme()),
            _ => format!(
                ", {}, {}, with {}",
                first.path,
                first.controller,
                first.scheme()
            ),
        },
        first.draws
    );
    let worse = best.iter().any(|entry| entry.left90_percent[1] >= 100.0);
    let severity = if worse {
        Severity::Warning
    } else {
        Severity::Good
    };
    let figures = best.iter().take(MOST_KEY_FIGURES).map(|entry| {
        let value = left(entry.left90_percent);
        let title = format!("{}, {}", entry.path, entry.controller);
        let note = format!("of the {}, {}; 90 % interval", error(entry), entry.scheme());
        KeyFigure::new(title, value.trim_end_matches(" %").to_string(), "% left").note(note)
    });
    vec![
        Block::from(callout(severity, text)),
        Block::KeyFigures(figures.collect()),
        Block::from(figure(file)),
    ]
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}

fn callout(severity: Severity, text: String) -> Callout {
    Callout {
        severity,
        code: String::new(),
        text: Text::from(text),
        link: String::new(),
    }
}

/// All intervals, and what would be if the axis were exactly the model.
fn figure(file: &StudyFile) -> Figure {
    let entries: Vec<&PromiseEntry> = file.promise.iter().collect();
    let modelled = entries.iter().map(|entry| {
        let of = |compensator: &str, coupled: bool| {
            let row = file.results.iter().find(|r| {
                r.parameters == "exact"
                    && (&r.path, &r.controller) == (&entry.path, &entry.controller)
                    && (r.compensator.as_str(), r.coupled) == (compensator, coupled)
            });
            row.and_then(|r| r.metric(&entry.metric))
                .map_or(f64::NAN, |m| m.mean)
        };
        100.0 * of(&entry.compensator, entry.coupled) / of("none", false)
    });
    let place: Vec<f64> = (0..entries.len()).map(|i| i as f64).collect();
    let names = entries
        .iter()
        .map(|entry| format!("{}, {}, {}", entry.path, entry.controller, entry.scheme()));
    let end = |i: usize| {
        entries
            .iter()
            .map(|entry| entry.left90_percent[i])
            .collect::<Vec<_>>()
    };
    let panel = Panel::new(
        Axis::new("Largest error, of that without compensation", "%"),
        Axis::names(names.collect::<Vec<_>>()),
    )
    .layer(
        Layer::intervals(place.clone(), end(0), end(1))
            .color(Color::Blue)
            .label("Promised, 90 %"),
    )
    .layer(
        Layer::points(modelled.collect::<Vec<_>>(), place)
            .color(Color::Grey)
            .width(7.0)
            .opacity(1.0)
            .label("If the axis were exactly the model"),
    )
    .layer(Layer::vline(0.0))
    .layer(Layer::vline(100.0))
    .height((34.0 * entries.len() as f64 + 20.0).max(90.0));
    Figure::new("What compensation leaves").panel(panel).caption(
        "Each draw is an axis with parameters from the covariance of the identification and, beside its law, forces of the size \
         of what the law left of the log; the compensator has the parameters of the model.",
    )
}
