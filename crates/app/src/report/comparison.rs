//! The report of a comparison of methods.

use crate::compare_file::{CompareFile, Course, MethodEntry, Quartiles, Stage};
use stiction_report::{
    Align, Axis, Block, Callout, Color, Dash, Document, Figure, KeyFigure, Layer, Panel, Severity,
    Table, Text, number,
};

/// The genetic algorithms of Zhang et al. 2025, in the order of its figures.
const PAPER: [&str; 3] = ["ga", "adaptive-ga", "annealing-ga"];
/// Least excess over the optimum that a logarithmic axis shows.
const LEAST: f64 = 1e-12;

/// The report.
pub(crate) fn comparison(file: &CompareFile) -> Document {
    let mut document = Document::new(format!("Searches on {}", file.problem))
        .subtitle(format!(
            "{} methods, {} seeds each, {} evaluations",
            file.methods.len(),
            file.seeds,
            number::count(file.evaluations)
        ))
        .footer(format!(
            "stiction {} · {} cost · integrator {} · {} s",
            file.version,
            file.cost,
            file.integrator,
            number::sig(file.wall_s, 3)
        ));
    for callout in callouts(file) {
        document = document.block(callout);
    }
    document = document
        .block(Block::KeyFigures(key_figures(file)))
        .block(Block::Facts(facts(file)))
        .heading(2, "Success")
        .paragraph(
            "Alone is the search by itself within its evaluations. Then least squares follow from its best \
             points, where the cost has derivatives. lm is least squares from the first; niched-ga ends in \
             descents of its own, and alone is what it has before those.",
        )
        .block(success(file))
        .block(rates(file))
        .heading(2, "Convergence")
        .block(overlay(
            file,
            "Best cost against evaluations",
            Axis::new("Evaluations of the full record", "").log(),
            &|m| &m.by_evaluations,
        ))
        .block(overlay(
            file,
            "Best cost against time",
            Axis::new("Time", "s").log(),
            &|m| &m.by_time,
        ))
        .block(Block::Columns(
            file.methods.iter().map(|m| single(file, m).into()).collect(),
        ));
    let paper: Vec<&MethodEntry> = PAPER
        .iter()
        .filter_map(|name| file.methods.iter().find(|m| m.name == *name))
        .collect();
    if !paper.is_empty() {
        document = document.heading(2, "The genetic algorithms of Zhang et al. 2025").paragraph(
            "Our pictures of what its figures 4 to 7 show: how the cost falls in each of the three \
             algorithms, and the three beside each other. The numbers are those of this comparison, \
             the publication's problem is not known.",
        );
        let each = paper.iter().map(|m| population(m).into()).collect();
        document = document
            .block(Block::Columns(each))
            .block(beside(file, &paper));
    }
    if !file.truth.is_empty() {
        document = document
            .heading(2, "Errors of the parameters")
            .paragraph("Median over the seeds of |found / true - 1|.")
            .block(errors(file, "By the search alone", &|m| &m.own));
        if file.least_squares {
            document = document.block(errors(file, "After least squares", &|m| {
                &m.after_least_squares
            }));
        }
    }
    document
}

fn callouts(file: &CompareFile) -> Vec<Callout> {
    let mut out = Vec::new();
    let mut say = |severity, code: &str, text: String| {
        out.push(Callout {
            severity,
            code: code.into(),
            text: Text::from(text),
            link: String::new(),
        });
    };
    if file.status == "interrupted" {
        let text = "Runs that were not complete are left out.";
        say(Severity::Warning, "interrupted", text.into());
    }
    if file.reference.beaten {
        let before = file
            .reference
            .before
            .map_or("no finite cost".into(), |x| number::sig(x, 7));
        say(
            Severity::Info,
            "",
            format!(
                "{} found a lower cost ({}) than the reference search ({before}); all is measured by it.",
                file.reference.by,
                number::sig(file.reference.cost, 7)
            ),
        );
    }
    out
}

fn median(values: &Quartiles) -> f64 {
    values.map_or(f64::NAN, |v| v[1])
}

fn shown(values: &Quartiles, digits: usize) -> String {
    values.map_or("–".into(), |v| number::sig(v[1], digits))
}

