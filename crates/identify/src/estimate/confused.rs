//! Whether a Coulomb level is more than its sum with viscous friction, and a constant force more than its sum with inertia or with a
//! wave that is longer than the stroke.
//!
//! Where an axis slides at hardly more than one speed, a log shows the force there, and Coulomb and viscous friction share it
//! in many ways. Viscous friction is never negative: an estimate that is pressed against zero, by noise or by anything that
//! the law does not describe, takes the level along, and neither its deviation nor replicas of it show how far.

use crate::conditioning::record::Record;
use crate::estimate::uncertainty;
use crate::law::terms::Terms;
use crate::misfit::STRAIGHT;
use crate::parameter::Parameter;
use crate::parameter::covariance::Covariance;
use crate::parameter::physical::{Physical, propagate};
use crate::separable::objective::{Evaluation, Objective};
use stiction_parameters::{Name, Quantity, Side};

/// Correlation of a level with the viscous friction of its direction from which the two share one force.
const SHARED: f64 = 0.9;
/// Part of a level from which what viscous friction may still be worth there counts.
const WORTH: f64 = 0.1;
/// Part of a level from which what viscous friction takes of it within chance counts, where the two share one force: below
/// it, the level is known whatever viscous friction is.
const WORTH_OF_CHANCE: f64 = 0.01;
/// Standard deviations within which viscous friction cannot be told from none.
const CHANCE: f64 = 2.0;

/// Part of the mean square of the acceleration that is constant from which inertia and constant force share one force.
const CONSTANT: f64 = 0.9;

/// Flags a constant force beside an inertia that is open, where the acceleration hardly changes but for noise of the encoder, which
/// makes the two look apart.
pub(super) fn flag_a_force_that_takes_the_inertia(record: &Record, parameters: &mut [Parameter]) {
    let open = |p: &Parameter| p.name == Quantity::Mass && p.identified && !p.identifiable;
    let acceleration = record.pick(|s| &s.acceleration);
    let n = acceleration.len() as f64;
    let mean = acceleration.iter().sum::<f64>() / n;
    let square = acceleration.iter().map(|a| a * a).sum::<f64>() / n;
    if !parameters.iter().any(open) || mean * mean < CONSTANT * square {
        return;
    }
    let constant = |p: &&mut Parameter| p.name == Quantity::Offset && p.identifiable;
    if let Some(own) = parameters.iter_mut().find(constant) {
        own.identifiable = false;
        own.reason =
            "takes the place of what inertia does where the acceleration hardly changes".into();
    }
}

/// Flags a constant force beside a wave over the position of which the stroke is a small part: the two share one force. A weight is
/// such a wave, of one turn, and on less than a quarter of it whatever changes along the position looks like one.
pub(super) fn flag_a_force_that_takes_a_long_wave(
    record: &Record,
    terms: &Terms,
    parameters: &mut [Parameter],
) {
    let is_long = |pitch: f64| pitch > STRAIGHT * record.stroke();
    let weight = terms.gravity && is_long(std::f64::consts::TAU);
    if !weight && !terms.cogging.iter().any(|pitch| is_long(*pitch)) {
        return;
    }
    for own in parameters
        .iter_mut()
        .filter(|p| p.identified && p.identifiable)
    {
        let reason = match own.name.quantity {
            Quantity::Gravity(_) if weight => {
                "on less than a quarter turn any force that changes along the position looks like a weight"
            }
            Quantity::Offset => {
                "shares one force with a wave over the position that is longer than the stroke"
            }
            _ => continue,
        };
        own.identifiable = false;
        own.reason = reason.into();
    }
}

/// Flags the Coulomb levels that take the place of a viscous friction which the data do not tell from none.
pub(super) fn flag_levels_that_take_viscous_friction(
    objective: &Objective,
    at: &Evaluation,
    raw: &[Physical],
    parameters: &mut [Parameter],
) {
    let cannot_be_told = |p: &Parameter| {
        let is_low = p.std.is_none_or(|std| p.value <= CHANCE * std);
        p.name.quantity == Quantity::Sigma2 && p.identified && !p.identifiable && is_low
    };
    let open: Vec<(Side, Option<f64>)> = parameters
        .iter()
        .filter(|p| cannot_be_told(p))
        .map(|p| (p.name.side, p.ci95.map(|(_, high)| high - p.value)))
        .collect();
    if open.is_empty() {
        return;
    }
    let matrix = propagate(raw, &uncertainty::free(objective, at).covariance);
    let covariance = Covariance::new(raw.iter().map(|p| p.name).collect(), &matrix);
    let correlation = covariance.correlation();
    for (side, more) in open {
        let of = |quantity| covariance.place(Name::new(quantity, side));
        let (Some(level), Some(viscous)) = (of(Quantity::Coulomb), of(Quantity::Sigma2)) else {
            continue;
        };
        // Force at which one takes the place of the other, for each unit of viscous friction.
        let taken = -matrix[(level, viscous)] / matrix[(viscous, viscous)];
        let name = Name::new(Quantity::Coulomb, side);
        let own = parameters.iter_mut().find(|p| p.name == name);
        if let Some(own) = own.filter(|p| p.identifiable) {
            let is_much = more.is_some_and(|more| taken * more > WORTH * own.value);
            let chance = CHANCE * taken * matrix[(viscous, viscous)].sqrt();
            let is_shared =
                correlation[level][viscous] <= -SHARED && chance > WORTH_OF_CHANCE * own.value;
            if !is_much && !is_shared {
                continue;
            }
            own.identifiable = false;
            own.reason = "it shares one force with viscous friction, which this motion does not tell from none".into();
        }
    }
}
