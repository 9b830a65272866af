//! What levels that follow the force of the drive would take for friction, and how that gets out of it.

use super::Feedforward;
use stiction_codes::Code;
use stiction_files::{ModelFile, Warning};

/// What levels that follow the force of the drive would take for friction.
pub(super) fn taken_for_friction(
    file: &ModelFile,
    mass: Option<f64>,
    fed: Feedforward,
) -> Option<Warning> {
    let has = |stem: &str| file.parameter.iter().any(|p| p.name.starts_with(stem));
    let taken = [
        (
            mass.is_none(),
            "what accelerates the axis, since the model has no mass that the log determines",
        ),
        (has("gravity_") && !fed.gravity, "gravity"),
        (has("cogging") && !fed.cogging, "cogging"),
    ];
    let taken: Vec<&str> = taken
        .into_iter()
        .filter_map(|(is, what)| is.then_some(what))
        .collect();
    (!taken.is_empty()).then(|| {
        Warning::new(
            Code::ExportAdaptation,
            format!(
                "levels that follow the force of the drive take for friction: {}. {}",
                taken.join("; "),
                out_of_it(file, mass, fed)
            ),
        )
    })
}

/// How what is no friction gets out of the force that levels follow.
fn out_of_it(file: &ModelFile, mass: Option<f64>, fed: Feedforward) -> String {
    let has = |stem: &str| file.parameter.iter().any(|p| p.name.starts_with(stem));
    let also = Feedforward {
        gravity: fed.gravity || has("gravity_"),
        cogging: fed.cogging || has("cogging"),
        ..fed
    };
    let mut ways = Vec::new();
    if also != fed {
        ways.push(format!(
            "export with --feedforward {}, and the block takes it off by itself; or subtract it from drive_force",
            also.names().join(",")
        ));
    }
    if mass.is_none() {
        ways.push("give the mass in the axis file, mass = \"4.6 kg\", and identify again".into());
    }
    ways.push("or let them learn only where it is small".into());
    let text = ways.join("; ");
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}
