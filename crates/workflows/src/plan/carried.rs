//! The set points in the forms that were asked for.

use super::PlanOptions;
use super::assume::Given;
use super::outcome::Planned;
use crate::error::Error;
use stiction_log::{Dimension, Motion, Value};
use stiction_plan::carrier::{Carrier, Job};

/// Where the axis stands when the motion starts, m (rad).
pub(super) fn start(given: &Given, options: &PlanOptions) -> Result<f64, Error> {
    let Some(text) = &options.start else {
        return Ok(0.0);
    };
    let (wanted, example) = match given.motion {
        Motion::Linear => (Dimension::LENGTH, "120 mm"),
        Motion::Rotary => (Dimension::ANGLE, "30 deg"),
    };
    let value = Value::parse(text).and_then(|value| value.si_of(wanted));
    value.map_err(|e| {
        let allowed = format!("the position at which the axis stands, such as {example}: {e}");
        Error::usage(format!("--start {text:?}"), allowed)
    })
}

/// The plan with its set points; forms that are named twice are written once.
pub(super) fn carried(mut planned: Planned, start: f64) -> Result<Planned, Error> {
    let title = planned.file.name.as_deref().unwrap_or("axis");
    let job = Job {
        motion: &planned.motion,
        identifier: &stiction_export::identifier(title),
        rotary: planned.given.motion == Motion::Rotary,
        rate: planned.file.rig.rate,
        resolution: planned.file.rig.resolution,
        start,
    };
    let wanted = Carrier::ALL
        .into_iter()
        .filter(|form| *form == Carrier::Csv || planned.options.carriers.contains(form));
    let carried = wanted.map(|form| form.carry(&job));
    planned.carried = carried
        .collect::<Result<_, _>>()
        .map_err(|e| Error::usage(e.found, e.allowed))?;
    Ok(planned)
}
