//! Why a compensator should not rely on a law, although it follows the log: what it says where the log has seen nothing.

use crate::source::Source;
use stiction_identify::FittedLaw;
use stiction_parameters::Quantity;

/// The largest level of friction of a law, and its ratio to the largest force of the logs.
pub(super) fn largest_level(law: &FittedLaw, sources: &[Source]) -> (&'static str, f64) {
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
    (name, most / largest)
}
