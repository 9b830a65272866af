//! `--break-away`: force ramps, each with its rate, and what the model predicts at that rate.

use super::curve;
use crate::error::Error;
use crate::identify::beside::Beside;
use crate::identify::logs::{refused, samples};
use stiction_files::result::BreakAwayEntry;
use stiction_identify::FittedLaw;
use stiction_identify::procedure::{Run, break_away as find, predict_break_away};
use stiction_parameters::{ParameterSet, Quantity};

/// Speed that counts as broken away, as a part of the Stribeck velocity, where a model is known, dimensionless: well above
/// the creep of presliding, well below the velocity at which friction has fallen.
const BROKEN_AWAY_SPEED: f64 = 1.0 / 3.0;

/// The break-aways of the runs given, in their order.
pub(in crate::identify) fn break_away(
    beside: &Beside,
    law: &FittedLaw,
) -> Result<Vec<BreakAwayEntry>, Error> {
    let sources = &beside.break_away;
    let own = samples(sources)?;
    // A model that was given comes first: the method in use may not identify a stiffness.
    let mut values = law.values();
    let given = beside.model.as_ref().and_then(|read| read.model.values());
    for (name, value) in given.iter().flat_map(ParameterSet::iter) {
        values.insert(name, value);
    }
    let mut out = Vec::new();
    for (k, (source, samples)) in sources.iter().zip(&own).enumerate() {
        let run = Run {
            samples,
            reference: None,
            resolution: source.log.quantum,
        };
        let positive = samples.force.iter().sum::<f64>() >= 0.0;
        let model = curve::plant(&values, positive);
        let threshold = model.map(|(_, side)| BROKEN_AWAY_SPEED * side.stribeck_velocity);
        let found = find(&run, threshold, k).map_err(|e| refused(sources, e))?;
        let sign = found.rate.signum();
        let predicted = model
            .and_then(|(plant, _)| predict_break_away(&plant, found.rate.abs(), found.threshold));
        let offset = values.get(Quantity::Offset).unwrap_or(0.0);
        out.push(BreakAwayEntry {
            path: source.path.display().to_string(),
            rate: found.rate,
            force: found.force,
            force_scatter: found.scatter,
            time_s: found.time,
            displacement: found.displacement,
            threshold: found.threshold,
            predicted_force: predicted.map(|p| sign * p.force + offset),
            predicted_friction: predicted.map(|p| sign * p.friction),
        });
    }
    Ok(out)
}
