//! `[axis] parameters`: the numbers of a LuGre law as a publication or a data sheet has them.

use super::dimensions::Dimensions;
use crate::config::{Given, Table};
use crate::error::Error;
use crate::study::model::{Model, Parameter};
use crate::symbols;
use stiction_log::Motion;
use stiction_parameters::{Dimension, LawError, Quantity};

/// What has to be given.
const NEEDED: [(&str, Quantity); 6] = [
    ("sigma0", Quantity::Sigma0),
    ("sigma1", Quantity::Sigma1),
    ("sigma2", Quantity::Sigma2),
    ("coulomb", Quantity::Coulomb),
    ("static", Quantity::Static),
    ("stribeck_velocity", Quantity::StribeckVelocity),
];
/// What may be given beside it.
const EXPONENT: &str = "stribeck_exponent";

/// The law of a table of parameters; a linear axis or a rotary one, as the unit of sigma0 says.
pub(super) fn published(given: &Given<'_>) -> Result<Model, Error> {
    let allowed = "a table such as { sigma0 = \"2e6 N/m\", sigma1 = \"1500 N s/m\", sigma2 = \"30 N s/m\", coulomb = \"12 N\", \
                   static = \"18 N\", stribeck_velocity = \"3 mm/s\" }";
    let Some(table) = given.as_table() else {
        return Err(given.refused(allowed));
    };
    let missing = NEEDED.map(|(key, _)| key).into_iter();
    let missing: Vec<&str> = missing.filter(|key| table.get(key).is_none()).collect();
    if !missing.is_empty() {
        // A key that is nearly one of those is named first.
        table.get(EXPONENT);
        table.end()?;
        let found = format!("has no {}", missing.join(", "));
        return Err(given.refuse(found, allowed));
    }
    let motion = motion(&table)?;
    let is = Dimensions::of(motion);
    let force = symbols::force_unit(motion);
    let mut parameters = Vec::new();
    for (key, quantity) in NEEDED {
        let dimension = is.of_parameter(quantity);
        // Damping may be none; the other numbers of the law are above zero.
        let value = match quantity.dimension() {
            Dimension::Damping => table.not_negative(key, dimension)?,
            _ => table.positive(key, dimension)?,
        };
        parameters.extend(value.map(|value| Parameter {
            name: quantity.into(),
            value,
            unit: symbols::unit(quantity.dimension(), motion, force, ""),
        }));
    }
    let exponent = Quantity::StribeckExponent;
    if let Some(given) = table.get(EXPONENT) {
        let allowed = exponent.allowed();
        let value = given.as_number().filter(|x| allowed.admits(*x));
        parameters.push(Parameter {
            name: exponent.into(),
            value: value.ok_or_else(|| given.refused(&format!("a number {}", allowed.words())))?,
            unit: "1".into(),
        });
    }
    table.end()?;
    let model = Model::exact(motion, "Parameters given in the study".into(), parameters);
    match model.values().lugre() {
        Ok(_) => Ok(model),
        Err(LawError::Value(e)) => Err(table.together(&e)),
        Err(e) => Err(given.refuse(e.to_string(), allowed)),
    }
}

/// Which kind of axis it is.
fn motion(table: &Table<'_>) -> Result<Motion, Error> {
    let stiffness = |motion: Motion| {
        let is = Dimensions::of(motion);
        Dimensions::per(is.force, is.length)
    };
    let kinds = [Motion::Linear, Motion::Rotary];
    let given = table.get("sigma0");
    let Some(given) = given else {
        return Ok(Motion::Linear);
    };
    let (_, dimension) = given.positive(&kinds.map(stiffness))?;
    Ok(match dimension == stiffness(Motion::Rotary) {
        true => Motion::Rotary,
        false => Motion::Linear,
    })
}
