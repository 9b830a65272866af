//! The axis in motion: tracking without and with compensation, corner, change of load.

use super::{corners, delayed, drawings, parts, rested, slow};
use crate::report::reproduction::checks::numbers;
use stiction_files::reproduce_file::ReproduceFile;
use stiction_report::{Axis, Color, Dash, Document, Figure, Layer, Panel, number};
use stiction_servo::axis::Sample;
use stiction_workflows::reproduce::{Compensation, LoadFound, Paper, Tracked, Units};

pub(super) fn sections(mut document: Document, file: &ReproduceFile, paper: &Paper) -> Document {
    let truth = &paper.stage.truth;
    let units = paper.stage.units();
    let drawn: Vec<&Tracked> = paper.tracked.iter().filter(|t| t.is_drawn()).collect();
    if let [without, ..] = drawn[..] {
        document = document
            .heading(2, "A sine without compensation")
            .block(sine(without, units))
            .block(friction(without, units))
            .heading(2, "Compensation")
            .paragraph(
                "The law identified in the static and then the dynamic test, with least squares, is fed by the \
                 reference velocity, which is a feedforward, and by the measured velocity, as the paper draws it, \
                 which is a positive feedback of friction and is let through to 90 %. The measured velocity is the \
                 difference of two readings of the encoder over a period of 0.1 ms, not the true one. Both \
                 work beside the same fuzzy PID.",
            )
            .block(drawings::control())
            .block(compensation(&drawn, units))
            .block(speed(&drawn, truth.law.curve().positive().stribeck_velocity, units))
            .block(position(&drawn, units));
        let mass = truth.mass;
        let over_time = parts::over_time_of(&drawn, mass, units);
        let figures = over_time.into_iter().chain(parts::over_displacement(
            &drawn,
            mass,
            truth.law.bound(),
            units,
        ));
        document = figures.fold(document, Document::block);
    }
    document = delayed::sections(document, paper);
    document = corners::sections(document, paper);
    document = rested::sections(document, paper);
    document = slow::sections(document, paper);
    if paper.loads.is_empty() {
        return document;
    }
    document
        .heading(2, "A change of load")
        .block(numbers(file, "load"))
        .block(mass(&paper.loads, units))
}

pub(super) fn color(of: Compensation) -> Color {
    match of {
        Compensation::Nothing => Color::Grey,
        Compensation::Measured => Color::Orange,
        _ => Color::Blue,
    }
}

pub(super) fn label(of: Compensation) -> &'static str {
    match of {
        Compensation::Nothing => "Without",
        _ => of.name(),
    }
}

pub(super) fn column(samples: &[Sample], of: impl Fn(&Sample) -> f64) -> Vec<f64> {
    samples.iter().map(of).collect()
}

/// One line for each run, over time.
fn each(panel: Panel, runs: &[&Tracked], of: impl Fn(&Sample) -> f64) -> Panel {
    runs.iter().fold(panel, |panel, run| {
        let line = Layer::line(column(&run.samples, |s| s.time), column(&run.samples, &of));
        panel.layer(
            line.color(color(run.compensation))
                .label(label(run.compensation)),
        )
    })
}

pub(super) fn over_time(name: &str, unit: &str) -> Panel {
    Panel::new(Axis::new("Time", "s"), axis(name, unit))
}

/// An axis with its unit as it is typed.
pub(super) fn axis(name: &str, unit: &str) -> Axis {
    Axis::new(name, number::unit(unit))
}

fn velocity_error(sample: &Sample) -> f64 {
    sample.reference.velocity - sample.velocity
}

fn sine(run: &Tracked, units: Units) -> Figure {
    let time = column(&run.samples, |s| s.time);
    let line = |of: fn(&Sample) -> f64, color| {
        Layer::line(time.clone(), column(&run.samples, of)).color(color)
    };
    Figure::new("A tracked sine (FIG. 13)")
        .panel(
            over_time("Position", units.length)
                .height(130.0)
                .layer(line(|s| s.reference.position, Color::Grey).label("Reference"))
                .layer(
                    line(|s| s.position, Color::Blue)
                        .dash(Dash::Dashed)
                        .label("Axis"),
                ),
        )
        .panel(
            over_time("Velocity", units.speed)
                .height(130.0)
                .layer(line(|s| s.velocity, Color::Blue)),
        )
        .panel(
            over_time("Position error", units.length)
                .height(130.0)
                .layer(line(Sample::error, Color::Vermilion)),
        )
        .shared_x()
        .caption("Friction reverses with the velocity, and the error with it.")
}