fn key_figures(file: &CompareFile) -> Vec<KeyFigure> {
    let mut out = vec![
        KeyFigure::new("Optimum", number::sig(file.reference.cost, 5), "")
            .note(format!("cost J, by {}", file.reference.by)),
    ];
    let full: Vec<&MethodEntry> = (file.methods.iter())
        .filter(|m| !m.runs.is_empty() && m.after_least_squares.successes == m.runs.len())
        .collect();
    out.push(
        KeyFigure::new(
            "Always successful",
            format!("{} of {}", full.len(), file.methods.len()),
            "",
        )
        .note(file.success.as_str()),
    );
    let alone = file.methods.iter();
    let alone = alone
        .filter(|m| !m.runs.is_empty() && m.own.successes == m.runs.len())
        .count();
    out.push(
        KeyFigure::new(
            "Without least squares",
            format!("{alone} of {}", file.methods.len()),
            "",
        )
        .note("methods that always succeed alone"),
    );
    let cheapest = |f: &dyn Fn(&MethodEntry) -> f64| {
        let least = full.iter().filter(|m| f(m).is_finite());
        least.min_by(|a, b| f(a).total_cmp(&f(b))).copied()
    };
    if let Some(m) = cheapest(&|m| median(&m.evaluations_to_success)) {
        out.push(
            KeyFigure::new("Fewest evaluations", m.name.as_str(), "").note(format!(
                "median {} until near the optimum",
                shown(&m.evaluations_to_success, 3)
            )),
        );
    }
    if let Some(m) = cheapest(&|m| median(&m.seconds_to_success)) {
        out.push(
            KeyFigure::new("Least time", m.name.as_str(), "").note(format!(
                "median {} s until near the optimum",
                shown(&m.seconds_to_success, 2)
            )),
        );
    }
    out
}

fn facts(file: &CompareFile) -> Vec<(Text, Text)> {
    let mut out = vec![
        ("Problem", format!("{}: {}", file.problem, file.source)),
        ("Motion", file.motion.clone()),
        ("Samples", number::count(file.samples as u64)),
    ];
    if file.rate_hz > 0.0 {
        out.push(("Rate", format!("{} Hz", number::sig(file.rate_hz, 5))));
    }
    if let Some(noise) = file.noise {
        let text = format!(
            "{} % of the largest value (standard deviation)",
            number::sig(100.0 * noise, 3)
        );
        out.push(("Noise", text));
    }
    let decades = file.box_decades.map_or("that of identify".into(), |d| {
        format!(
            "{} decades to each side of a point off the answer",
            number::sig(d, 3)
        )
    });
    out.push(("Box", decades));
    out.push(("Success", file.success.clone()));
    out.into_iter().map(|(a, b)| (a.into(), b.into())).collect()
}

fn success(file: &CompareFile) -> Table {
    let mut table = Table::new([
        ("Method", Align::Left),
        ("Alone", Align::Right),
        ("With least squares", Align::Right),
        ("Excess alone", Align::Right),
        ("Evaluations to success", Align::Right),
        ("Time to success", Align::Right),
        ("Time of a run", Align::Right),
    ])
    .caption(
        "Runs that succeed, and medians over the seeds. Excess: cost over that of the optimum, less 1. \
         A derivative evaluation counts as one, a coarse one as its share.",
    );
    let seconds = |q: &Quartiles| q.map_or("–".into(), |v| number::si(v[1], "s", 3));
    for m in &file.methods {
        let runs = m.runs.len();
        let cells = [
            m.name.clone(),
            format!("{} of {runs}", m.own.successes),
            format!("{} of {runs}", m.after_least_squares.successes),
            shown(&m.own.excess, 2),
            shown(&m.evaluations_to_success, 3),
            seconds(&m.seconds_to_success),
            seconds(&m.seconds),
        ];
        table = table.row(cells);
    }
    table
}

/// Success rates as a picture.
fn rates(file: &CompareFile) -> Figure {
    let place: Vec<f64> = (0..file.methods.len()).map(|i| i as f64).collect();
    let rate = |stage: fn(&MethodEntry) -> &Stage| -> Vec<f64> {
        let each = file.methods.iter();
        each.map(|m| 100.0 * stage(m).successes as f64 / m.runs.len().max(1) as f64)
            .collect()
    };
    let names = file.methods.iter().map(|m| m.name.as_str());
    let panel = Panel::new(
        Axis::new("Runs that succeed", "%").range(-2.0, 102.0),
        Axis::names(names),
    )
    .layer(
        Layer::points(rate(|m| &m.after_least_squares), place.clone())
            .color(Color::Green)
            .width(14.0)
            .opacity(0.4)
            .label("With least squares"),
    )
    .layer(
        Layer::points(rate(|m| &m.own), place)
            .color(Color::Blue)
            .width(7.0)
            .opacity(1.0)
            .label("Alone"),
    )
    .height(28.0 * file.methods.len() as f64 + 20.0);
    Figure::new("Success").panel(panel)
}

/// A colour and a dash of its own for each method, the same in all figures.
fn style(file: &CompareFile, name: &str) -> (Color, Dash) {
    let at = file
        .methods
        .iter()
        .position(|m| m.name == name)
        .unwrap_or(0);
    let n = Color::CYCLE.len();
    let dash = [Dash::Solid, Dash::Dashed, Dash::Dotted][(at / n) % 3];
    (Color::CYCLE[at % n], dash)
}

