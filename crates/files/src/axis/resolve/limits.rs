//! `[limits]`: what the axis may do.

use crate::axis::limits::AxisLimits;
use crate::config::machine::{ACCELERATIONS, FORCES, JERKS, MASSES, SPEEDS, STROKES};
use crate::config::{Given, Table};
use crate::error::Error;
use stiction_formats::Dimension;
use stiction_log::Motion;

/// The keys of `[limits]`.
const KEYS: [&str; 9] = [
    "stroke",
    "end_zone",
    "speed",
    "acceleration",
    "jerk",
    "rated_force",
    "peak_force",
    "mass",
    "force_noise",
];

/// Largest part of the stroke that may be left free at either end.
const LARGEST_ZONE: f64 = 0.45;

pub(super) fn limits(root: &Table<'_>, kind: Option<Motion>) -> Result<Option<AxisLimits>, Error> {
    let Some(table) = root.table("limits")? else {
        return Ok(None);
    };
    let stroke = table.get("stroke");
    let motion = match (kind, &stroke) {
        (Some(motion), _) => motion,
        (None, Some(given)) => motion_of(given)?,
        (None, None) => {
            let found = "is missing, and so is kind";
            let allowed = "give stroke or kind, which say whether the axis is linear or rotary";
            let missing = table.refuse("stroke", found.into(), allowed);
            // A name that is misspelt may be what is missing.
            KEYS.iter().for_each(|key| drop(table.get(key)));
            let mut refused = table.strangers();
            refused.push(missing);
            return Err(Error::of_all(refused).expect("the stroke is missing"));
        }
    };
    let mass = match motion {
        Motion::Linear => Dimension::MASS,
        Motion::Rotary => Dimension::INERTIA,
    };
    let per_time = |dimension: Dimension| dimension.per(Dimension::TIME).unwrap_or(dimension);
    let acceleration = per_time(motion.velocity());
    let limits = AxisLimits {
        motion,
        stroke: stroke.map(|given| ends(&given, motion)).transpose()?,
        end_zone: table
            .get("end_zone")
            .map(|given| zone(&given))
            .transpose()?,
        speed: table.among("speed", motion.velocity(), &SPEEDS)?,
        acceleration: table.among("acceleration", acceleration, &ACCELERATIONS)?,
        jerk: table.among("jerk", per_time(acceleration), &JERKS)?,
        rated_force: table.among("rated_force", motion.force(), &FORCES)?,
        peak_force: table.among("peak_force", motion.force(), &FORCES)?,
        mass: table.among("mass", mass, &MASSES)?,
        force_noise: table.among("force_noise", motion.force(), &FORCES)?,
    };
    if let (Some(rated), Some(peak)) = (limits.rated_force, limits.peak_force)
        && peak < rated
    {
        return Err(table.refused("peak_force", "at least rated_force"));
    }
    table.end()?;
    Ok(Some(limits))
}

const STROKE: &str = "how far the axis may go from where it stands, to negative and to positive positions, such as \
                      [\"-100 mm\", \"100 mm\"]: the negative one first, at most 0, then the positive one, at least 0, \
                      not both 0";

/// Linear or rotary, by the unit of an end.
fn motion_of(given: &Given<'_>) -> Result<Motion, Error> {
    let ends = given.as_list().unwrap_or_default();
    let first = ends.first().ok_or_else(|| given.refused(STROKE))?;
    let (_, dimension) = first.value(&[Dimension::LENGTH, Dimension::ANGLE])?;
    Ok(match dimension == Dimension::ANGLE {
        true => Motion::Rotary,
        false => Motion::Linear,
    })
}

fn ends(given: &Given<'_>, motion: Motion) -> Result<[f64; 2], Error> {
    let list = given.as_list().unwrap_or_default();
    let [low, high] = list.as_slice() else {
        return Err(given.refused(STROKE));
    };
    let end = |given: &Given<'_>| {
        let x = given.signed(motion.position())?;
        if STROKES.contains(&x) {
            return Ok(x);
        }
        let (least, most) = (STROKES.start(), STROKES.end());
        let unit = motion.position().si_text();
        Err(given.refused(&format!("from {least:e} to {most:e} {unit}")))
    };
    let ends = [end(low)?, end(high)?];
    if ends[0] > 0.0 || ends[1] < 0.0 || ends[0] == ends[1] {
        return Err(given.refused(STROKE));
    }
    Ok(ends)
}

/// A part of the stroke: a plain number or a percentage.
fn zone(given: &Given<'_>) -> Result<f64, Error> {
    let allowed = "a part of the stroke from 0 to 0.45, such as 0.05 or \"5 %\"";
    let part = match given.as_number() {
        Some(number) => number,
        None => given.value(&[Dimension::ONE])?.0,
    };
    match (0.0..=LARGEST_ZONE).contains(&part) {
        true => Ok(part),
        false => Err(given.refused(allowed)),
    }
}
