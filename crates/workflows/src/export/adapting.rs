//! What levels that follow the force of the drive would take for friction, and how that gets out of it.

use super::Feedforward;
use stiction_files::{ModelFile, Warning};
use stiction_say::{Notice, Taken};

/// What levels that follow the force of the drive would take for friction.
pub(super) fn taken_for_friction(
    file: &ModelFile,
    mass: Option<f64>,
    fed: Feedforward,
) -> Option<Warning> {
    let has = |stem: &str| file.parameter.iter().any(|p| p.name.starts_with(stem));
    let taken = [
        (mass.is_none(), Taken::Inertia),
        (has("gravity_") && !fed.gravity, Taken::Gravity),
        (has("cogging") && !fed.cogging, Taken::Cogging),
    ];
    let taken = taken
        .into_iter()
        .filter_map(|(is, what)| is.then_some(what));
    let taken: Vec<Taken> = taken.collect();
    let also = Feedforward {
        gravity: fed.gravity || has("gravity_"),
        cogging: fed.cogging || has("cogging"),
        ..fed
    };
    (!taken.is_empty()).then(|| {
        let notice = Notice::NotFriction {
            taken,
            feedforward: (also != fed).then(|| also.names().join(",")),
            no_mass: mass.is_none(),
        };
        notice.into()
    })
}