fn cost_axis() -> Axis {
    Axis::new("Best cost J", "").log()
}

fn overlay(
    file: &CompareFile,
    title: &str,
    x: Axis,
    course: &dyn Fn(&MethodEntry) -> &Course,
) -> Figure {
    let mut panel = Panel::new(x, cost_axis()).height(340.0);
    if file.reference.cost > 0.0 && file.reference.cost.is_finite() {
        panel = panel.layer(
            Layer::hline(file.reference.cost)
                .color(Color::Grey)
                .label("Optimum"),
        );
    }
    for m in &file.methods {
        let (color, dash) = style(file, &m.name);
        let c = course(m);
        panel = panel.layer(
            Layer::steps(c.at.clone(), c.median.clone())
                .color(color)
                .dash(dash)
                .label(m.name.as_str()),
        );
    }
    Figure::new(title)
        .panel(panel)
        .caption("Medians over the seeds.")
}

/// One method with its quartiles.
fn single(file: &CompareFile, m: &MethodEntry) -> Figure {
    let c = &m.by_evaluations;
    let (color, _) = style(file, &m.name);
    let mut panel = Panel::new(Axis::new("Evaluations", "").log(), cost_axis()).height(160.0);
    if file.reference.cost > 0.0 && file.reference.cost.is_finite() {
        panel = panel.layer(Layer::hline(file.reference.cost).color(Color::Grey));
    }
    let panel = panel
        .layer(
            Layer::band(c.at.clone(), c.low.clone(), c.high.clone())
                .color(color)
                .label("Quartiles"),
        )
        .layer(
            Layer::steps(c.at.clone(), c.median.clone())
                .color(color)
                .label("Median"),
        );
    Figure::new(m.name.as_str()).panel(panel).half()
}

/// The population of one run, generation by generation.
fn population(m: &MethodEntry) -> Figure {
    let x: Vec<f64> = (0..m.generations.len()).map(|i| i as f64).collect();
    let at = |q: usize| -> Vec<f64> {
        let each = m.generations.iter();
        each.map(|(_, costs)| costs.get(q).copied().flatten().unwrap_or(f64::NAN))
            .collect()
    };
    let panel = Panel::new(
        Axis::new("Generations over all rounds", ""),
        Axis::new("Cost J", "").log(),
    )
    .layer(
        Layer::band(x.clone(), at(1), at(3))
            .color(Color::Grey)
            .label("Quartiles"),
    )
    .layer(
        Layer::line(x.clone(), at(2))
            .color(Color::Grey)
            .label("Median"),
    )
    .layer(Layer::line(x, at(0)).color(Color::Blue).label("Best"))
    .height(170.0);
    Figure::new(format!("{}, the population of one run", m.name))
        .panel(panel)
        .half()
}

/// The three beside each other, as the excess over the optimum.
fn beside(file: &CompareFile, paper: &[&MethodEntry]) -> Figure {
    let least = file.reference.cost;
    let excess = |costs: &[f64]| -> Vec<f64> {
        costs.iter().map(|c| (c / least - 1.0).max(LEAST)).collect()
    };
    let mut panel = Panel::new(
        Axis::new("Evaluations of the full record", "").log(),
        Axis::new("Cost over the optimum, less 1", "").log(),
    );
    for m in paper {
        let (color, _) = style(file, &m.name);
        let c = &m.by_evaluations;
        panel = panel
            .layer(Layer::band(c.at.clone(), excess(&c.low), excess(&c.high)).color(color))
            .layer(
                Layer::steps(c.at.clone(), excess(&c.median))
                    .color(color)
                    .label(m.name.as_str()),
            );
    }
    Figure::new("Plain, adaptive and annealing genetic algorithm")
        .panel(panel)
        .caption("Medians and quartiles; the fall at the end is the least squares.")
}

fn errors(file: &CompareFile, title: &str, stage: &dyn Fn(&MethodEntry) -> &Stage) -> Table {
    let names = file
        .truth
        .iter()
        .map(|(name, _)| (name.as_str(), Align::Right));
    let columns = std::iter::once(("Method", Align::Left)).chain(names);
    let mut table = Table::new(columns).caption(title);
    for m in &file.methods {
        let cells = stage(m).errors.iter().map(|e| {
            let percent = e.relative.map(|v| 100.0 * v[1]);
            percent.map_or("–".into(), |x| format!("{} %", number::sig(x, 2)))
        });
        table = table.row(std::iter::once(m.name.clone()).chain(cells));
    }
    table
}
