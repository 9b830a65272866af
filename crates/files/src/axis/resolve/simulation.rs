//! `[simulation]` and `[controller]`: what `--method output-error` needs to know.

use super::resolver::Resolver;
use crate::axis::gain::{ControllerValues, Gain};
use crate::axis::values::Axis;
use crate::config::{Given, Table};
use crate::error::Error;
use stiction_formats::Dimension;
use stiction_identify::Hold;
use stiction_log::mapping::SCALES;

impl Resolver {
    pub(super) fn simulation(&self, root: &Table<'_>, axis: &mut Axis) -> Result<(), Error> {
        let Some(table) = root.table("simulation")? else {
            return Ok(());
        };
        axis.hold = match table.choice("force", &["held", "centred"])? {
            Some("centred") => Hold::Centred,
            _ => Hold::Held,
        };
        if let Some(given) = table.get("segment")
            && let (given, None) = given.or_word(&["whole"])
        {
            axis.segment = Some(self.above_zero(&given, &[Dimension::TIME])?);
        }
        table.end()
    }

    pub(super) fn controller(&self, root: &Table<'_>, axis: &mut Axis) -> Result<(), Error> {
        let Some(table) = root.table("controller")? else {
            return Ok(());
        };
        if let Some(given) = table.get("bandwidth") {
            axis.bandwidth = Some(given.positive(&[Dimension::FREQUENCY])?.0);
            if table.find("kind").is_some() {
                let allowed = "either bandwidth, for a controller whose gains are not known, or kind with its gains";
                return Err(given.refused(allowed));
            }
            return table.end();
        }
        let integral = match (kind(&table)?, table.get("integral_gain")) {
            ("p-p", None) => None,
            ("p-p", Some(given)) => {
                let allowed = "p-p has none; kind = \"p-pi\" has one";
                return Err(given.refused(allowed));
            }
            (_, Some(given)) => Some(gain(&given)?),
            (_, None) => {
                let allowed = "p-pi needs integral_gain, such as \"2e5 N/m\"";
                return Err(table.refuse("kind", "\"p-pi\"".into(), allowed));
            }
        };
        let required = |key, example| table.required(key, table.get(key), example);
        let optional = |key| table.get(key).map(|given| gain(&given)).transpose();
        let position = required("position_gain", "one such as \"40 1/s\"")?;
        axis.controller = Some(ControllerValues {
            position_gain: self.above_zero(&position, &[Dimension::FREQUENCY])?,
            speed_gain: gain(&required("speed_gain", "one such as \"300 N s/m\"")?)?,
            integral_gain: integral,
            velocity_feedforward: table
                .number("velocity_feedforward", 0.0, 1.0)?
                .unwrap_or(0.0),
            mass_feedforward: optional("mass_feedforward")?,
            force_limit: optional("force_limit")?,
            rate: self.positive(table.get("rate"), &[Dimension::FREQUENCY])?,
        });
        table.end()
    }
}

fn kind<'a>(table: &Table<'a>) -> Result<&'a str, Error> {
    let kinds = "p-p (P position, P speed) or p-pi (P position, PI speed)";
    let given = table.required("kind", table.get("kind"), kinds)?;
    match given.as_text() {
        Some(kind @ ("p-p" | "p-pi")) => Ok(kind),
        _ => Err(given.refused(kinds)),
    }
}

/// A value above 0 whose unit is checked with the log.
pub(super) fn gain(given: &Given<'_>) -> Result<Gain, Error> {
    let value = given.quantity("\"300 N s/m\"")?;
    if value.number <= 0.0 {
        return Err(given.refused("a finite value above 0"));
    }
    if !SCALES.contains(&value.si()) {
        let (low, high) = (SCALES.start(), SCALES.end());
        return Err(given.refused(&format!("from {low:e} to {high:e} in SI units")));
    }
    Ok(Gain {
        place: given.place(),
        value,
    })
}
