//! The simulated axis in words and numbers.

use stiction_files::study::result::{SimulatedAxis, StudyFile};
use stiction_files::symbols;
use stiction_log::Motion;
use stiction_number::quantity;
use stiction_report::{Align, Block, Table, Text, number};

pub(super) fn motion(axis: &SimulatedAxis) -> Motion {
    match axis.kind.as_str() {
        "rotary" => Motion::Rotary,
        _ => Motion::Linear,
    }
}

pub(super) fn mass_unit(axis: &SimulatedAxis) -> &'static str {
    match motion(axis) {
        Motion::Linear => "kg",
        Motion::Rotary => "kg·m²",
    }
}

/// What is said of an axis.
pub(super) fn axis(file: &StudyFile, axis: &SimulatedAxis) -> Block {
    let length = symbols::length_unit(motion(axis));
    let mut facts = vec![
        ("Friction", axis.origin.clone()),
        ("σ₁", axis.sigma1.clone()),
        (
            "Control rate",
            format!(
                "{} Hz, plant stepped {} times a period",
                number::sig(axis.rate_hz, 4),
                axis.substeps
            ),
        ),
        ("Delay", quantity(axis.delay_s, "s")),
        (
            "Current loop",
            match axis.current_lag_s {
                0.0 => "at once".into(),
                lag => format!("lag of {}", quantity(lag, "s")),
            },
        ),
        ("Encoder step", quantity(axis.encoder, length)),
    ];
    // A law of elements has none.
    facts.retain(|(name, text)| *name != "σ₁" || !text.is_empty());
    if axis.position_noise > 0.0 {
        let noise = quantity(axis.position_noise, length);
        facts.push(("Position noise", format!("{noise} rms")));
    }
    facts.extend(forces(axis));
    for event in file
        .events
        .iter()
        .filter(|_| std::ptr::eq(axis, &file.axis))
    {
        let mass = event
            .mass
            .map(|mass| format!("mass {} {}", number::sig(mass, 4), mass_unit(axis)));
        let friction = event
            .friction
            .map(|by| format!("friction × {} of the law", number::sig(by, 3)));
        let changes: Vec<String> = mass.into_iter().chain(friction).collect();
        let at = number::sig(event.time_s, 4);
        facts.push(("Changes", format!("from {at} s on: {}", changes.join(", "))));
    }
    for path in &file.paths {
        let text = format!(
            "{}, {} s, counted from {} s on",
            path.kind,
            number::sig(path.duration_s, 4),
            number::sig(path.skip_s, 4)
        );
        facts.push((&path.name, text));
    }
    let text = |(name, value): (&str, String)| (Text::from(name), Text::from(value));
    let mut facts: Vec<_> = facts.into_iter().map(text).collect();
    for input in &file.inputs {
        facts.push((
            Text::new().code(input.path.as_str()),
            Text::new().code(input.sha256.as_str()),
        ));
    }
    Block::Facts(facts)
}

/// What acts on the axis beside friction and the drive, and what the drive makes of a voltage.
fn forces(axis: &SimulatedAxis) -> Vec<(&'static str, String)> {
    let (length, force) = (
        symbols::length_unit(motion(axis)),
        symbols::force_unit(motion(axis)),
    );
    let mut facts = Vec::new();
    if axis.viscous > 0.0 {
        let unit = format!("{force}*s/{length}");
        facts.push(("Damper beside the law", quantity(axis.viscous, &unit)));
    }
    if axis.spring > 0.0 {
        let unit = format!("{force}/{length}");
        facts.push(("Spring", quantity(axis.spring, &unit)));
    }
    if let Some(disturbance) = &axis.disturbance {
        let force = |x: Option<f64>| quantity(x.unwrap_or(0.0), force);
        let text = match disturbance.kind.as_str() {
            "constant" => format!("{}, constant", force(disturbance.force)),
            "sine" => format!(
                "a sine of {} at {} Hz",
                force(disturbance.amplitude),
                number::sig(disturbance.frequency_hz.unwrap_or(0.0), 4)
            ),
            _ => "from a file".into(),
        };
        facts.push(("Disturbance", text));
    }
    if let Some(voltage) = &axis.voltage {
        let amplifier = match voltage.back_emf {
            0.0 => format!("{} A/V", number::sig(voltage.amplifier_gain, 4)),
            emf => format!(
                "{} Ω, {} V·s/{length}",
                number::sig(1.0 / voltage.amplifier_gain, 4),
                number::sig(emf, 4)
            ),
        };
        let limit = voltage.limit.map_or(String::new(), |limit| {
            format!(", at most {}", quantity(limit, "V"))
        });
        let constant = number::sig(voltage.force_constant, 4);
        let unit = symbols::force_unit(motion(axis));
        let unit = number::unit(&format!("{unit}/A"));
        facts.push(("Voltage", format!("{constant} {unit}, {amplifier}{limit}")));
    }
    facts
}

/// The parameters of its law.
pub(super) fn parameters(axis: &SimulatedAxis) -> Table {
    let columns = [
        ("Parameter", Align::Left),
        ("", Align::Left),
        ("Value", Align::Right),
        ("Unit", Align::Left),
    ];
    let table = Table::new(columns).caption("Parameters of the simulated axis.");
    axis.parameters.iter().fold(table, |table, p| {
        table.row([
            symbols::meaning(&p.name, motion(axis)),
            symbols::symbol(&p.name),
            number::sig(p.value, 4),
            number::unit(&p.unit),
        ])
    })
}
