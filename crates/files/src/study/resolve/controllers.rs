//! `[[controller]]`

use super::dimensions::Dimensions;
use super::entry::{below_half_the_rate, name};
use crate::config::Table;
use crate::error::Error;
use crate::study::plan::{Machine, Named};
use stiction_formats::Dimension;
use stiction_servo::cascade::Cascade;
use stiction_servo::controller::Controller;
use stiction_servo::fuzzy::FuzzyPid;
use stiction_servo::pid::Pid;

pub(super) fn controller(
    table: &Table<'_>,
    machine: &Machine,
    two_axes: bool,
) -> Result<Named<Controller>, Error> {
    let is = Dimensions::of(machine.motion);
    let kind = table.choice("kind", &["cascade", "pid", "fuzzy-pid"])?;
    let kind = table.required("kind", kind, "\"cascade\", \"pid\" or \"fuzzy-pid\"")?;
    let bandwidth = below_half_the_rate(table, "bandwidth", machine.rate)?;
    let other = below_half_the_rate(table, "second_bandwidth", machine.rate)?;
    if other.is_some() && !two_axes {
        let allowed = "give a table [second_axis], or leave it out";
        let found = "is for a second axis, and there is none".into();
        return Err(table.refuse("second_bandwidth", found, allowed));
    }
    let peak = machine.drive.peak_force();
    let limit = table.positive("force_limit", is.force)?;
    let limit = limit.or_else(|| Some(peak).filter(|f| f.is_finite()));
    let limit = table.required(
        "force_limit",
        limit,
        "the largest force, here or as peak_force of the axis",
    )?;
    let mass = machine.mass;
    let friction = machine.law.curve().largest_static_level();
    let asked = Asked { table, is, limit };
    let made = match (kind, bandwidth) {
        ("cascade", Some(f)) => Cascade::tuned(mass, f, limit).map(Controller::Cascade),
        ("pid", Some(f)) => Pid::tuned(mass, f, limit).map(Controller::Pid),
        ("cascade", None) => Ok(Controller::Cascade(asked.cascade()?)),
        ("pid", None) => Ok(Controller::Pid(asked.pid()?)),
        (_, Some(f)) => FuzzyPid::tuned(mass, f, limit, friction).map(Controller::Fuzzy),
        (_, None) => {
            let found = "is missing".into();
            return Err(table.refuse("bandwidth", found, "give one such as \"60 Hz\""));
        }
    };
    let made = made
        .and_then(|c| c.validate().map(|()| c))
        .map_err(|e| table.together(&e))?;
    let share = table.number("mass_feedforward", 0.0, 1.0)?.unwrap_or(1.0);
    let default = match bandwidth {
        Some(f) => format!("{kind} {f} Hz"),
        None => kind.to_string(),
    };
    let named = Named {
        name: name(table, default)?,
        value: made.with_mass_feedforward(share * mass),
    };
    table.end()?;
    Ok(named)
}

/// The same kind of controller for a second axis, tuned for its mass.
pub(super) fn second(table: &Table<'_>, machine: &Machine) -> Result<Controller, Error> {
    let own = below_half_the_rate(table, "second_bandwidth", machine.rate)?;
    let bandwidth = own.or(below_half_the_rate(table, "bandwidth", machine.rate)?);
    let example = "one such as \"60 Hz\": gains are for one axis";
    let bandwidth = table.required("bandwidth", bandwidth, example)?;
    let peak = Some(machine.drive.peak_force()).filter(|f| f.is_finite());
    let limit = table.positive("force_limit", Dimensions::of(machine.motion).force)?;
    let limit = table.required(
        "force_limit",
        limit.or(peak),
        "the largest force, here or as peak_force of the second axis",
    )?;
    let mass = machine.mass;
    let friction = machine.law.curve().largest_static_level();
    let made = match table.text("kind")? {
        Some("pid") => Pid::tuned(mass, bandwidth, limit).map(Controller::Pid),
        Some("fuzzy-pid") => {
            FuzzyPid::tuned(mass, bandwidth, limit, friction).map(Controller::Fuzzy)
        }
        _ => Cascade::tuned(mass, bandwidth, limit).map(Controller::Cascade),
    };
    let share = table.number("mass_feedforward", 0.0, 1.0)?.unwrap_or(1.0);
    let made = made.map_err(|e| table.together(&e))?;
    Ok(made.with_mass_feedforward(share * mass))
}

/// Gains as they stand in the file.
struct Asked<'t, 'a> {
    table: &'t Table<'a>,
    is: Dimensions,
    limit: f64,
}

impl Asked<'_, '_> {
    fn gain(&self, key: &'static str, dimension: Dimension) -> Result<f64, Error> {
        let gain = self.table.not_negative(key, dimension)?;
        let example = format!(
            "a gain in {}, or bandwidth instead of all gains",
            dimension.si_text()
        );
        self.table.required(key, gain, &example)
    }

    fn cascade(&self) -> Result<Cascade, Error> {
        let stiffness = Dimensions::per(self.is.force, self.is.length);
        Ok(Cascade {
            position_gain: self.gain("position_gain", Dimension::FREQUENCY)?,
            speed_gain: self.gain("speed_gain", Dimensions::per(self.is.force, self.is.speed))?,
            integral_gain: self.gain("integral_gain", stiffness)?,
            mass_feedforward: 0.0,
            force_limit: self.limit,
        })
    }

    fn pid(&self) -> Result<Pid, Error> {
        let stiffness = Dimensions::per(self.is.force, self.is.length);
        Ok(Pid {
            proportional: self.gain("proportional", stiffness)?,
            integral: self.gain("integral", Dimensions::per(stiffness, Dimension::TIME))?,
            derivative: self.gain("derivative", Dimensions::per(self.is.force, self.is.speed))?,
            filter: self
                .table
                .not_negative("filter", Dimension::TIME)?
                .unwrap_or(0.0),
            mass_feedforward: 0.0,
            force_limit: self.limit,
        })
    }
}
