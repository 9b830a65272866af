//! The force of a motor from its current, voltage or duty.

use super::Log;
use crate::mapping::{Drive, Gain, Motion};
use crate::{Dimension, Error, Kind};

/// Refuses a drive that does not go with the axis or its settings.
pub(super) fn check(drive: &Drive, motion: Motion, force_limit: Option<f64>) -> Result<(), Error> {
    if drive.motion != motion {
        let found = format!(
            "force_constant is in {}/A, and the axis is {motion}",
            drive.motion.force().si_text()
        );
        let allowed = format!("a {motion} axis takes {}/A", motion.force().si_text());
        return Err(Error::new(Kind::Unit, found, allowed).of_setting("drive.force_constant"));
    }
    if force_limit.is_some() {
        let found = "force_limit stands beside [drive]";
        let allowed = "leave it out: where the current or voltage saturates is found in the data";
        return Err(Error::new(Kind::Value, found, allowed).of_setting("log.force_limit"));
    }
    Ok(())
}

/// Makes a force of what the column holds. Comes after the log is inspected: a voltage saturates and has steps, the force that it
/// makes of a moving axis does not show them.
pub(super) fn drive(log: &mut Log, drive: &Drive, column: Dimension) -> Result<(), Error> {
    let Gain { constant, damping } = drive.gain(column)?;
    let velocity = (damping != 0.0).then(|| velocity(log));
    let Some(force) = &mut log.force else {
        return Ok(());
    };
    for (i, force) in force.iter_mut().enumerate() {
        let braked = velocity.as_ref().map_or(0.0, |v| damping * v[i]);
        *force = constant * *force - braked;
    }
    log.force_unit = drive.motion.force().si_text();
    log.detected.push(drive.words(column));
    Ok(())
}

/// As recorded, and else by central differences within each stretch: filters pass both alike.
fn velocity(log: &Log) -> Vec<f64> {
    if let Some(velocity) = &log.velocity {
        return velocity.clone();
    }
    let mut out = vec![0.0; log.time.len()];
    let Some(position) = &log.position else {
        return out;
    };
    for stretch in &log.segments {
        let (first, last) = (stretch.start, stretch.end.saturating_sub(1));
        for i in stretch.clone() {
            let (a, b) = (i.saturating_sub(1).max(first), (i + 1).min(last));
            if b > a {
                out[i] = (position[b] - position[a]) / (log.time[b] - log.time[a]);
            }
        }
    }
    out
}