fn friction(run: &Tracked, units: Units) -> Figure {
    let [true_force, found] = &run.friction;
    let time = column(&run.samples, |s| s.time);
    let velocity = column(&run.samples, |s| s.velocity);
    let off: Vec<f64> = found.iter().zip(true_force).map(|(a, b)| a - b).collect();
    let over_velocity =
        |name: &str| Panel::new(axis("Velocity", units.speed), axis(name, units.force));
    let over_time = |name: &str| over_time(name, units.force).height(130.0);
    let friction = |x: &[f64]| Layer::line(x, true_force.clone()).color(Color::Grey);
    let error = |x: &[f64]| Layer::line(x, off.clone()).color(Color::Vermilion);
    Figure::new("Friction over time and velocity, and the error of the identified law (FIG. 17)")
        .panel(over_time("Friction").layer(friction(&time)))
        .panel(over_time("Identified less true").layer(error(&time)))
        .panel(over_velocity("Friction").layer(friction(&velocity)))
        .panel(over_velocity("Identified less true").layer(error(&velocity)))
        .caption("Both laws along the same motion.")
}

fn compensation(runs: &[&Tracked], units: Units) -> Figure {
    let mut force = over_time("Compensating force", units.force).height(160.0);
    if let [without, with @ ..] = runs {
        let line = Layer::line(
            column(&without.samples, |s| s.time),
            without.friction[0].clone(),
        );
        force = each(
            force.layer(
                line.color(Color::Grey)
                    .label("True friction without compensation"),
            ),
            with,
            |s| s.compensation,
        );
    }
    Figure::new("Compensation and what it leaves (FIG. 15, on the sine)")
        .panel(force)
        .panel(each(
            over_time("Position error", units.length),
            runs,
            Sample::error,
        ))
        .shared_x()
}

/// The part of a run about its last reversal.
fn about_reversal(run: &Tracked) -> std::ops::Range<f64> {
    run.reversal - 0.05..run.reversal + 0.15
}

/// `slow` is the Stribeck velocity.
fn speed(runs: &[&Tracked], slow: f64, units: Units) -> Figure {
    let window = runs.first().map_or(0.0..1.0, |r| about_reversal(r));
    let mut reversal = Panel::new(
        Axis::new("Time", "s").range(window.start, window.end),
        axis("Velocity", units.speed).range(-3.0 * slow, 10.0 * slow),
    )
    .title("About the reversal");
    if let Some(first) = runs.first() {
        let line = Layer::line(
            column(&first.samples, |s| s.time),
            column(&first.samples, |s| s.reference.velocity),
        );
        reversal = reversal.layer(
            line.color(Color::Green)
                .dash(Dash::Dotted)
                .label("Reference"),
        );
    }
    Figure::new("Velocity (FIG. 19)")
        .panel(each(
            over_time("Velocity error", units.speed),
            runs,
            velocity_error,
        ))
        .panel(each(reversal, runs, |s| s.velocity))
}

fn position(runs: &[&Tracked], units: Units) -> Figure {
    let window = runs.first().map_or(0.0..1.0, |r| about_reversal(r));
    let reversal = Panel::new(
        Axis::new("Time", "s").range(window.start, window.end),
        axis("Position error", units.length),
    )
    .title("About the reversal");
    Figure::new("Position (FIG. 20)")
        .panel(each(
            over_time("Position error", units.length),
            runs,
            Sample::error,
        ))
        .panel(each(reversal, runs, Sample::error))
}

fn mass(loads: &[LoadFound], units: Units) -> Figure {
    let mut masses = over_time("Mass", units.mass);
    let mut level = over_time("Level of friction", "").height(110.0);
    for (i, (load, color)) in loads.iter().zip(Color::CYCLE).enumerate() {
        let [true_mass, found] = &load.mass;
        let line = |y: &[f64]| Layer::line(load.time.clone(), y);
        let truth = line(true_mass).color(Color::Grey);
        masses = masses
            .layer(if i == 0 { truth.label("True") } else { truth })
            .layer(line(found).color(color).label(format!(
                "Found, {} {}",
                number::sig(load.heavier, 3),
                number::unit(units.mass)
            )));
        level = level.layer(line(&load.level).color(color));
    }
    Figure::new("Load estimation: mass and friction level (FIG. 14)")
        .panel(masses)
        .panel(level)
        .shared_x()
}
