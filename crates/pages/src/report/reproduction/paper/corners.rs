//! A corner of two axes, with a stop and at speed, without and with cross-coupled control.

use super::simulated::{axis, color, label, over_time};
use stiction_report::{Block, Color, Dash, Document, Figure, Layer, Panel};
use stiction_servo::axis::Sample;
use stiction_servo::two_axes::PlaneSample;
use stiction_workflows::reproduce::{Cornered, Paper, Turn};

/// Height of the pictures of the corner, px.
const PICTURE_HEIGHT: f64 = 320.0;

/// How far beyond the largest deviation a picture reaches, in parts of it.
const MARGIN: f64 = 1.5;

pub(super) fn sections(document: Document, paper: &Paper) -> Document {
    if paper.cornered.is_empty() {
        return document;
    }
    let document = document.heading(2, "A corner of two axes").paragraph(
        "Along x, then along y, once with a stop at the corner and once at speed: there y starts as x begins to stop, which rounds \
         the corner, and the deviation is that from the rounded path. Cross coupling adds to the velocity of both axes \
         what the deviation from the contour asks for. What counts is 0.2 s to either side of the corner, without \
         the start and the stop at the end. With a stop Coulomb and Stribeck may leave more than no compensation does (below): \
         their force goes as the reference stops, while friction still holds the axis.",
    );
    let turns = [
        (Turn::Stop, "with a stop"),
        (Turn::Blend, "at speed (FIG. 14, 15)"),
    ];
    turns.iter().fold(document, |document, (turn, words)| {
        let drawn = |coupled: bool| -> Vec<&Cornered> {
            let runs = paper.cornered.iter();
            runs.filter(|r| r.is_drawn() && r.turn == *turn && r.coupled == coupled)
                .collect()
        };
        let units = paper.stage.units();
        let pair = |name: &str, of: &dyn Fn(&[&Cornered]) -> Panel| {
            let figure = |coupled: bool| {
                let couples = if coupled { ", cross-coupled" } else { "" };
                Figure::new(format!("{name} {words}{couples}"))
                    .half()
                    .panel(of(&drawn(coupled)))
                    .into()
            };
            Block::Columns([false, true].map(figure).into())
        };
        let (unit, factor) = units.feed;
        document
            .block(pair("The corner", &|runs| corner(runs, units.length)))
            .block(pair("Contour error", &|runs| {
                over(runs, ("Contour error", units.length), &|s| s.deviation)
            }))
            .block(pair("Feed error", &|runs| {
                over(runs, ("Feed error", unit), &|s| factor * feed_error(s))
            }))
    })
}

/// The velocity along the contour less that of the reference; 0 where that stands.
fn feed_error(sample: &PlaneSample) -> f64 {
    let [x, y] = &sample.axes;
    let (wanted_x, wanted_y) = (x.reference.velocity, y.reference.velocity);
    let feed = wanted_x.hypot(wanted_y);
    if feed == 0.0 {
        return 0.0;
    }
    (x.velocity * wanted_x + y.velocity * wanted_y) / feed - feed
}

/// Both axes about the corner, which is where x ends and y has not begun.
fn corner(runs: &[&Cornered], unit: &str) -> Panel {
    let last = runs.first().and_then(|r| r.samples.last());
    let at = last.map_or(0.0, |s| s.axes[0].reference.position);
    let off = runs.iter().map(|r| r.contour.peak).fold(0.0, f64::max);
    // The nearest that the reference comes to the corner: it is rounded where it does not stop.
    let references = || runs.iter().flat_map(|r| &r.samples);
    let away = references().map(|s| {
        let [x, y] = s.axes.map(|a| a.reference.position);
        (at - x).max(y)
    });
    let rounded = away.fold(f64::INFINITY, f64::min).min(1.0);
    let reach = MARGIN * off.max(rounded);
    let panel = Panel::new(
        axis("x less the corner", unit).range(-reach, MARGIN * off),
        axis("y", unit).range(-MARGIN * off, reach),
    )
    .height(PICTURE_HEIGHT);
    let along = |run: &Cornered, of: fn(&Sample) -> f64| {
        let [x, y] = [0, 1].map(|i| run.samples.iter().map(move |s| of(&s.axes[i])));
        Layer::line(
            x.map(|x| x - at).collect::<Vec<f64>>(),
            y.collect::<Vec<f64>>(),
        )
    };
    let reference = runs.first().map(|run| {
        let line = along(run, |s| s.reference.position).color(Color::Green);
        line.dash(Dash::Dotted).label("Reference")
    });
    let panel = reference.into_iter().fold(panel, Panel::layer);
    runs.iter().fold(panel, |panel, run| {
        let line = along(run, |s| s.position).color(color(run.compensation));
        panel.layer(line.label(label(run.compensation)))
    })
}

fn over(runs: &[&Cornered], (name, unit): (&str, &str), of: &dyn Fn(&PlaneSample) -> f64) -> Panel {
    runs.iter()
        .fold(over_time(name, unit).height(220.0), |panel, run| {
            let time: Vec<f64> = run.samples.iter().map(|s| s.axes[0].time).collect();
            let error: Vec<f64> = run.samples.iter().map(of).collect();
            let line = Layer::line(time, error).color(color(run.compensation));
            panel.layer(line.label(label(run.compensation)))
        })
}
