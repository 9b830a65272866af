//! A corner of two axes, without and with cross-coupled control.

use super::simulated::{color, label, over_time};
use stiction_report::{Axis, Block, Color, Dash, Document, Figure, Layer, Panel};
use stiction_servo::two_axes::PlaneSample;
use stiction_workflows::reproduce::{Cornered, Paper};

/// Height of the pictures of the corner, px.
const PICTURE_HEIGHT: f64 = 320.0;

/// How far beyond the corner its picture reaches, m.
const ABOUT_CORNER: f64 = 4e-6;

/// Metres a second in metres a minute.
const MINUTE: f64 = 60.0;

pub(super) fn sections(document: Document, paper: &Paper) -> Document {
    let drawn = |coupled: bool| -> Vec<&Cornered> {
        let runs = paper.cornered.iter();
        runs.filter(|r| r.is_drawn() && r.coupled == coupled)
            .collect()
    };
    let [apart, coupled] = [false, true].map(drawn);
    if apart.is_empty() {
        return document;
    }
    document
        .heading(2, "A corner of two axes")
        .paragraph(
            "Along x, then along y at 3 m/min, with a stop at the corner. Cross coupling adds to the velocity of both axes \
             what the deviation from the contour asks for. What counts is 0.2 s to either side of the corner, without \
             the start and the stop at the end. Coulomb and Stribeck leave more there than no compensation does (below): \
             their force goes as the reference stops, while friction still holds the axis.",
        )
        .block(Block::Columns(vec![
            corner(&apart, "The corner, each axis by itself (FIG. 14, 15)").into(),
            corner(&coupled, "The corner, cross-coupled (FIG. 14, 15)").into(),
        ]))
        .block(Block::Columns(vec![
            over(&apart, "Contour error", "m", |s| s.deviation)
                .caption("Positive where the contour lies to the left of the axes.")
                .into(),
            over(&coupled, "Contour error, cross-coupled", "m", |s| s.deviation).into(),
        ]))
        .block(Block::Columns(vec![
            over(&apart, "Feed error", "m/min", feed_error)
                .caption("Velocity along the contour less that of the reference.")
                .into(),
            over(&coupled, "Feed error, cross-coupled", "m/min", feed_error).into(),
        ]))
}

/// The velocity along the contour less that of the reference, m/min; 0 where that stands.
fn feed_error(sample: &PlaneSample) -> f64 {
    let [x, y] = &sample.axes;
    let (wanted_x, wanted_y) = (x.reference.velocity, y.reference.velocity);
    let feed = wanted_x.hypot(wanted_y);
    if feed == 0.0 {
        return 0.0;
    }
    MINUTE * ((x.velocity * wanted_x + y.velocity * wanted_y) / feed - feed)
}

fn corner(runs: &[&Cornered], title: &str) -> Figure {
    let at = runs
        .first()
        .and_then(|r| r.samples.last())
        .map_or(0.0, |s| s.axes[0].reference.position);
    // The second edge begins at y = 0.
    let panel = Panel::new(
        Axis::new("x less the corner", "m").range(-ABOUT_CORNER, 0.5 * ABOUT_CORNER),
        Axis::new("y", "m").range(-0.5 * ABOUT_CORNER, ABOUT_CORNER),
    )
    .height(PICTURE_HEIGHT)
    .layer(
        Layer::line(vec![-1.0, 0.0, 0.0], vec![0.0, 0.0, 1.0])
            .color(Color::Green)
            .dash(Dash::Dotted)
            .label("Reference"),
    );
    let panel = runs.iter().fold(panel, |panel, run| {
        let along = |i: usize, from: f64| -> Vec<f64> {
            let samples = run.samples.iter();
            samples.map(|s| s.axes[i].position - from).collect()
        };
        let line = Layer::line(along(0, at), along(1, 0.0));
        panel.layer(
            line.color(color(run.compensation))
                .label(label(run.compensation)),
        )
    });
    Figure::new(title).half().panel(panel)
}

fn over(runs: &[&Cornered], name: &str, unit: &str, of: fn(&PlaneSample) -> f64) -> Figure {
    let panel = over_time(name, unit).height(220.0);
    let panel = runs.iter().fold(panel, |panel, run| {
        let time: Vec<f64> = run.samples.iter().map(|s| s.axes[0].time).collect();
        let error: Vec<f64> = run.samples.iter().map(of).collect();
        let line = Layer::line(time, error).color(color(run.compensation));
        panel.layer(line.label(label(run.compensation)))
    });
    Figure::new(format!("{name} (FIG. 14, 15)"))
        .half()
        .panel(panel)
}
