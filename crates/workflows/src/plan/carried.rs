//! The set points in the forms that were asked for.

use super::PlanOptions;
use super::assume::Given;
use super::judged::refused;
use super::outcome::Planned;
use crate::error::Error;
use crate::wording::Setting;
use stiction_formats::{Dimension, Value};
use stiction_log::Motion;
use stiction_plan::carrier::{Carried, Carrier, Job};
use stiction_plan::{HandMade, Motion as Path, hand_made};

/// Least spacing of positions, m (rad), that a set point has to have: that of the finest encoders.
const FINEST: f64 = 1e-12;

/// Where the axis stands when the motion starts, m (rad).
pub(super) fn start(motion: Motion, options: &PlanOptions) -> Result<f64, Error> {
    let Some(text) = &options.start else {
        return Ok(0.0);
    };
    let (wanted, example) = match motion {
        Motion::Linear => (Dimension::LENGTH, "120 mm"),
        Motion::Rotary => (Dimension::ANGLE, "30 deg"),
    };
    let value = Value::parse(text).and_then(|value| value.si_of(wanted));
    let refused = |why: &str| {
        let allowed = format!("the position at which the axis stands, such as {example}: {why}");
        Error::usage(Setting::Start.is(text), allowed)
    };
    let value = value.map_err(|e| refused(&e.to_string()))?;
    // Beside it small motions would be rounded away.
    let farthest = FINEST / f64::EPSILON;
    if value.abs() > farthest {
        let unit = motion.position().si_text();
        return Err(refused(&format!(
            "at most {farthest:.0} {unit} from zero, so that set points tell a motion"
        )));
    }
    Ok(value)
}

/// One full stroke in the forms that are wanted: what a form cannot hold is refused before anything is designed.
pub(super) fn tried(given: &Given, options: &PlanOptions, start: f64) -> Result<(), Error> {
    let (limits, rig) = (&given.nameplate.limits, &given.nameplate.rig);
    let strokes =
        hand_made(HandMade::Trapezoid, limits, rig, options.longest()).map_err(refused)?;
    let Some(stroke) = strokes.and_then(|strokes| strokes.atoms().first().copied()) else {
        return Ok(());
    };
    let stroke = Path::new(vec![stroke]).map_err(refused)?;
    forms(&stroke, None, given, options, start).map(|_| ())
}

/// The plan with its set points; forms that are named twice are written once.
pub(super) fn carried(mut planned: Planned, start: f64) -> Result<Planned, Error> {
    let title = planned.file.name.as_deref();
    planned.carried = forms(
        &planned.motion,
        title,
        &planned.given,
        &planned.options,
        start,
    )?;
    Ok(planned)
}

/// The set points, then each form that was asked for.
fn forms(
    motion: &Path,
    title: Option<&str>,
    given: &Given,
    options: &PlanOptions,
    start: f64,
) -> Result<Vec<Carried>, Error> {
    let job = Job {
        motion,
        identifier: &stiction_export::identifier(title.unwrap_or("axis")),
        rotary: given.motion == Motion::Rotary,
        rate: given.logged.rate,
        resolution: given.logged.encoder_step,
        start,
    };
    Carrier::ALL
        .into_iter()
        .filter(|form| *form == Carrier::Csv || options.carriers.contains(form))
        .map(|form| form.carry(&job))
        .collect::<Result<_, _>>()
        .map_err(|e| Error::usage(e.found, e.allowed))
}
