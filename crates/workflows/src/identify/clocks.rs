//! Two clocks that run apart, in words.

use super::settled::SHORTEST;
use crate::source::Source;
use stiction_files::result::Cure;
use stiction_identify::Clocks;
use stiction_number::{four_digits, short};

/// Deviations of a 95 % interval.
const QUANTILE: f64 = 1.96;
/// Growth of the delay over a part of the log that hardly matters, samples.
const HARDLY: f64 = 1.0;

/// The part at the beginning of the log within which the delay hardly grows, as a line; `None` where it is too short, or where a part
/// was taken already.
pub(super) fn stretch(clocks: &Clocks, sources: &[Source]) -> Option<Cure> {
    let [source] = sources else { return None };
    let log = &source.log;
    if log.mapping.crop.is_some() || source.part.is_some() {
        return None;
    }
    let (first, last) = (log.time.first()?, log.time.last()?);
    let part = (HARDLY / log.rate_hz / clocks.drift.abs()).floor();
    (part >= SHORTEST && part < last - first).then(|| Cure::Line {
        table: "log".into(),
        line: format!(
            "crop = [\"{} s\", \"{} s\"]",
            short(*first),
            short(first + part)
        ),
        replaces: false,
    })
}

/// What was found, what stands all the same, and what to do.
pub(super) fn message(clocks: &Clocks, what: &str, to_do: Option<&str>) -> String {
    let behind = match clocks.drift > 0.0 {
        true => "the force falls behind its motion",
        false => "the motion falls behind its force",
    };
    let ms = four_digits(1e3 * clocks.growth.abs());
    let ppm = four_digits(1e6 * clocks.drift.abs());
    let about = four_digits(1e6 * QUANTILE * clocks.deviation);
    let part = to_do.map_or(String::new(), |line| {
        format!(", or fit a part in which they hardly do: {line}")
    });
    format!(
        "{what}: {behind} by at least {ms} ms more at the end of the log than at its beginning, {ppm} (± {about}) millionths. Coulomb and viscous \
         friction hold; what changes fast with position or speed takes up part of it. Record both by one clock{part}"
    )
}
