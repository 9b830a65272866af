//! The part of the report that shows a simulated axis.

use super::{figures, tables};
use crate::names::{force_noise, simulated_runs};
use stiction_files::symbols;
use stiction_identify::{Series, Signals};
use stiction_log::Motion;
use stiction_number::Percent;
use stiction_report::{Axis, Color, Document, Figure, Layer, Panel, number};
use stiction_workflows::identify::{Outcome, Simulated};

/// Errors, friction over velocity, position and force in time, validation.
pub(super) fn sections(
    mut document: Document,
    outcome: &Outcome,
    simulated: &Simulated,
) -> Document {
    document = document
        .heading(2, "Simulation")
        .paragraph(errors(outcome))
        .block(in_time(
            outcome,
            &simulated.fit.signals,
            "Measured and simulated",
        ))
        .heading(2, "Friction and velocity")
        .block(velocity_map(outcome, &simulated.fit.signals))
        .block(force_map(outcome, &simulated.fit.signals));
    if !simulated.unseen.is_empty() {
        document = document
            .heading(2, "Validation")
            .block(tables::validation(outcome));
        for (path, unseen) in &simulated.unseen {
            let title = format!("Validation: {path}");
            document = document.block(in_time(outcome, &unseen.signals, &title));
        }
    }
    document
}

/// The errors in a sentence or two.
fn errors(outcome: &Outcome) -> String {
    let Some(entry) = &outcome.result.simulation else {
        return String::new();
    };
    let x = &entry.position;
    let mut out = format!(
        "Position error {} {} rms, {} of the motion",
        number::sig(x.rmse, 3),
        x.unit,
        Percent::error(x.relative_error_percent).digits(3)
    );
    if let Some(floor) = entry.quantisation_floor {
        out.push_str(&format!(
            "; encoder steps alone would leave {} {}",
            number::sig(floor, 3),
            x.unit
        ));
    }
    out.push_str(". ");
    match &entry.force {
        Some(f) => out.push_str(&format!(
            "Closed loop: the controller runs on the recorded reference and the simulated position; \
             its {} is off by {} {} rms, {} of the measured one.",
            f.signal,
            number::sig(f.rmse, 3),
            number::unit(&f.unit),
            Percent::error(f.relative_error_percent).digits(3)
        )),
        None => out.push_str("The logged force drives the simulated axis."),
    }
    out.push_str(&format!(" Fitted: {}.", simulated_runs(entry)));
    if let Some(whole) = &entry.whole {
        out.push_str(&format!(
            " Simulated whole, each stretch from one start, the error is {} {} rms, {}.",
            number::sig(whole.rmse, 3),
            whole.unit,
            Percent::error(whole.relative_error_percent).digits(3)
        ));
    } else if let Some(horizon) = &entry.short_horizon {
        out.push_str(&format!(
            " Over {} s at a time, each piece from a fitted start, the error is {} {} rms, {}.",
            number::sig(horizon.seconds, 3),
            number::sig(horizon.fit.rmse, 3),
            horizon.fit.unit,
            Percent::error(horizon.fit.relative_error_percent).digits(3)
        ));
    }
    if let Some(note) = force_noise(entry) {
        out.push_str(&format!(" {note}"));
    }
    out
}

fn position_word(motion: Motion) -> &'static str {
    match motion {
        Motion::Linear => "Position",
        Motion::Rotary => "Angle",
    }
}

/// The signals as the other figures take them.
fn series(signals: &Signals) -> Series {
    Series {
        log: signals.log.clone(),
        time: signals.time.clone(),
        ..Series::default()
    }
}

fn less(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn in_time(outcome: &Outcome, signals: &Signals, title: &str) -> Figure {
    let length = symbols::length_unit(outcome.motion);
    let series = series(signals);
    let holes = figures::breaks(&series);
    let time = figures::broken(&figures::clock(&series), &holes);
    let line = |values: &[f64]| Layer::line(time.clone(), figures::broken(values, &holes));
    let axis = || Axis::new("Time", "s");
    let position = Panel::new(axis(), Axis::new(position_word(outcome.motion), length))
        .layer(line(&signals.position).color(Color::Grey).label("Measured"))
        .layer(
            line(&signals.simulated)
                .color(Color::Blue)
                .label("Simulated"),
        );
    let mut error = Panel::new(axis(), Axis::new("Error", length)).height(110.0);
    let floor = outcome.result.simulation.as_ref();
    if let Some(floor) = floor.and_then(|s| s.quantisation_floor) {
        error = error.layer(Layer::hband(-floor, floor).label("Encoder steps, rms"));
    }
    error = error.layer(line(&less(&signals.position, &signals.simulated)).color(Color::Vermilion));
    let mut force = Panel::new(axis(), figures::force_axis(outcome))
        .layer(line(&signals.force).color(Color::Grey).label("Measured"))
        .height(150.0);
    let mut out = Figure::new(title).panel(position).panel(error);
    if signals.simulated_force.is_empty() {
        out = out.panel(force);
    } else {
        force = force.layer(
            line(&signals.simulated_force)
                .color(Color::Blue)
                .label("Simulated"),
        );
        let off = less(&signals.force, &signals.simulated_force);
        let error = Panel::new(axis(), Axis::new("Error", outcome.force_unit.as_str()))
            .layer(line(&off).color(Color::Vermilion))
            .height(110.0);
        out = out.panel(force).panel(error);
    }
    let velocity = Panel::new(axis(), figures::velocity_axis(outcome))
        .layer(line(&signals.velocity).color(Color::Green))
        .height(90.0);
    out.panel(velocity).shared_x()
}

/// Simulated friction over velocity, with the steady curve and its band.
fn velocity_map(outcome: &Outcome, signals: &Signals) -> Figure {
    let holes = figures::breaks(&series(signals));
    let [band, curve] = figures::steady_layers(outcome, &signals.velocity);
    let panel = Panel::new(
        figures::velocity_axis(outcome),
        figures::friction_axis(outcome),
    )
    .layer(
        Layer::line(
            figures::broken(&signals.velocity, &holes),
            figures::broken(&signals.friction, &holes),
        )
        .color(Color::Blue)
        .width(1.0)
        .opacity(0.7)
        .label("Simulated along the log"),
    )
    .layer(band)
    .layer(curve)
    .height(320.0);
    Figure::new("Friction over velocity").panel(panel).caption(
        "The steady curve is what the law gives at constant velocity. Measured friction is not shown: \
         it would need the acceleration, and nothing was differentiated.",
    )
}

/// Force over position: the loops of presliding.
fn force_map(outcome: &Outcome, signals: &Signals) -> Figure {
    let holes = figures::breaks(&series(signals));
    let over = |position: &[f64], force: &[f64]| {
        Layer::line(
            figures::broken(position, &holes),
            figures::broken(force, &holes),
        )
    };
    let simulated = match signals.simulated_force.is_empty() {
        true => &signals.force,
        false => &signals.simulated_force,
    };
    let length = symbols::length_unit(outcome.motion);
    let panel = Panel::new(
        Axis::new(position_word(outcome.motion), length),
        figures::force_axis(outcome),
    )
    .layer(
        over(&signals.position, &signals.force)
            .color(Color::Grey)
            .label("Measured"),
    )
    .layer(
        over(&signals.simulated, simulated)
            .color(Color::Blue)
            .label("Simulated"),
    );
    Figure::new("Force over position").panel(panel)
}
