//! Control force, inertia and friction beside each other: true and identified.

use super::simulated::{axis, color, column, label, over_time};
use stiction_report::{Color, Dash, Figure, Layer, Panel};
use stiction_servo::axis::Sample;
use stiction_workflows::reproduce::{Tracked, Units};

/// Deflections at break-away that a reversal is shown for.
const SHOWN: f64 = 10.0;

/// Height of each of the panels, px.
const HEIGHT: f64 = 130.0;

/// The parts of the force of one run, N.
struct Parts {
    /// Commanded, and what mass and identified law make of the motion.
    control: [Vec<f64>; 2],
    inertia: Vec<f64>,
    /// Of the axis, and of the identified law along the same motion.
    friction: [Vec<f64>; 2],
}

impl Parts {
    fn of(run: &Tracked, mass: f64) -> Self {
        let samples = &run.samples;
        let last = samples.len().saturating_sub(1);
        let slope = |i: usize| {
            let (from, to) = (i.saturating_sub(1), (i + 1).min(last));
            let (from, to) = (&samples[from], &samples[to]);
            (to.velocity - from.velocity) / (to.time - from.time)
        };
        let inertia: Vec<f64> = (0..samples.len()).map(|i| mass * slope(i)).collect();
        let friction = &run.friction;
        let sum = inertia.iter().zip(&friction[1]).map(|(a, b)| a + b);
        Parts {
            control: [column(samples, |s| s.command), sum.collect()],
            friction: friction.clone(),
            inertia,
        }
    }

    fn panels(&self, panel: impl Fn(&str) -> Panel, x: &[f64]) -> [Panel; 3] {
        let true_line = |y: &[f64]| {
            let line = Layer::line(x, y).color(Color::Grey).width(3.0);
            line.label("True")
        };
        let identified = |y: &[f64], name: &str| {
            let line = Layer::line(x, y).color(Color::Blue).dash(Dash::Dashed);
            line.label(name)
        };
        let [command, sum] = &self.control;
        let [of_axis, of_law] = &self.friction;
        [
            panel("Control force")
                .layer(true_line(command))
                .layer(identified(
                    sum,
                    "Mass times acceleration plus identified law",
                )),
            panel("Inertia").layer(Layer::line(x, self.inertia.clone()).color(Color::Green)),
            panel("Friction")
                .layer(true_line(of_axis))
                .layer(identified(of_law, "Identified")),
        ]
    }
}

/// The parts over time, and the control force of every run that is drawn.
pub(super) fn over_time_of(runs: &[&Tracked], mass: f64, units: Units) -> Vec<Figure> {
    let Some(without) = runs.first() else {
        return Vec::new();
    };
    let time = column(&without.samples, |s| s.time);
    let panels =
        Parts::of(without, mass).panels(|name| over_time(name, units.force).height(HEIGHT), &time);
    let parts = Figure::new("Control force and its parts without compensation (FIG. 21)");
    let parts = panels.into_iter().fold(parts, Figure::panel);
    let all = runs
        .iter()
        .fold(over_time("Control force", units.force), |panel, run| {
            let of = |s: &Sample| s.command;
            let line = Layer::line(column(&run.samples, |s| s.time), column(&run.samples, of));
            panel.layer(
                line.color(color(run.compensation))
                    .label(label(run.compensation)),
            )
        });
    vec![
        parts
            .shared_x()
            .caption("What is identified: the mass, which is known, and the law along the motion."),
        Figure::new("Control force without and with compensation (FIG. 21)").panel(all),
    ]
}

/// The parts over the displacement, and friction where the motion turns back; `presliding` is the deflection at break-away.
pub(super) fn over_displacement(
    runs: &[&Tracked],
    mass: f64,
    presliding: f64,
    units: Units,
) -> Vec<Figure> {
    let Some(without) = runs.first() else {
        return Vec::new();
    };
    let over = |name: &str| Panel::new(axis("Position", units.length), axis(name, units.force));
    let position = column(&without.samples, |s| s.position);
    let panels = Parts::of(without, mass).panels(|name| over(name).height(HEIGHT), &position);
    let parts = Figure::new("Control force and its parts over displacement (FIG. 22)");
    let parts = panels.into_iter().fold(parts, Figure::panel).shared_x();
    let turn = position.iter().copied().fold(f64::MIN, f64::max);
    let reversal = Panel::new(
        axis("Position less the largest", units.length).range(-SHOWN * presliding, presliding),
        axis("Friction", units.force),
    );
    let line = |y: &[f64]| Layer::line(column(&without.samples, |s| s.position - turn), y);
    let [of_axis, of_law] = &without.friction;
    let reversal = reversal
        .layer(line(of_axis).color(Color::Grey).width(3.0).label("True"))
        .layer(
            line(of_law)
                .color(Color::Blue)
                .dash(Dash::Dashed)
                .label("Identified"),
        );
    vec![
        parts,
        Figure::new("Friction over displacement where the motion turns back (FIG. 22)")
            .panel(reversal),
    ]
}
