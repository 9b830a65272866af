//! Numbers of friction over time in words.

use stiction_files::batch::date_of;
use stiction_files::drift_file::{Alarm, DriftFile, NoiseEntry, Unclear};
use stiction_number::{counted, four_digits as short};
use stiction_workflows::drift::least_logs;

/// Seconds of a day.
pub(crate) const DAY: f64 = 86_400.0;

/// A level with its unit.
fn level(value: f64, unit: &str) -> String {
    format!("{} {unit}", short(value))
}

/// A change of an alarm: percent, or in its unit.
fn size(x: f64, alarm: &Alarm) -> String {
    match alarm.relative {
        true => format!("{:+.1} %", 100.0 * x),
        false if x >= 0.0 => format!("+{} {}", short(x), alarm.unit),
        false => level(x, &alarm.unit),
    }
}

/// A part or a size of the noise.
fn part(x: f64, noise: &NoiseEntry) -> String {
    match noise.relative {
        true if x <= 1.0 => format!("{:.2} %", 100.0 * x),
        true => "more than 100 %".into(),
        false => level(x, &noise.unit),
    }
}

/// Scatter, wandering, and from which deviation of five logs on a parameter has changed.
pub(crate) fn noise_of(noise: &NoiseEntry) -> [String; 3] {
    let limit = noise.limits.first().copied().unwrap_or(f64::NAN);
    // Limits of parts are differences of logarithms.
    let limit = if noise.relative {
        limit.exp_m1()
    } else {
        limit
    };
    [noise.scatter, noise.wandering, limit].map(|x| part(x, noise))
}

/// When an alarm began and was found: dates, or logs where there are no times.
fn times(file: &DriftFile, alarm: &Alarm) -> [String; 2] {
    [alarm.since, alarm.found].map(|time| match file.timed {
        true => date_of(time),
        false => format!("log {}", (time / DAY).round()),
    })
}

/// An alarm in a table: machine, parameter, what, since, found, before, after, change, interval.
pub(crate) fn row(file: &DriftFile, alarm: &Alarm) -> [String; 9] {
    let [since, found] = times(file, alarm);
    let interval = alarm.ci95.map_or(String::new(), |[low, high]| {
        format!("{} .. {}", size(low, alarm), size(high, alarm))
    });
    let machine = if alarm.machine.is_empty() {
        "-"
    } else {
        &alarm.machine
    };
    [
        machine.into(),
        alarm.parameter.clone(),
        alarm.limit.clone().unwrap_or_else(|| alarm.kind.clone()),
        since,
        found,
        short(alarm.before),
        level(alarm.after, &alarm.unit),
        size(alarm.size, alarm),
        interval,
    ]
}

/// That the order of the table is taken for time, and which times there are in its place.
pub(crate) fn untimed(file: &DriftFile) -> Option<String> {
    let other = match file.times.first().map(String::as_str) {
        Some("names") => "; --times names takes the dates in their names",
        Some(_) => "; --times files takes the times at which their files were written",
        None => "",
    };
    (!file.timed).then(|| {
        format!("not every log has a time: they are taken in the order of the table, a day from each to the next{other}")
    })
}

/// What is said first where nothing is alarmed: nothing changed, or that this cannot be told.
pub(crate) fn quiet(file: &DriftFile) -> String {
    let same = |noise: &&NoiseEntry| {
        let own = |u: &Unclear| u.parameter == noise.parameter && u.law == noise.law;
        !file.unclear.iter().any(own)
    };
    let told = file.noise.iter().filter(same).count();
    match (told, file.unclear.is_empty() && file.too_short == 0) {
        (0, _) if file.noise.is_empty() => {
            "cannot tell whether anything changed: too few logs to follow anything".into()
        }
        (0, _) => "cannot tell whether anything changed".into(),
        (_, true) => "nothing changed".into(),
        _ => "nothing changed where it can be told".into(),
    }
}

/// Parameters of which it cannot be told whether they changed, and why.
pub(crate) fn unclear(file: &DriftFile) -> Option<String> {
    let few = format!("fewer than {} logs of a machine determine it", least_logs());
    let [few, loud] = [
        (true, few.as_str()),
        (
            false,
            "its logs scatter so much that a change to double or half would not be seen",
        ),
    ]
    .map(|(too_few, why)| {
        let own = file.unclear.iter().filter(|u| u.too_few == too_few);
        let mut names: Vec<&str> = own.map(|u| u.parameter.as_str()).collect();
        names.dedup();
        (!names.is_empty()).then(|| format!("{}: {why}", names.join(", ")))
    });
    let all: Vec<String> = few.into_iter().chain(loud).collect();
    (!all.is_empty()).then(|| format!("cannot tell of {}", all.join("; of ")))
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
