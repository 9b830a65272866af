//! `disturbance`: a force on the axis over time, against the positive direction as in eq. (23) of Zhang et al. 2025.

use super::dimensions::Dimensions;
use super::file::{FORCE, points};
use crate::config::Table;
use crate::error::{Error, Warning};
use crate::study::result::StudyInput;
use std::f64::consts::PI;
use std::path::Path;
use stiction_formats::Dimension;
use stiction_number::shortest;
use stiction_servo::disturbance::{Disturbance, Recorded};

/// The disturbance of an axis whose plant is stepped at `rate`, Hz, as a force in the positive direction, and what is said of
/// its file, which is added to `inputs`.
pub(super) fn disturbance(
    axis: &Table<'_>,
    folder: &Path,
    is: &Dimensions,
    rate: f64,
    inputs: &mut Vec<StudyInput>,
) -> Result<(Option<Disturbance>, Option<Warning>), Error> {
    let Some(table) = axis.table("disturbance")? else {
        return Ok((None, None));
    };
    let words = ["constant", "sine", "file"];
    let kind = table.choice("kind", &words)?;
    let kind = table.required("kind", kind, "one of constant, sine, file")?;
    let mut said = None;
    let disturbance = match kind {
        "constant" => {
            let force = table.value("force", is.force)?;
            let force = table.required("force", force, "a force such as \"20 N\"")?;
            Disturbance::Constant(-force)
        }
        "sine" => {
            let amplitude = table.positive("amplitude", is.force)?;
            let frequency = table.positive("frequency", Dimension::FREQUENCY)?;
            if frequency.is_some_and(|f| f >= 0.5 * rate) {
                let half = shortest(0.5 * rate);
                let allowed =
                    format!("below half the rate at which the axis is stepped, {half} Hz");
                return Err(table.refused("frequency", &allowed));
            }
            let phase = table.value("phase", Dimension::ANGLE)?;
            Disturbance::Sine {
                amplitude: -table.required("amplitude", amplitude, "a force such as \"5 N\"")?,
                frequency: table.required("frequency", frequency, "one such as \"8 Hz\"")?,
                phase: phase.unwrap_or(0.0).rem_euclid(2.0 * PI),
            }
        }
        _ => {
            let points = points::<1>(&table, folder, is.force, &FORCE)?;
            said = points.warning;
            inputs.push(StudyInput {
                path: crate::shell::text(&points.file),
                sha256: points.sha256,
            });
            let [mut forces] = points.axes;
            forces.iter_mut().for_each(|force| *force = -*force);
            let begin = points.times[0];
            let times = points.times.iter().map(|t| t - begin).collect();
            let recorded = Recorded::new(times, forces);
            Disturbance::Recorded(recorded.map_err(|e| table.together(&e))?)
        }
    };
    table.end()?;
    Ok((Some(disturbance), said))
}
