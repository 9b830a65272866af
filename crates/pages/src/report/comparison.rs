//! The report of a comparison of methods.

mod figures;

use figures::{beside, overlay, population, rates, single};
use stiction_codes::Code;
use stiction_files::compare_file::{CompareFile, MethodEntry, Quartiles, RunEntry, Stage};
use stiction_files::symbols;
use stiction_number::Percent;
use stiction_report::{
    Align, Axis, Block, Callout, Document, KeyFigure, Severity, Table, Text, number,
};

/// The genetic algorithms of Zhang et al. 2025, in the order of its figures.
const PAPER: [&str; 3] = ["ga", "adaptive-ga", "annealing-ga"];

/// Cost divided by that of the optimum, minus 1, up to which two costs count as the same, dimensionless: rounding.
const SAME_COST_EXCESS: f64 = 1e-9;

/// The report.
pub fn comparison(file: &CompareFile) -> Document {
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
            "The same kind of pictures as its figures 4 to 7: how the cost falls in each of the three \
             algorithms, and the three side by side. The numbers are those of this comparison; \
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
    if file.truth.is_empty() {
        document = document
            .heading(2, "Parameters found")
            .paragraph("Of each method the run that ends at the least cost, in SI units.")
            .block(found(file));
    }
    document
}

fn callouts(file: &CompareFile) -> Vec<Callout> {
    let mut out = Vec::new();
    let mut say = |severity, code: Option<Code>, text: String| {
        out.push(Callout {
            severity,
            code: code.map_or("", Code::as_str).into(),
            text: Text::from(text),
            link: String::new(),
        });
    };
    if file.status == "interrupted" {
        let text = "Runs that were not complete are left out.";
        say(Severity::Warning, Some(Code::Interrupted), text.into());
    }
    if file.reference.beaten {
        let before = file
            .reference
            .before
            .map_or("no finite cost".into(), |x| number::sig(x, 7));
        say(
            Severity::Info,
            None,
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

/// A number as it was typed, without trailing zeros.
fn plain(value: f64) -> String {
    let text = number::sig(value, 5);
    match text.contains('.') && !text.contains('×') {
        true => text.trim_end_matches('0').trim_end_matches('.').into(),
        false => text,
    }
}

/// Excess over the optimum; one within rounding is shown as zero.
fn excess(values: &Quartiles) -> String {
    match values {
        Some([_, x, _]) if x.abs() < SAME_COST_EXCESS => "0".into(),
        _ => shown(values, 2),
    }
}

fn key_figures(file: &CompareFile) -> Vec<KeyFigure> {
    let mut out = vec![
        KeyFigure::new("Optimum", number::sig(file.reference.cost, 5), "").note(format!(
            "cost J (sum of squared errors over that of the data), by {}",
            file.reference.by
        )),
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
            "Without least squares after them",
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
                number::count(median(&m.evaluations_to_success).round() as u64)
            )),
        );
    }
    if let Some(m) = cheapest(&|m| median(&m.seconds_to_success)) {
        out.push(
            KeyFigure::new("Least time", m.name.as_str(), "").note(format!(
                "median {} until near the optimum",
                number::si(median(&m.seconds_to_success), "s", 2)
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
        out.push(("Rate", format!("{} Hz", plain(file.rate_hz))));
    }
    if let Some(noise) = file.noise {
        let text = format!(
            "{} % of the largest value (standard deviation)",
            plain(100.0 * noise)
        );
        out.push(("Noise", text));
    }
    let decades = file.box_decades.map_or("that of identify".into(), |d| {
        let decades = if d == 1.0 { "decade" } else { "decades" };
        format!(
            "{} {decades} to each side of a point off the answer",
            plain(d)
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
        ("Then", Align::Right),
        ("J alone", Align::Right),
        ("Excess", Align::Right),
        ("Evaluations", Align::Right),
        ("Time", Align::Right),
        ("A run", Align::Right),
    ])
    .caption(
        "Runs that succeed alone and then, with least squares; medians over the seeds. Excess: J alone over \
         the optimum, less 1. Evaluations and time until a run that succeeds is near the optimum; time of a \
         whole run. A derivative evaluation counts as one, a coarse one as its share.",
    );
    let seconds = |q: &Quartiles| q.map_or("–".into(), |v| number::si(v[1], "s", 3));
    for m in &file.methods {
        let runs = m.runs.len();
        let cells = [
            // A name is not broken at its hyphen.
            m.name.replace('-', "\u{2011}"),
            format!("{} of {runs}", m.own.successes),
            format!("{} of {runs}", m.after_least_squares.successes),
            shown(&m.own.cost, 4),
            excess(&m.own.excess),
            m.evaluations_to_success
                .map_or("–".into(), |v| number::count(v[1].round() as u64)),
            seconds(&m.seconds_to_success),
            seconds(&m.seconds),
        ];
        table = table.row(cells);
    }
    table
}

fn errors(file: &CompareFile, title: &str, stage: &dyn Fn(&MethodEntry) -> &Stage) -> Table {
    let names = file
        .truth
        .iter()
        .map(|(name, _)| (symbols::symbol(name), Align::Right));
    let columns = std::iter::once(("Method".to_string(), Align::Left)).chain(names);
    let mut table = Table::new(columns).caption(title);
    for m in &file.methods {
        let cells = stage(m).errors.iter().map(|e| {
            let percent = e.relative.map(|v| 100.0 * v[1]);
            percent.map_or("–".into(), |x| Percent::error(x).digits(2))
        });
        let name = m.name.replace('-', "\u{2011}");
        table = table.row(std::iter::once(name).chain(cells));
    }
    table
}

fn found(file: &CompareFile) -> Table {
    let best = |m: &'_ MethodEntry| {
        let cost = |run: &RunEntry| run.cost.unwrap_or(f64::INFINITY);
        let least = (m.runs.iter()).min_by(|a, b| cost(a).total_cmp(&cost(b)));
        least.map_or_else(Vec::new, |run| run.parameters.clone())
    };
    let rows: Vec<_> = file.methods.iter().map(|m| (m, best(m))).collect();
    let names = rows.iter().map(|(_, values)| values);
    let names = names.max_by_key(|values| values.len());
    let names: Vec<&str> = names.map_or_else(Vec::new, |values| {
        values.iter().map(|(name, _)| name.as_str()).collect()
    });
    let columns = names
        .iter()
        .map(|name| (symbols::symbol(name), Align::Right));
    let first = std::iter::once(("Method".to_string(), Align::Left));
    let mut table = Table::new(first.chain(columns));
    for (m, values) in &rows {
        let cells = names.iter().map(|name| {
            let value = values.iter().find(|(n, _)| n == name);
            value.map_or("–".into(), |(_, x)| number::sig(*x, 5))
        });
        let name = m.name.replace('-', "\u{2011}");
        table = table.row(std::iter::once(name).chain(cells));
    }
    table
}
