//! Dynamics between the logged force and the motion, in words.

use stiction_identify::Dynamics;
use stiction_log::Log;
use stiction_number::four_digits;

/// What was found, of which `left` is what the law leaves by it, and what to do; `options` are those of the next command.
pub(super) fn message(
    found: &Dynamics,
    (what, left): (&str, &str),
    log: &Log,
    options: &str,
) -> String {
    let time = found.square.abs().sqrt();
    let duration = format!("{} ms", four_digits(1e3 * time));
    // The variance of a mean over n rows is (n^2 - 1)/12 of the sample time squared.
    let rows = (1.0 + 12.0 * found.square.abs() * log.rate_hz * log.rate_hz).sqrt();
    let alike = match found.square < 0.0 {
        true => format!(
            "a force that was logged behind a low-pass of some {duration} or as a mean over some {rows:.0} rows leaves the same, and \
             so does a motor ahead of the encoder on its load"
        ),
        false => format!(
            "a drive whose current loop takes some {duration} to give the logged force leaves the same, and so does a load on a \
             spring behind the encoder of its motor"
        ),
    };
    format!(
        "{what}: {left} goes with the second derivative of the force; {alike}. Coulomb friction, viscous friction and the mass \
         hold; presliding, the Stribeck curve and the delay take up part of it. \
         Log force and motion unfiltered, from the same loop of the drive, then: stiction identify another.csv{options} --out another"
    )
}
