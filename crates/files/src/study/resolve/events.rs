//! `[[event]]`: what changes on the axis while it runs.

use super::MOST_ENTRIES;
use super::dimensions::Dimensions;
use super::machine::plant_steps;
use crate::config::Table;
use crate::config::machine::MASSES;
use crate::error::{Error, Warning};
use crate::study::plan::{Event, Scheme, Study};
use stiction_codes::Code;
use stiction_formats::Dimension;
use stiction_number::four_digits as short;

/// Range of the factor on friction, dimensionless: what a compensator's level can follow is up to 2.
const FRICTION: [f64; 2] = [0.01, 100.0];

/// The events of a study with all its paths. The plant is stepped as often as the stiffest state of the axis needs.
pub(super) fn events(root: &Table<'_>, study: &mut Study) -> Result<(), Error> {
    let is = Dimensions::of(study.machine.motion);
    let durations = study.paths.iter().map(|p| p.trajectory.duration());
    let longest = durations.fold(0.0, f64::max);
    let (mut mass, mut level) = (study.machine.mass, 1.0);
    for table in root.tables("event", MOST_ENTRIES)? {
        if !study.contours.is_empty() {
            let allowed = "paths alone: an event is of one axis";
            return Err(table.refuse("time", "stands beside a contour".into(), allowed));
        }
        let time = table.not_negative("time", Dimension::TIME)?;
        let time = table.required("time", time, "a time such as \"2 s\"")?;
        if study
            .events
            .last()
            .is_some_and(|before| time <= before.time)
        {
            return Err(table.refused("time", "later than the event before"));
        }
        if time >= longest {
            let allowed = format!("before the end of the longest path, {} s", short(longest));
            return Err(table.refused("time", &allowed));
        }
        let over = study
            .paths
            .iter()
            .filter(|p| p.trajectory.duration() < time);
        let over: Vec<&str> = over.map(|p| p.name.as_str()).collect();
        if !over.is_empty() {
            let message = format!(
                "the event at {} s comes after the end of {}: nothing changes there",
                short(time),
                over.join(", ")
            );
            study.warnings.push(Warning::new(Code::LateEvent, message));
        }
        let event = Event {
            time,
            mass: table.among("mass", is.mass, &MASSES)?,
            friction: table.number("friction", FRICTION[0], FRICTION[1])?,
        };
        if event.mass.is_none() && event.friction.is_none() {
            let allowed =
                "give a mass such as \"6.9 kg\", or friction = 1.3 for a factor on friction";
            return Err(table.refuse("mass", "is missing".into(), allowed));
        }
        table.end()?;
        mass = event.mass.unwrap_or(mass);
        level = event.friction.unwrap_or(level);
        let machine = &mut study.machine;
        let stiffness = level * machine.law.stiffness() + machine.spring;
        let (substeps, warning) = plant_steps(stiffness / mass, machine.rate);
        machine.substeps = machine.substeps.max(substeps);
        machine.model.warnings.extend(warning);
        study.events.push(event);
    }
    Ok(())
}

/// Warns of load estimates that a contour does not have.
pub(super) fn of_one_axis(study: &mut Study) {
    let contours: Vec<&str> = study.contours.iter().map(|c| c.name.as_str()).collect();
    if contours.is_empty() {
        return;
    }
    let schemes = study.compensators.iter();
    let estimates =
        schemes.filter(|c| matches!(&c.value, Scheme::Model(model) if model.load_estimate));
    let said = estimates.map(|c| {
        let message = format!(
            "{} is not run on {}: a load estimate is of one axis, on paths",
            c.name,
            contours.join(", ")
        );
        Warning::new(Code::NotRun, message)
    });
    let said: Vec<Warning> = said.collect();
    study.warnings.extend(said);
}
