//! What leads on where too few samples are left, or none moves.

use super::{Asked, Method};
use crate::error::Error;
use stiction_files::result::Action;
use stiction_identify::{Error as Fit, LawKind, Losses};
use stiction_log::Motion;
use stiction_number::short;
use stiction_policy::conditioning;

/// The same error with what leads on: a line of the axis file that leaves more samples, a line to leave out of it, or a simulation, which
/// filters nothing.
pub(super) fn led_on(mut error: Error, asked: Asked, motion: Motion) -> Error {
    let (axis, options) = (asked.axis, asked.options);
    let left_out = |line: &str| Action::Remove {
        table: "[log]".into(),
        line: line.into(),
    };
    let Error::Identify { source, action, .. } = &mut error else {
        return error;
    };
    match source {
        Fit::TooFewSamples { losses, needed, .. } => {
            let is_simulated = matches!(options.procedures.method, Method::Separable)
                && axis.has_inertia()
                && options.law != Some(LawKind::ElastoPlastic);
            if let Some(line) = lowered(losses, *needed, axis.conditioning.decimate, motion) {
                **action = Action::Line {
                    table: "conditioning".into(),
                    line,
                    replaces: true,
                };
            } else if axis.mapping.force_limit.is_some()
                && losses.excluded * losses.decimate.max(1) > losses.logged / 2
            {
                **action = left_out("force_limit");
            } else if is_simulated
                && losses.left_to_simulate() >= conditioning::MIN_DECIMATED_SAMPLES.max(*needed)
            {
                **action = Action::Simulate;
            }
        }
        Fit::NoMotion { .. } if axis.mapping.resolution.is_some() => {
            **action = left_out("resolution");
        }
        _ => {}
    }
    error
}

/// The line in place of the one that leaves too few samples; none where another cause does. `decimate` is what the axis file gives.
fn lowered(
    losses: &Losses,
    needed: usize,
    decimate: Option<usize>,
    motion: Motion,
) -> Option<String> {
    let taken = losses.logged.saturating_sub(losses.short) / losses.decimate.max(1);
    if losses.slow > 0 && taken >= needed && losses.fastest_slow > 0.0 {
        let speed = conditioning::SPEED_LIMIT * losses.fastest_slow;
        // Two digits are enough of a limit.
        let speed: f64 = format!("{speed:.1e}").parse().ok()?;
        let unit = motion.velocity().si_text();
        return Some(format!("min_speed = \"{} {unit}\"", short(speed)));
    }
    let by = decimate.filter(|by| *by > 1)?;
    let is_too_short = losses.short == losses.logged;
    let is_too_thin = losses.decimate > 1 && losses.logged >= needed;
    let least = (losses.logged / conditioning::MIN_DECIMATED_SAMPLES).clamp(1, by / 2);
    ((is_too_short || is_too_thin) && losses.logged >= conditioning::MIN_DECIMATED_SAMPLES)
        .then(|| format!("decimate = {least}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_key_that_leaves_nothing_is_named_with_a_value_that_leaves_something() {
        let slow = Losses {
            logged: 9001,
            decimate: 8,
            slow: 1110,
            fastest_slow: 0.1963,
            ..Losses::default()
        };
        let line = |losses, decimate| lowered(losses, 40, decimate, Motion::Linear);
        assert_eq!(line(&slow, None).unwrap(), "min_speed = \"0.02 m/s\"");
        let short = Losses {
            logged: 9001,
            short: 9001,
            ..Losses::default()
        };
        assert_eq!(line(&short, Some(10_000)).unwrap(), "decimate = 30");
        assert_eq!(line(&short, None), None);
        let of_few = Losses {
            logged: 30,
            ..Losses::default()
        };
        assert_eq!(line(&of_few, Some(2)), None);
    }
}
