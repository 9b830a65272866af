//! Why a compensator should not rely on a law, although it follows the log: what it says where the log has seen nothing.

use crate::source::Source;
use stiction_identify::FittedLaw;
use stiction_number::Percent;
use stiction_parameters::Quantity;

/// Ratio of the static friction of a law to the largest friction of the log, above which the log never shows that force,
/// dimensionless: a quarter more.
const UNSEEN_FORCE_RATIO: f64 = 1.25;

/// Says that a law has a level of friction that the logs never show.
pub(super) fn above_every_force(law: &FittedLaw, sources: &[Source]) -> Option<String> {
    let forces = sources
        .iter()
        .filter_map(|source| source.log.force.as_ref());
    let largest = forces.flatten().fold(0.0, |most: f64, f| most.max(f.abs()));
    let level = |quantity: Quantity| {
        let levels = law.parameters.iter();
        let levels = levels.filter(|p| p.name.quantity == quantity);
        levels.map(|p| p.value).fold(0.0, f64::max)
    };
    let (coulomb, fixed) = (level(Quantity::Coulomb), level(Quantity::Static));
    let (name, most) = match fixed >= coulomb {
        true => ("static friction", fixed),
        false => ("Coulomb friction", coulomb),
    };
    (most > UNSEEN_FORCE_RATIO * largest).then(|| {
        let part = Percent::error(100.0 * (most / largest - 1.0));
        format!(
            "its {name} is {} above the largest force of the log",
            part.digits(2)
        )
    })
}
