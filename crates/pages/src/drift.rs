//! Numbers of friction over time in words.

use stiction_files::batch::date_of;
use stiction_files::drift_file::{Alarm, DriftFile, NoiseEntry};
use stiction_number::{counted, four_digits as short};

/// Seconds of a day.
pub(crate) const DAY: f64 = 86_400.0;

/// A level with its unit.
pub(crate) fn level(value: f64, unit: &str) -> String {
    format!("{} {unit}", short(value))
}

/// A change of an alarm: percent, or in its unit.
pub(crate) fn size(x: f64, alarm: &Alarm) -> String {
    match alarm.relative {
        true => format!("{:+.1} %", 100.0 * x),
        false if x >= 0.0 => format!("+{} {}", short(x), alarm.unit),
        false => level(x, &alarm.unit),
    }
}

/// A part or a size of the noise.
fn part(x: f64, noise: &NoiseEntry) -> String {
    match noise.relative {
        true => format!("{:.2} %", 100.0 * x),
        false => level(x, &noise.unit),
    }
}

/// Scatter, wandering, and from which deviation of five logs on a parameter has changed.
pub(crate) fn noise_of(noise: &NoiseEntry) -> [String; 3] {
    let limit = noise.limits.first().copied().unwrap_or(f64::NAN);
    [
        part(noise.scatter, noise),
        part(noise.wandering, noise),
        part(limit, noise),
    ]
}

/// When an alarm began and was found: dates, or logs where there are no times.
pub(crate) fn times(file: &DriftFile, alarm: &Alarm) -> [String; 2] {
    [alarm.since, alarm.found].map(|time| match file.timed {
        true => date_of(time),
        false => format!("log {}", (time / DAY).round()),
    })
}

/// That logs name no machine.
pub(crate) fn unnamed(file: &DriftFile) -> String {
    let logs = file.input.unnamed;
    format!(
        "{} {} no machine (machine in the list of the batch, or name in the axis file): {} taken for one machine",
        counted(logs, "log"),
        if logs == 1 { "names" } else { "name" },
        if logs == 1 { "it is" } else { "they are" },
    )
}

/// Machines from which on one that creeps stands out of what all do by themselves.
const FEW: usize = 5;

/// That a slow change of one machine would look like what machines do by themselves, where there are few.
pub(crate) fn few(file: &DriftFile) -> Option<String> {
    let most = file.noise.iter().max_by_key(|noise| noise.machines)?;
    (most.machines < FEW).then(|| {
        format!(
            "{} {} too few to tell slow changes of one from what all do by themselves: a limit finds them, such as --limit \"{} > 1.3\"",
            counted(most.machines, "machine"),
            if most.machines == 1 { "is" } else { "are" },
            most.parameter
        )
    })
}
