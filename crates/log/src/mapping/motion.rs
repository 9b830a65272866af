//! Linear or rotary, from what is known of the columns.

use super::channel::{Motion, Role};
use super::names;
use crate::{Dimension, Error, Kind};

/// The kind of motion that a dimension in a role tells.
pub(super) fn of(role: Role, dimension: Dimension) -> Option<Motion> {
    [Motion::Linear, Motion::Rotary]
        .into_iter()
        .find(|m| match role {
            Role::Position | Role::Reference => dimension == m.position(),
            Role::Velocity => dimension == m.velocity(),
            Role::Acceleration => dimension == m.acceleration(),
            Role::Force => dimension == m.force(),
            _ => false,
        })
}

/// The kind that units tell: position first, then velocity, then force.
pub(super) fn from_units(known: &[(Role, Dimension)]) -> Option<(Motion, Role)> {
    [Role::Position, Role::Velocity, Role::Force]
        .into_iter()
        .find_map(|role| {
            let (_, dimension) = known.iter().find(|(r, _)| *r == role)?;
            Some((of(role, *dimension)?, role))
        })
}

/// The kind that names tell, refused where they tell nothing or two things.
pub(super) fn from_names<'a>(chosen: impl Iterator<Item = &'a str>) -> Result<Motion, Error> {
    let mut told: Vec<Motion> = chosen.filter_map(names::motion).collect();
    told.dedup();
    match told.as_slice() {
        [one] => Ok(*one),
        _ => Err(Error::new(
            Kind::Ambiguous,
            "neither the units nor the names show whether the axis is linear or rotary",
            "set it in axis.toml: kind = \"linear\" or kind = \"rotary\"",
        )),
    }
}
