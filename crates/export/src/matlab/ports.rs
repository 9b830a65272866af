//! Inputs and outputs of the block of Simulink, and what the S-function makes of them.

use crate::Model;
use crate::template::Fill;
use crate::terms::{self, Extra};
use stiction_friction::compensator::Terms;

/// A port: its name, what it is, and the value that it takes or gives in C.
struct Port {
    name: String,
    what: String,
    value: String,
}

fn port(name: &str, what: impl Into<String>, value: impl Into<String>) -> Port {
    Port {
        name: name.into(),
        what: what.into(),
        value: value.into(),
    }
}

pub(super) fn fill(fill: &mut Fill, model: &Model, terms: &Terms<f64>) {
    let (inputs, outputs) = (inputs(model, terms), outputs(model, terms));
    // A reset is no input of the compensator.
    let sample = inputs.iter().filter(|p| !p.value.is_empty());
    let sample: Vec<&str> = sample.map(|p| p.value.as_str()).collect();
    let lines: Vec<String> = outputs
        .iter()
        .enumerate()
        .map(|(k, p)| format!("    output_at(S, {k}, {});", p.value))
        .collect();
    fill.set("inputs", inputs.len().to_string())
        .set("outputs", outputs.len().to_string())
        .set("input_list", list(&inputs))
        .set("output_list", list(&outputs))
        .set("input_names", names(&inputs))
        .set("output_names", names(&outputs))
        .set("sample_inputs", sample.join(", "))
        .set("output_lines", lines.join("\n"));
}

fn inputs(model: &Model, terms: &Terms<f64>) -> Vec<Port> {
    let (x, v, f) = (model.length_unit(), model.speed_unit(), model.force_unit());
    let mut all = vec![
        port("reference_velocity", v, "input_at(S, 0)"),
        port(
            "tracking_error",
            format!("reference less measured position, {x}"),
            "input_at(S, 1)",
        ),
        port("enable", "whether to compensate", "enable"),
        port("reset", "off, at rest, with nothing learnt", ""),
    ];
    if model.settings.adaptation.is_some() {
        all.push(port(
            "drive_force",
            format!(
                "that the drive was given in the cycle before, this compensation included, {f}"
            ),
            "input_at(S, 4)",
        ));
        all.push(port(
            "learn",
            "not at the limits of the drive, nor while something else than friction and inertia pushes",
            "is_on(S, 5)",
        ));
    }
    for extra in Extra::of(terms) {
        let what = match extra {
            Extra::Acceleration => format!("of the reference, {}", model.acceleration_unit()),
            Extra::Position => format!("of the reference, zero where the log has it, {x}"),
            Extra::Load => model.load_unit(),
            Extra::Temperature => "K".into(),
            Extra::Transmitted => format!("what the load asks of the motor, {f}"),
        };
        let value = format!("input_at(S, {})", all.len());
        all.push(port(extra.name(), what, value));
    }
    all
}

fn outputs(model: &Model, terms: &Terms<f64>) -> Vec<Port> {
    let (x, f) = (model.length_unit(), model.force_unit());
    let state = |name: &str| format!("block.state.{name}");
    let flag = |name: &str| format!("block.state.{name} ? 1.0 : 0.0");
    let mut all = vec![
        port(
            "force",
            format!("to be added to the force of the controller, {f}"),
            state("output"),
        ),
        port(
            "learned",
            "the error without compensation is known: the force may come in",
            flag("learned"),
        ),
        port(
            "baseline",
            format!("rms error without compensation, {x}"),
            state("baseline"),
        ),
        port(
            "tripped",
            "the watchdog has switched off, until a reset",
            flag("tripped"),
        ),
        port(
            "reason",
            "why: 0 it has not; 1 larger mean square error; 2 larger peaks; 3 a setting out of range",
            "(real_T)block.state.reason",
        ),
        port("valid", "the parameters are in range", flag("ready")),
    ];
    if model.settings.adaptation.is_some() {
        all.extend([
            port(
                "level_dry",
                "factor on the dry part of the law's force",
                state("level_dry"),
            ),
            port(
                "level_viscous",
                "factor on its viscous part",
                state("level_viscous"),
            ),
            port(
                "mass_found",
                format!("beside them, {f} per {}", model.acceleration_unit()),
                state("mass_found"),
            ),
        ]);
    }
    let fed = terms::parts(terms);
    let friction = (!fed.is_empty()).then_some("friction");
    for part in friction.into_iter().chain(fed) {
        let name = format!("part_{part}");
        let what = format!("of the force, before limit and slew limit, {f}");
        all.push(port(&name, what, state(&name)));
    }
    all
}

fn list(ports: &[Port]) -> String {
    let lines = ports.iter().enumerate();
    let lines = lines.map(|(k, p)| format!(" *     {} {}: {}", k + 1, p.name, p.what));
    lines.collect::<Vec<_>>().join("\n")
}

fn names(ports: &[Port]) -> String {
    let names: Vec<String> = ports.iter().map(|p| format!("'{}'", p.name)).collect();
    names.join(", ")
}
