//! The laws beside each other as a picture.

use crate::names::law_beside;
use stiction_report::{Axis, Color, Figure, Layer, Panel};
use stiction_workflows::identify::Outcome;

/// Fitted and held-out error of each law, the one to take marked.
pub(super) fn figure(outcome: &Outcome) -> Figure {
    let laws = &outcome.result.laws;
    let place: Vec<f64> = (0..laws.len()).map(|i| i as f64).collect();
    let fitted: Vec<f64> = laws.iter().map(|l| l.fitted_error_percent).collect();
    let held_out: Vec<f64> = laws
        .iter()
        .map(|l| l.held_out_error_percent.unwrap_or(f64::NAN))
        .collect();
    let best: Vec<f64> = laws
        .iter()
        .zip(&held_out)
        .map(|(l, error)| if l.best { *error } else { f64::NAN })
        .collect();
    let names = laws.iter().map(law_beside);
    let panel = Panel::new(Axis::new("Relative error", "%").log(), Axis::names(names))
        .layer(
            Layer::points(best, place.clone())
                .color(Color::Green)
                .width(14.0)
                .opacity(0.4)
                .label("The law to take"),
        )
        .layer(
            Layer::points(fitted, place.clone())
                .color(Color::Grey)
                .width(6.0)
                .opacity(1.0)
                .label("Where it was fitted"),
        )
        .layer(
            Layer::points(held_out, place)
                .color(Color::Blue)
                .width(6.0)
                .opacity(1.0)
                .label("On held-out samples"),
        )
        .height(28.0 * laws.len() as f64 + 20.0);
    Figure::new("Laws side by side").panel(panel).caption(
        "A law that is too simple leaves more everywhere; one that is too rich leaves less where it \
         was fitted and not on held-out samples.",
    )
}
