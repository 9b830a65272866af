//! The figures of a comparison.

use stiction_files::compare_file::{CompareFile, Course, MethodEntry, Stage};
use stiction_report::{Axis, Color, Dash, Figure, Layer, Panel};

/// Smallest excess (cost divided by that of the optimum, minus 1) on a logarithmic axis, dimensionless; less is drawn
/// there.
const SMALLEST_EXCESS_DRAWN: f64 = 1e-6;

/// Success rates as a picture.
pub(super) fn rates(file: &CompareFile) -> Figure {
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

/// Abscissae of a step curve: each but the first ends one step and begins the next. The best cost so far holds until
/// the next one is found, and so do its quartiles and median.
fn corners(at: &[f64]) -> Vec<f64> {
    at.iter().flat_map(|x| [*x, *x]).skip(1).collect()
}

/// Ordinates at the [`corners`].
fn treads(values: &[f64]) -> Vec<f64> {
    let twice = values.iter().flat_map(|y| [*y, *y]);
    twice.take((2 * values.len()).saturating_sub(1)).collect()
}

pub(super) fn overlay(
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
pub(super) fn single(file: &CompareFile, m: &MethodEntry) -> Figure {
    let c = &m.by_evaluations;
    let (color, _) = style(file, &m.name);
    let mut panel = Panel::new(Axis::new("Evaluations", "").log(), cost_axis()).height(160.0);
    if file.reference.cost > 0.0 && file.reference.cost.is_finite() {
        panel = panel.layer(
            Layer::hline(file.reference.cost)
                .color(Color::Grey)
                .label("Optimum"),
        );
    }
    let panel = panel
        .layer(
            Layer::band(corners(&c.at), treads(&c.low), treads(&c.high))
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
pub(super) fn population(m: &MethodEntry) -> Figure {
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
    Figure::new(format!("{}, the population of the run with seed 0", m.name))
        .panel(panel)
        .half()
}

/// The three beside each other, as the excess over the optimum.
pub(super) fn beside(file: &CompareFile, paper: &[&MethodEntry]) -> Figure {
    let least = file.reference.cost;
    let excess = |costs: &[f64]| -> Vec<f64> {
        costs
            .iter()
            .map(|c| (c / least - 1.0).max(SMALLEST_EXCESS_DRAWN))
            .collect()
    };
    let mut panel = Panel::new(
        Axis::new("Evaluations of the full record", "").log(),
        Axis::new("Cost over the optimum, less 1", "").log(),
    );
    for m in paper {
        let (color, _) = style(file, &m.name);
        let c = &m.by_evaluations;
        panel = panel
            .layer(
                Layer::band(
                    corners(&c.at),
                    treads(&excess(&c.low)),
                    treads(&excess(&c.high)),
                )
                .color(color),
            )
            .layer(
                Layer::steps(c.at.clone(), excess(&c.median))
                    .color(color)
                    .label(m.name.as_str()),
            );
    }
    Figure::new("Plain, adaptive and annealing genetic algorithm")
        .panel(panel)
        .caption("Medians and quartiles; the fall at the end is the least squares. Excess below 1e-6 is drawn there.")
}
