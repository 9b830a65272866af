//! How a search went: what it found by itself, and the least squares after it.

use stiction_files::result::{SearchedEntry, SearchedPoint};
use stiction_files::symbols;
use stiction_number::Percent;
use stiction_report::{Align, Axis, Block, Color, Figure, Layer, Panel, Table, Text, number};
use stiction_workflows::identify::Outcome;

pub(super) fn sections(outcome: &Outcome) -> Vec<Block> {
    let searches = outcome.result.searches();
    searches
        .flat_map(|entry| {
            [
                Block::Heading(2, Text::from(heading(entry))),
                Block::Paragraph(Text::from(told(entry))),
                stages(outcome, entry).into(),
                convergence(entry).into(),
            ]
        })
        .collect()
}

fn heading(entry: &SearchedEntry) -> &'static str {
    match entry.cost.as_str() {
        "curve" => "The search for the steady curve",
        "dynamic" => "The search for σ₀ and σ₁",
        _ => "The search",
    }
}

fn told(entry: &SearchedEntry) -> String {
    let then = match entry.cost.as_str() {
        "curve" => "minimise the same loss, which counts points that lie off the curve less",
        "dynamic" => "follow the search, the steady curve held",
        _ => "fit everything at once, a delay included",
    };
    format!(
        "{} over {} unknowns ({} cost), ended: {}, after {} evaluations of all samples. The parameters of this report are \
         those after the last least squares, which {then}.",
        entry.method,
        entry.unknowns.len(),
        entry.cost,
        entry.status,
        number::count(entry.evaluations.full_records.round() as u64),
    )
}

/// Cost and parameters by the search itself, after its descents, and in the end.
fn stages(outcome: &Outcome, entry: &SearchedEntry) -> Table {
    let mut table = Table::new([
        ("", Align::Left),
        ("Search itself", Align::Right),
        ("After its descents", Align::Right),
        ("In the end", Align::Right),
    ])
    .caption("What each stage found. Relative error: 100 rms(residual) / rms(measured).");
    let points = [&entry.own, &entry.after_least_squares];
    let cell = |point: &Option<SearchedPoint>, f: &dyn Fn(&SearchedPoint) -> Option<String>| {
        point.as_ref().and_then(f).unwrap_or_else(|| "–".into())
    };
    let [a, b] = points.map(|p| {
        cell(p, &|p| {
            Some(Percent::error(100.0 * p.cost.sqrt()).digits(5))
        })
    });
    // Results do not give the cost of the last least squares of a step.
    let last = match entry.cost.as_str() {
        "curve" | "dynamic" => "–".into(),
        _ => Percent::error(outcome.result.fit.relative_error_percent).digits(5),
    };
    table = table.row([
        Text::from("Relative error"),
        a.into(),
        b.into(),
        last.into(),
    ]);
    for p in &outcome.result.parameters {
        let [a, b] = points.map(|point| {
            cell(point, &|point| {
                let found = point.parameters.iter().find(|x| x.name == p.name)?;
                Some(number::sig(found.value, 5))
            })
        });
        let held = entry.cost == "dynamic" && !entry.unknowns.contains(&p.name);
        if held || (a == "–" && b == "–") {
            continue;
        }
        let name = symbols::meaning(&p.name, outcome.motion);
        let last = format!("{} {}", number::sig(p.value, 5), number::unit(&p.unit));
        table = table.row([name.into(), a.into(), b.into(), Text::from(last)]);
    }
    table
}

/// Best cost and the spread of the population against evaluations.
fn convergence(entry: &SearchedEntry) -> Figure {
    let mut panel = Panel::new(
        Axis::new("Evaluations of the full record", "").log(),
        Axis::new("Cost J", "").log(),
    );
    let at = |q: usize| -> Vec<f64> {
        let generations = entry.generations.iter();
        generations
            .map(|(_, quartiles)| quartiles.get(q).copied().flatten().unwrap_or(f64::NAN))
            .collect()
    };
    if !entry.generations.is_empty() {
        let x: Vec<f64> = entry.generations.iter().map(|(n, _)| *n).collect();
        panel = panel
            .layer(
                Layer::band(x.clone(), at(1), at(3))
                    .color(Color::Grey)
                    .label("Population, quartiles"),
            )
            .layer(Layer::line(x, at(2)).color(Color::Grey).label("Median"));
    }
    let (x, y): (Vec<f64>, Vec<f64>) = entry.history.iter().copied().unzip();
    panel = panel.layer(Layer::steps(x, y).color(Color::Blue).label("Best so far"));
    Figure::new("Convergence of the search").panel(panel)
}
