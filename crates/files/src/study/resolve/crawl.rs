//! `kind = "crawl"`: very low constant velocities, each a motion from rest to rest.

use super::dimensions::Dimensions;
use super::entry::MOST_SAMPLES;
use crate::config::Table;
use crate::error::Error;
use crate::study::plan::Machine;
use stiction_formats::Dimension;
use stiction_log::Motion;
use stiction_servo::motion::{Limits, Move, Moves};

/// Most velocities of an entry.
const MOST_VELOCITIES: usize = 16;
/// Time in which the velocity is reached, s; half of it with rising acceleration.
const RAMP: f64 = 0.1;
/// Least time at velocity, s, where it is not given ...
const LEAST_HOLD: f64 = 2.0;
/// ... and the way in presliding lengths: the axis breaks away after the first, and from the middle on it is measured.
const PRESLIDING_LENGTHS: f64 = 6.0;

/// Each velocity as it was typed, and its motion.
pub(super) fn motions(table: &Table<'_>, machine: &Machine) -> Result<Vec<(String, Moves)>, Error> {
    let hold = table.positive("hold", Dimension::TIME)?;
    let velocities = velocities(table, machine.motion)?.into_iter();
    let motions = velocities.map(|(text, velocity)| {
        let hold = hold.unwrap_or_else(|| usual_hold(machine, velocity));
        let limits = Limits {
            velocity,
            acceleration: velocity / (0.5 * RAMP),
            jerk: velocity / (0.25 * RAMP * RAMP),
        };
        let distance = velocity * (hold + RAMP);
        let made = Moves::new(
            &[Move {
                distance,
                dwell: 0.0,
            }],
            limits,
        );
        Ok((text, made.map_err(|e| table.together(&e))?))
    });
    motions.collect()
}

fn velocities(table: &Table<'_>, motion: Motion) -> Result<Vec<(String, f64)>, Error> {
    let is = Dimensions::of(motion);
    let Some(given) = table.get("velocities") else {
        let usual = match motion {
            Motion::Linear => [("1 um/s", 1e-6), ("10 um/s", 1e-5), ("100 um/s", 1e-4)],
            Motion::Rotary => [
                ("0.1 mrad/s", 1e-4),
                ("1 mrad/s", 1e-3),
                ("10 mrad/s", 1e-2),
            ],
        };
        return Ok(usual.map(|(text, v)| (text.to_string(), v)).to_vec());
    };
    let list = given.as_list();
    let list = list.filter(|list| (1..=MOST_VELOCITIES).contains(&list.len()));
    let list = list.ok_or_else(|| {
        given.refused(&format!(
            "1 to {MOST_VELOCITIES} velocities in brackets, such as [\"1 um/s\", \"10 um/s\"]"
        ))
    })?;
    let mut velocities: Vec<(String, f64)> = Vec::new();
    for given in &list {
        let (velocity, _) = given.positive(&[is.speed])?;
        if velocities.iter().any(|(_, other)| *other == velocity) {
            return Err(given.refuse(format!("{} twice", given.shown()), "each velocity once"));
        }
        velocities.push((given.text()?.trim().to_string(), velocity));
    }
    Ok(velocities)
}

/// Long enough to break away and go on, as far as a run may have samples.
fn usual_hold(machine: &Machine, velocity: f64) -> f64 {
    let length = machine.law.presliding();
    let longest = (MOST_SAMPLES - 1) as f64 / machine.rate - 2.0 * RAMP;
    (PRESLIDING_LENGTHS * length / velocity)
        .max(LEAST_HOLD)
        .min(longest)
}
