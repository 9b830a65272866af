//! Symbols and units of parameters, for files and people.

use stiction_log::Motion;
use stiction_parameters::{Dimension, Name, Quantity, Side, Units};

/// Unit of a parameter, given the units of the force and the load channel.
pub fn unit(dimension: Dimension, motion: Motion, force: &str, load: &str) -> String {
    let units = match motion {
        Motion::Linear => Units::linear(force),
        Motion::Rotary => Units::rotary(force),
    };
    units.with_load(load).of(dimension)
}

/// Unit of position.
pub fn length_unit(motion: Motion) -> &'static str {
    match motion {
        Motion::Linear => "m",
        Motion::Rotary => "rad",
    }
}

/// Unit of force.
pub fn force_unit(motion: Motion) -> &'static str {
    match motion {
        Motion::Linear => "N",
        Motion::Rotary => "N*m",
    }
}

/// Unit of velocity.
pub fn speed_unit(motion: Motion) -> &'static str {
    match motion {
        Motion::Linear => "m/s",
        Motion::Rotary => "rad/s",
    }
}

/// SI unit of an acceleration.
pub fn acceleration_unit(motion: Motion) -> &'static str {
    match motion {
        Motion::Linear => "m/s^2",
        Motion::Rotary => "rad/s^2",
    }
}

/// Symbol of a parameter by its name in files, in Unicode.
pub fn symbol(name: &str) -> String {
    name.parse()
        .map_or_else(|_| name.to_string(), |name: Name| name.symbol())
}

/// What a parameter is, by its name in files, in the words of the field.
pub fn meaning(name: &str, motion: Motion) -> String {
    name.parse()
        .map_or_else(|_| name.to_string(), |name| meaning_of(name, motion))
}

/// What a parameter is, in the words of the field.
pub fn meaning_of(name: Name, motion: Motion) -> String {
    let side = match name.side {
        Side::Both => "",
        Side::Positive => ", positive direction",
        Side::Negative => ", negative direction",
    };
    let text = match (name.quantity, motion) {
        (Quantity::Mass, Motion::Rotary) => "inertia",
        (quantity, _) => quantity.meaning(),
    };
    format!("{text}{side}")
}

/// What drives the axis, in words. A current or voltage that was not scaled keeps its own name.
pub fn driver(motion: Motion, force_unit: &str) -> &'static str {
    match (force_unit, motion) {
        ("A", _) => "current",
        ("V", _) => "voltage",
        (_, Motion::Linear) => "force",
        (_, Motion::Rotary) => "torque",
    }
}
