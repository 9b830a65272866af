//! What the friction of the simulated axis depends on, and the load and temperature that it works at.

use crate::config::{Given, Table};
use crate::error::Error;
use crate::study::model::Model;
use stiction_formats::{Dimension, Unit};
use stiction_friction::compensator::Channel;
use stiction_number::four_digits as short;
use stiction_parameters::Quantity;
use stiction_servo::law::AxisLaw;
use stiction_servo::levelled::Depends;
use stiction_servo::surroundings::Surroundings;

/// What the level of a model depends on; `None` where it depends on the velocity alone.
pub(super) fn depends(
    table: &Table<'_>,
    model: &Model,
    law: &AxisLaw,
) -> Result<Option<Depends>, Error> {
    let (load, temperature) = (table.get("load"), table.get("temperature"));
    let found = model.dependences(law.curve());
    let channels = found.channels;
    let mut depends = Depends {
        levels: found.levels.unwrap_or_default(),
        channels,
        ..Depends::default()
    };
    let unit = Unit::parse(model.unit_of(Quantity::LoadReference));
    let dimension = unit.map_or(Dimension::ONE, |unit| unit.dimension());
    let of_load = depends.on_load().then_some(channels.load);
    let of_temperature = depends.on_temperature().then_some(channels.temperature);
    depends.surroundings = Surroundings {
        load: at(load, of_load, dimension, "load")?,
        temperature: at(
            temperature,
            of_temperature,
            Dimension::TEMPERATURE,
            "temperature",
        )?,
        origin: channels.position.reference,
    };
    Ok(found.levels.map(|_| depends))
}

/// The value of a channel: as given, within what the log of the model has seen, or its reference.
fn at(
    given: Option<Given<'_>>,
    channel: Option<Channel<f64>>,
    dimension: Dimension,
    name: &str,
) -> Result<f64, Error> {
    let (given, channel) = match (given, channel) {
        (None, channel) => return Ok(channel.map_or(0.0, |c| c.reference)),
        (Some(given), Some(channel)) => (given, channel),
        (Some(given), None) => {
            let allowed = format!(
                "only with a model whose friction depends on it: identify with coulomb_{name} = true under [terms] of the axis file"
            );
            return Err(given.refused(&allowed));
        }
    };
    let value = match dimension {
        Dimension::ONE => given.as_number().ok_or_else(|| {
            given.refused("a number, without quotes: the load of the model has no unit")
        })?,
        dimension => given.value(&[dimension])?.0,
    };
    let [low, high] = channel.range;
    if (low..=high).contains(&value) {
        return Ok(value);
    }
    let unit = match dimension {
        Dimension::ONE => String::new(),
        dimension => format!(" {}", dimension.si_text()),
    };
    let allowed = format!(
        "what the log of the model has seen: {} to {}{unit}",
        short(low),
        short(high)
    );
    Err(given.refused(&allowed))
}
