//! Logs of one axis of which some have the sign of the force turned round.

use super::logs::{has_wrong_sign, path_of};
use crate::source::Source;
use stiction_identify::Disagreement;
use stiction_parameters::Quantity;
use stiction_policy::agreement;

/// The logs that have the sign turned and the others; `None` where none or all of them have.
pub(super) fn named(sources: &[Source], found: &[Disagreement]) -> Option<(String, String)> {
    let turned = braking(sources).or_else(|| lighter_than_nothing(found))?;
    let others: Vec<usize> = (0..sources.len()).filter(|i| !turned.contains(i)).collect();
    let names = |logs: &[usize]| {
        let names: Vec<String> = logs.iter().map(|i| path_of(sources, *i)).collect();
        names.join(", ")
    };
    Some((names(&turned), names(&others)))
}

/// The logs whose force brakes, where that of others does not.
fn braking(sources: &[Source]) -> Option<Vec<usize>> {
    let all = 0..sources.len();
    let braking: Vec<usize> = all.filter(|i| has_wrong_sign(&sources[*i])).collect();
    (!braking.is_empty() && braking.len() < sources.len()).then_some(braking)
}

/// The log with a negative mass, where another has one as large: of fast motions the work of friction is a small part, and does
/// not show the sign.
fn lighter_than_nothing(found: &[Disagreement]) -> Option<Vec<usize>> {
    let of_mass = found.iter().find(|d| d.name.quantity == Quantity::Mass)?;
    let [low, high] = of_mass.values;
    let ratio = -low / high;
    ((1.0 / agreement::MAX_MASS_RATIO..agreement::MAX_MASS_RATIO).contains(&ratio))
        .then(|| vec![of_mass.logs[0]])
}
