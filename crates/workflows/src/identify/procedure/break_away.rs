//! `--break-away`: force ramps, each with its rate, and what the model predicts at that rate.

use super::curve;
use crate::error::Error;
use crate::identify::beside::Beside;
use crate::identify::logs::{refused, samples};
use std::collections::VecDeque;
use stiction_files::Warning;
use stiction_files::result::{BreakAwayEntry, ResultFile};
use stiction_identify::FittedLaw;
use stiction_identify::procedure::{Run, break_away as find, predict_break_away};
use stiction_parameters::{Name, ParameterSet, Quantity, Side};
use stiction_policy::procedure;
use stiction_say::Notice;

/// Break-aways, and what is to be said of runs that show none.
#[derive(Default)]
pub(in crate::identify) struct BreakAways {
    pub entries: Vec<BreakAwayEntry>,
    pub warnings: Vec<Warning>,
}

impl BreakAways {
    /// Puts them into the result.
    pub fn into_result(self, result: &mut ResultFile) {
        result.break_away = self.entries;
        result.warnings.extend(self.warnings);
    }
}

/// The break-aways of the runs given, in their order, each for itself: one that shows none is left out with a warning.
///
/// # Errors
/// Where none of the runs shows a break-away.
pub(in crate::identify) fn break_away(
    beside: &Beside,
    law: &FittedLaw,
) -> Result<BreakAways, Error> {
    let sources = &beside.break_away;
    let own = samples(sources)?;
    // A model that was given comes first: the method in use may not identify a stiffness.
    let mut values = law.values();
    let given = beside.model.as_ref().and_then(|read| read.model.values());
    for (name, value) in given.iter().flat_map(ParameterSet::iter) {
        values.insert(name, value);
    }
    let mut out = BreakAways::default();
    let mut refusals = VecDeque::new();
    for (k, (source, samples)) in sources.iter().zip(&own).enumerate() {
        let run = Run {
            samples,
            reference: None,
            resolution: source.log.quantum,
        };
        let positive = samples.force.iter().sum::<f64>() >= 0.0;
        let model = curve::plant(&values, positive);
        let threshold = model
            .filter(|_| knows_curve(beside, law, positive))
            .map(|(_, side)| procedure::BREAK_AWAY_OF_STRIBECK * side.stribeck_velocity);
        let found = match find(&run, threshold, k) {
            Ok(found) => found,
            Err(e) => {
                refusals.push_back(refused(sources, e));
                continue;
            }
        };
        let sign = found.rate.signum();
        let predicted = model
            .and_then(|(plant, _)| predict_break_away(&plant, found.rate.abs(), found.threshold));
        let offset = values.get(Quantity::Offset).unwrap_or(0.0);
        let mass = values.get(Quantity::Mass).filter(|mass| *mass > 0.0);
        let inertia = mass.map(|mass| mass * found.acceleration);
        out.entries.push(BreakAwayEntry {
            path: stiction_files::shell::text(&source.path),
            rate: found.rate,
            force: found.force,
            force_scatter: found.scatter,
            time_s: found.time,
            displacement: found.displacement,
            threshold: found.threshold,
            predicted_force: predicted.map(|p| sign * p.force + offset),
            friction: inertia.map(|inertia| found.force - inertia - offset),
            inertia,
            offset,
            predicted_friction_there: predicted.map(|p| sign * p.at_threshold),
            predicted_friction: predicted.map(|p| sign * p.friction),
            slips: found.slips,
        });
    }
    if out.entries.is_empty()
        && let Some(first) = refusals.pop_front()
    {
        return Err(first);
    }
    for refusal in refusals {
        let why = refusal.to_string();
        out.warnings.push(Notice::NoBreakAway { why }.into());
    }
    Ok(out)
}

/// Whether the Stribeck velocity that the threshold follows is determined: one that is not may be anything.
fn knows_curve(beside: &Beside, law: &FittedLaw, positive: bool) -> bool {
    let side = match positive {
        true => Side::Positive,
        false => Side::Negative,
    };
    let names = [
        Name::from(Quantity::StribeckVelocity),
        Name::new(Quantity::StribeckVelocity, side),
    ];
    if let Some(read) = &beside.model {
        let mut own = read.model.parameter.iter();
        let of_name = |name: &str| name.parse().is_ok_and(|name| names.contains(&name));
        if let Some(given) = own.find(|p| of_name(&p.name)) {
            return given.identifiable;
        }
    }
    let found = law.parameters.iter().find(|p| names.contains(&p.name));
    found.is_some_and(|p| p.identifiable)
}
