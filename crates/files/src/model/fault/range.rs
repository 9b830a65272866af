//! What is wrong with the ranges of a model, and the values within them at which its parameters hold.

use super::Fault;
use crate::model::form::ModelFile;
use crate::model::read::BY_HAND;
use stiction_number::{four_digits, shortest};
use stiction_parameters::{Name, Quantity};

/// Below this, K, a range that somebody wrote is rather one in degrees Celsius.
const COLD: f64 = 150.0;

/// A temperature range that is not in K. One that was identified is, however cold the axis.
pub(super) fn cold(model: &ModelFile) -> Option<Fault> {
    let [low, high] = model.range.temperature?;
    (model.source.method == BY_HAND && low < COLD).then(|| {
        let ends = [low, high].map(shortest);
        let kelvin = [low, high].map(|degrees| shortest(degrees + 273.15));
        let allowed = format!(
            "K, from {} K; of degrees Celsius these are [{}, {}]",
            shortest(COLD),
            kelvin[0],
            kelvin[1]
        );
        let found = format!("[{}, {}]", ends[0], ends[1]);
        ("range.temperature".into(), found, allowed)
    })
}

/// References that are missing where a range makes a parameter count, or outside of their range.
pub(super) fn references(model: &ModelFile) -> Vec<Fault> {
    let range = &model.range;
    [
        ("load", range.load, Quantity::LoadReference),
        (
            "temperature",
            range.temperature,
            Quantity::TemperatureReference,
        ),
        ("position", range.position, Quantity::PositionReference),
    ]
    .into_iter()
    .filter_map(|(what, range, reference)| {
        let [low, high] = range.filter(|_| what != "temperature" || cold(model).is_none())?;
        let stem = reference.stem();
        let Some(i) = model.parameter.iter().position(|p| p.name == stem) else {
            return missing(model, what, reference);
        };
        let p = &model.parameter[i];
        let inside = (low..=high).contains(&p.value);
        // An identification may have fitted less than what the mean is of.
        (model.source.method == BY_HAND && !inside).then(|| {
            let [at, low, high] = [p.value, low, high].map(four_digits);
            let found = format!("{stem} = {at}");
            let allowed = format!("within [range] {what}, {low} to {high}");
            (format!("parameter[{}].value", i + 1), found, allowed)
        })
    })
    .collect()
}

/// A parameter that is a slope from a reference that the model does not have.
fn missing(model: &ModelFile, what: &str, reference: Quantity) -> Option<Fault> {
    let depends = |quantity: Quantity| match reference {
        Quantity::LoadReference => quantity == Quantity::CoulombLoad,
        Quantity::TemperatureReference => matches!(
            quantity,
            Quantity::CoulombTemperature | Quantity::Sigma2Temperature
        ),
        _ => matches!(
            quantity,
            Quantity::CoulombPosition | Quantity::CoulombMap(_)
        ),
    };
    let is_it = |name: Name| depends(name.quantity);
    let i = (model.parameter.iter()).position(|p| p.name.parse().is_ok_and(is_it))?;
    let (name, stem) = (&model.parameter[i].name, reference.stem());
    Some((
        format!("parameter[{}].name", i + 1),
        format!("{name} without {stem}"),
        format!(
            "a [[parameter]] with name = \"{stem}\": the {what} at which the other parameters hold"
        ),
    ))
}
