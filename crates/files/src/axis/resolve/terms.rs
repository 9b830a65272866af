//! `mass` and `[terms]`: what is fitted beside the friction law.

use super::resolver::{LENGTHS, Resolver};
use crate::axis::values::Axis;
use crate::config::{Given, Table};
use crate::error::Error;
use stiction_formats::Dimension;
use stiction_identify::{Delay, Dependence, GMS_FEWEST, GMS_MOST, Map, Mass, Transmitted};
use stiction_log::mapping::WRAPS;
use stiction_parameters::Quantity;

/// Two pitches that differ by less, dimensionless, are one that is written in two units.
const SAME_PITCH_WITHIN: f64 = 1e-9;
/// Most pitches of cogging, and of friction along the axis.
pub const MOST_PITCHES: usize = 4;

impl Resolver {
    pub(super) fn terms(&self, root: &Table<'_>, axis: &mut Axis) -> Result<(), Error> {
        if let Some(given) = root.get("mass") {
            axis.terms.mass = match given.or_word(&["fit", "none"]) {
                (_, Some("fit")) => Mass::Fitted,
                (_, Some(_)) => Mass::Absent,
                (given, None) => {
                    let allowed = [Dimension::MASS, Dimension::INERTIA];
                    Mass::Given(self.above_zero(&given, &allowed)?)
                }
            };
        } else {
            axis.terms.mass = Mass::Fitted;
        }
        axis.terms.delay = Delay::Fitted;
        // A servo moves a link, which has a weight.
        let drive = axis.mapping.drive;
        axis.terms.gravity = drive.is_some_and(|drive| drive.position_loop.is_some());
        axis.gravity_is_stated = axis.terms.gravity;
        let Some(table) = root.table("terms")? else {
            return Ok(());
        };
        let gravity = table.flag("gravity")?;
        axis.gravity_is_stated |= gravity.is_some();
        axis.terms.gravity = gravity.unwrap_or(axis.terms.gravity);
        axis.offset = table.flag("offset")?;
        axis.terms.cogging = self.pitches(table.get("cogging"))?;
        axis.terms.quadratic_viscous = table.flag("quadratic_viscous")?.unwrap_or(false);
        axis.terms.dependences = self.dependences(&table)?;
        if let Some(given) = table.get("delay") {
            axis.terms.delay = delay(given)?;
        }
        if let Some(given) = table.get("stribeck_exponent") {
            let allowed = Quantity::StribeckExponent.allowed();
            match (given.as_text(), given.as_number()) {
                (Some("fit"), _) => axis.exponent_fitted = true,
                (_, Some(exponent)) if allowed.admits(exponent) => {
                    axis.stribeck_exponent = Some(exponent);
                }
                _ => {
                    let allowed = format!("a number {}, or \"fit\"", allowed.words());
                    return Err(given.refused(&allowed));
                }
            }
        }
        let elements = table.count("gms_elements", GMS_FEWEST as u64, GMS_MOST as u64)?;
        axis.gms_elements = elements.map(|n| n as usize);
        table.end()
    }

    /// The quantities that friction depends on; their reference values and the number of logs come from the logs.
    fn dependences(&self, table: &Table<'_>) -> Result<Vec<Dependence>, Error> {
        let mut out = Vec::new();
        let pitches = self.pitches(table.get("coulomb_pitch"))?;
        for (key, dependence) in [
            ("coulomb_load", Dependence::CoulombLoad(0.0)),
            ("coulomb_temperature", Dependence::CoulombTemperature(0.0)),
            ("coulomb_position", Dependence::CoulombPosition(0.0)),
            (
                "coulomb_transmitted",
                Dependence::CoulombTransmitted(Transmitted::default()),
            ),
            (
                "coulomb_driven",
                Dependence::CoulombDriven(Transmitted::default()),
            ),
            ("sigma2_temperature", Dependence::ViscousTemperature(0.0)),
            ("coulomb_log", Dependence::CoulombLog(0)),
            ("sigma2_log", Dependence::ViscousLog(0)),
        ] {
            let Some(given) = table.get(key) else {
                continue;
            };
            match dependence {
                Dependence::CoulombPosition(_) => {
                    out.extend(along_the_stroke(given, pitches.len())?);
                }
                other => out.extend(given.flag()?.then_some(other)),
            }
        }
        out.extend(pitches.into_iter().map(Dependence::CoulombPitch));
        Ok(out)
    }

    fn pitches(&self, given: Option<Given<'_>>) -> Result<Vec<f64>, Error> {
        let Some(given) = given else {
            return Ok(Vec::new());
        };
        let Some(list) = given.as_list() else {
            return Err(given.refused("a list of lengths, such as [\"24 mm\"]"));
        };
        if list.len() > MOST_PITCHES {
            let found = format!("{} pitches", list.len());
            return Err(given.refuse(found, &format!("at most {MOST_PITCHES}")));
        }
        let mut pitches: Vec<f64> = Vec::new();
        for pitch in &list {
            let length = self.within(pitch, &LENGTHS, &WRAPS)?;
            let same = |other: &f64| (length - other).abs() <= SAME_PITCH_WITHIN * length.abs();
            if pitches.iter().any(same) {
                let found = format!("{} twice", pitch.shown());
                return Err(pitch.refuse(
                    found,
                    "each pitch once: two waves of one pitch cannot be told apart",
                ));
            }
            pitches.push(length);
        }
        Ok(pitches)
    }
}

/// A straight line, or a map; a compensator has room for so many waves and no more.
fn along_the_stroke(given: Given<'_>, pitches: usize) -> Result<Option<Dependence>, Error> {
    let line = Dependence::CoulombPosition(0.0);
    let most = Map::MOST - pitches;
    let map = Map {
        terms: most,
        most,
        ..Map::default()
    };
    match given.or_word(&["map"]) {
        (_, Some(_)) => Ok(Some(Dependence::CoulombMap(map))),
        (given, None) => Ok(given.flag()?.then_some(line)),
    }
}

/// A time of either sign.
fn delay(given: Given<'_>) -> Result<Delay, Error> {
    let given = match given.or_word(&["fit", "none"]) {
        (_, Some("fit")) => return Ok(Delay::Fitted),
        (_, Some(_)) => return Ok(Delay::NONE),
        (given, None) => given,
    };
    let (time, _) = given.value(&[Dimension::TIME])?;
    let allowed = Quantity::Delay.allowed();
    if allowed.admits(time) {
        return Ok(Delay::Given(time));
    }
    Err(given.refused(&format!("a time {}", allowed.words())))
}
