//! The axes of a robot file: what holds for all joints, and what a joint has of its own.

use super::columns::{columns, roles};
use super::drive::drive;
use super::resolver::{FORCES, LENGTHS, Resolver};
use super::text_options;
use crate::axis::values::Axis;
use crate::config::{Form, Places, Source, Table};
use crate::error::Error;
use std::path::Path;
use stiction_formats::{Dimension, Unit, Value};
use stiction_log::mapping::{FORCE_LIMITS, RESOLUTIONS};
use stiction_log::{Mapping, Role};

/// Roles that the columns of a joint may have.
const ROLES: [Role; 5] = [
    Role::Position,
    Role::Velocity,
    Role::Force,
    Role::Reference,
    Role::Temperature,
];
/// Gear ratios that a machine may have, of either sign.
const GEAR_RATIOS: std::ops::RangeInclusive<f64> = 1e-4..=1e4;

impl Axis {
    /// What a robot file says of every joint: the clock, which part of the logs counts, how a text is written.
    pub(crate) fn of_robot(
        root: &Table<'_>,
        source: &Source<'_>,
        places: Places,
    ) -> Result<Self, Error> {
        let mut axis = Axis {
            file: source.file.to_path_buf(),
            places,
            gravity_is_stated: true,
            ..Axis::default()
        };
        let resolver = Resolver::default();
        resolver.mapping(root, &mut axis.mapping)?;
        drive(root, &mut axis.mapping)?;
        let folder = source.file.parent().unwrap_or(Path::new(""));
        columns(root, &mut axis.mapping, folder)?;
        let given = Role::ALL.into_iter().filter(|role| *role != Role::Time);
        if let Some(role) = given
            .into_iter()
            .find(|r| axis.mapping.channel(*r).is_some())
        {
            let allowed = "time and enable here, and the columns of a joint under [joint.NAME]";
            let key = format!("columns.{role}");
            return Err(axis.places.refuse(&key, "is of one joint".into(), allowed));
        }
        if let Some(log) = root.table("log")? {
            resolver.every_log(&log, &mut axis.mapping)?;
            log.end()?;
        }
        text_options(root, &mut axis.text)?;
        axis.ethercat = super::ethercat::process_data(root)?;
        axis.tied = resolver.tied.into_inner();
        Ok(axis)
    }

    /// What a robot file without any line says.
    pub(crate) fn of_no_robot(name: &str) -> Self {
        Axis {
            file: name.into(),
            places: Places::in_memory(name, Form::Robot),
            gravity_is_stated: true,
            ..Axis::default()
        }
    }

    /// The axis of a joint of which nothing is said.
    pub(crate) fn joint(&self, name: &str) -> Self {
        let places = self.places.with_columns_in(format!("joint.{name}"));
        Axis {
            name: Some(name.into()),
            places,
            ..self.clone()
        }
    }

    /// The axis of a joint with the columns and other values of its table.
    pub(crate) fn joint_of(&self, name: &str, table: &Table<'_>) -> Result<Self, Error> {
        let mut axis = self.joint(name);
        let folder = self.file.parent().unwrap_or(Path::new(""));
        let mapping = &mut axis.mapping;
        axis.joined = roles(table, &ROLES, mapping, folder)?;
        if table.find("servo").is_some() || table.find("drive").is_some() {
            drive(table, mapping)?;
        }
        let resolver = Resolver::default();
        let within = |key, dimensions: &[Dimension], range| {
            let given = table.get(key);
            let value = given.map(|given| resolver.within(&given, dimensions, range));
            value.transpose()
        };
        mapping.resolution = within("resolution", &LENGTHS, &RESOLUTIONS)?.or(mapping.resolution);
        mapping.force_limit =
            within("force_limit", &FORCES, &FORCE_LIMITS)?.or(mapping.force_limit);
        axis.conditioning.resolution = mapping.resolution;
        if let Some(given) = table.get("gear_ratio") {
            let ratio = given.as_number().filter(|x| GEAR_RATIOS.contains(&x.abs()));
            let ratio = ratio.ok_or_else(|| {
                given
                    .refused("turns of the motor for one of the joint, without quotes, such as 101")
            })?;
            geared(mapping, ratio).ok_or_else(|| {
                let found = "is given, and no column of the torque".into();
                given.refuse(
                    found,
                    "torque = { column = \"...\" } of the motor beside it",
                )
            })?;
        }
        axis.tied.extend(resolver.tied.into_inner());
        Ok(axis)
    }
}

/// Makes the torque of a motor that of the joint; `None` where no column has it.
fn geared(mapping: &mut Mapping, ratio: f64) -> Option<()> {
    let force = mapping.force.as_mut()?;
    let scale = force.scale.take().unwrap_or(Value {
        number: 1.0,
        unit: Unit::si(Dimension::ONE),
    });
    force.scale = Some(Value {
        number: ratio * scale.number,
        ..scale
    });
    Some(())
}
