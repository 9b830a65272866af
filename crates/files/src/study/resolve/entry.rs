//! What holds for every entry of a list in a study file: its name, and how long its motion is.

use crate::config::Table;
use crate::config::machine::LEAST_BANDWIDTH;
use crate::error::Error;
use stiction_formats::Dimension;
use stiction_number::{four_digits as short, shortest};
use stiction_servo::run::sample_count;

/// Most samples of a run.
pub(super) const MOST_SAMPLES: usize = 1_000_000;

/// Least samples of a period, a move, a turn: fewer do not represent its form.
pub(super) const LEAST_SAMPLES: f64 = 10.0;

/// Farthest way of a motion, m or rad, as that after which a position may repeat.
pub(in crate::study) const MOST_WAY: f64 = 1e9;

/// Most samples at which a motion is evaluated to find how far it goes.
const MOST_LOOKED_AT: f64 = 10_000.0;

/// Checks that a path is not too long.
pub(super) fn few(table: &Table<'_>, duration: f64, rate: f64) -> Result<(), Error> {
    if sample_count(duration, rate).is_ok_and(|n| n <= MOST_SAMPLES) {
        return Ok(());
    }
    let allowed = format!("at most {MOST_SAMPLES} samples, duration times rate");
    Err(table.refuse("kind", format!("{} s", short(duration)), &allowed))
}

/// Checks that a part of a motion, such as `a period` of some seconds, has enough samples.
pub(super) fn sampled(
    table: &Table<'_>,
    key: &str,
    what: &str,
    seconds: f64,
    rate: f64,
) -> Result<(), Error> {
    let samples = seconds * rate;
    if samples >= LEAST_SAMPLES {
        return Ok(());
    }
    let found = format!("{what} of {} s, {} samples", short(seconds), short(samples));
    let allowed = format!("at least {LEAST_SAMPLES} samples at {} Hz", short(rate));
    Err(table.refuse(key, found, &allowed))
}

/// Checks that a motion goes no farther than any axis, and covers at least one encoder step: the controller sees nothing of a
/// smaller one. `position` at a time, s.
pub(super) fn seen(
    table: &Table<'_>,
    (duration, rate): (f64, f64),
    encoder: f64,
    unit: &str,
    position: impl Fn(f64) -> f64,
) -> Result<(), Error> {
    let samples = (duration * rate).clamp(1.0, MOST_LOOKED_AT);
    let times = (0..=samples as usize).map(|i| duration * i as f64 / samples);
    let (low, high) = times
        .map(position)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
    let way = high - low;
    let found = || format!("goes over {} {unit}", short(way));
    if way > MOST_WAY {
        return Err(table.refuse("kind", found(), &format!("at most {MOST_WAY:e} {unit}")));
    }
    if way >= encoder {
        return Ok(());
    }
    let allowed = format!("at least one encoder step, {} {unit}", short(encoder));
    Err(table.refuse("kind", found(), &allowed))
}

/// Checks that a bandwidth is that of a loop: from a hundredth of a Hz to below half the control rate.
pub(super) fn below_half_the_rate(
    table: &Table<'_>,
    key: &'static str,
    rate: f64,
) -> Result<Option<f64>, Error> {
    let frequency = table.positive(key, Dimension::FREQUENCY)?;
    if frequency.is_some_and(|f| f >= 0.5 * rate || f < LEAST_BANDWIDTH) {
        let half = shortest(0.5 * rate);
        let allowed =
            format!("from {LEAST_BANDWIDTH} Hz to below half the control rate, {half} Hz");
        return Err(table.refused(key, &allowed));
    }
    Ok(frequency)
}

/// The name of an entry: given, or made of what it is.
pub(super) fn name(table: &Table<'_>, default: String) -> Result<String, Error> {
    match table.line("name")?.map(str::trim) {
        None => Ok(default),
        Some(name) if !name.is_empty() && name.chars().count() <= 60 => Ok(name.to_string()),
        Some(name) => Err(table.refuse("name", format!("{name:?}"), "1 to 60 characters")),
    }
}

/// Checks that a name is used once: names tell the rows of the result apart.
pub(super) fn once<'n>(
    table: &Table<'_>,
    mut taken: impl Iterator<Item = &'n String>,
    name: &str,
) -> Result<(), Error> {
    if taken.any(|other| other == name) {
        let allowed = "a name of its own for each: name = \"...\"";
        return Err(table.refuse("name", format!("{name:?} twice"), allowed));
    }
    Ok(())
}
