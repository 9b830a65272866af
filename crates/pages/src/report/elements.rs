//! What the report shows of a Maxwell-slip law: its elements together, and how many there are.

use stiction_files::symbols;
use stiction_number::Percent;
use stiction_report::{Align, Axis, Color, Figure, Layer, Panel, Severity, Table};
use stiction_workflows::identify::Outcome;

/// Stiffness and yield deflection of each element, in the order of the yield deflections.
fn elements(outcome: &Outcome) -> Vec<(f64, f64)> {
    let value = |name: String| outcome.law().value(&name);
    (1..)
        .map_while(|k| {
            Some((
                value(format!("stiffness_{k}"))?,
                value(format!("yield_{k}"))?,
            ))
        })
        .collect()
}

/// Force over deflection from rest: every element gives way in turn.
pub(super) fn virgin(outcome: &Outcome) -> Option<Figure> {
    let elements = elements(outcome);
    let force = |x: f64| elements.iter().map(|(k, d)| k * x.min(*d)).sum::<f64>();
    let last = elements.last()?.1;
    let mut x = vec![0.0];
    x.extend(elements.iter().map(|(_, d)| *d));
    x.push(1.2 * last);
    let y: Vec<f64> = x.iter().map(|&x| force(x)).collect();
    let inner = 1..x.len() - 1;
    let panel = Panel::new(
        Axis::new("Deflection from rest", symbols::length_unit(outcome.motion)),
        Axis::new("Friction", outcome.force_unit.as_str()),
    )
    .layer(Layer::line(x.clone(), y.clone()).color(Color::Vermilion))
    .layer(
        Layer::points(x[inner.clone()].to_vec(), y[inner].to_vec())
            .color(Color::Vermilion)
            .label("An element yields"),
    );
    let figure = Figure::new("First loading from rest").panel(panel).half();
    Some(figure.caption(
        "Slow loading without history. After a reversal the same curve follows at twice the scale, \
         and small loops close inside large ones.",
    ))
}

/// Numbers of elements side by side.
pub(super) fn tried(outcome: &Outcome) -> Table {
    let mut table = Table::new([
        ("Elements", Align::Right),
        ("Fitted", Align::Right),
        ("Held out", Align::Right),
    ])
    .caption(
        "Relative error where the law was fitted and over four blocks left out in turn. Marked: the \
         fewest elements within 1 % of the least held-out error. Elements to which the data give no \
         stiffness are dropped, so large numbers may be missing.",
    );
    let percent = |x: f64| Percent::error(x).digits(3);
    for score in &outcome.result.elements {
        let cells = [
            score.elements.to_string(),
            percent(score.fitted_error_percent),
            score.held_out_error_percent.map_or("–".into(), percent),
        ];
        table = if score.chosen {
            table.marked(Severity::Good, cells)
        } else {
            table.row(cells)
        };
    }
    table
}
