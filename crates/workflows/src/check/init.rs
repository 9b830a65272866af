//! `check --init`: an axis file with what was found in a log.

use crate::error::Error;
use crate::source;
use std::path::Path;
use stiction_files::Axis;
use stiction_files::axis::{Addition, Found, extend, template};
use stiction_formats::Table;
use stiction_log::{Channel, Finding, Found as Kind, Log, Mapping, Role};

/// An axis file to write, and what is in it that was not given.
#[derive(Clone, Debug)]
pub struct Started {
    /// The text of the axis file.
    pub text: String,
    /// What was filled in, added or changed, line by line.
    pub changes: Vec<String>,
    /// Why the columns are not all clear, if so.
    pub undecided: Option<String>,
}

/// An axis file for a log, with what was found filled in and the rest to fill in; with an axis file, that file as it
/// is, with what it lacks and the log shows.
///
/// # Errors
/// Where a file cannot be read at all, and where the log does not suit the axis file; columns that cannot be told apart
/// are left to fill in where there is no axis file.
pub fn init(path: &Path, axis: Option<&Path>) -> Result<Started, Error> {
    let given = match axis {
        Some(file) => Axis::read(file)?,
        None => Axis::default(),
    };
    let table = source::table(path, &given)?;
    if let Some(file) = axis {
        let text = std::fs::read_to_string(file)
            .map_err(|e| stiction_files::Error::output(file, format!("cannot be read: {e}")))?;
        let log = source::load(path, &given)?.log;
        let (text, changes) = extend(&text, &additions(&given, &log));
        return Ok(Started {
            text,
            changes,
            undecided: None,
        });
    }
    Ok(match Mapping::detect(&table) {
        Ok(mut detected) => {
            let own_stamps = detected.mapping.own_stamps(&table);
            let coarse = match own_stamps.is_empty() {
                true => counted(&mut detected.mapping, &table),
                false => None,
            };
            let given = Mapping {
                rate_hz: coarse.as_ref().and(detected.mapping.rate_hz),
                ..Mapping::default()
            };
            let log = Log::from_table(&table, &given);
            let mut found = log.as_ref().map(found).unwrap_or_default();
            if let (Some(force), true) = (&mut detected.mapping.force, found.brakes) {
                force.invert = true;
            }
            found.own_stamps = own_stamps;
            found.coarse = coarse;
            found.enable = detected.mapping.enable_line(&table);
            let lacks = |f: &&Finding| matches!(f.kind, Kind::NoForce { .. });
            let lacking = detected.findings.iter().find(lacks);
            let lacking = lacking.map(ToString::to_string);
            // Columns with time stamps of their own are refused until the file that is written names these.
            let refused = log.as_ref().err().filter(|_| found.own_stamps.is_empty());
            if let Some(undecided) = lacking.or(refused.map(ToString::to_string)) {
                found.columns = described(&table);
                return Ok(Started {
                    text: template(&table, Err((&detected.mapping, &undecided)), &found),
                    changes: filled_in(&detected.mapping, &found),
                    undecided: Some(undecided),
                });
            }
            Started {
                text: template(&table, Ok(&detected.mapping), &found),
                changes: filled_in(&detected.mapping, &found),
                undecided: None,
            }
        }
        Err(e) => {
            let mut clear = Mapping::clear_columns(&table);
            let found = Found {
                coarse: counted(&mut clear, &table),
                columns: described(&table),
                enable: clear.enable_line(&table),
                wrap: clear
                    .counter(&table)
                    .map(|counts| format!("{counts} counts")),
                ..Found::default()
            };
            Started {
                text: template(&table, Err((&clear, &e.to_string())), &found),
                changes: filled_in(&clear, &found),
                undecided: Some(e.to_string()),
            }
        }
    })
}

/// Counts the rows at their one rate in place of a time whose clock is coarser than the sampling; the column that is no longer read.
fn counted(mapping: &mut Mapping, table: &Table) -> Option<Channel> {
    let rate = Log::rate_of_coarse_clock(table, mapping)?;
    mapping.rate_hz = Some(rate);
    mapping.time.take()
}

/// What a log shows beside its columns.
fn found(log: &Log) -> Found {
    Found {
        assumed: assumed(log).map(|(role, _)| role).collect(),
        resolution: step(log).map(|step| length(log, step)),
        wrap: wrap(log).map(|travel| match log.counter(travel) {
            Some(counts) => format!("{counts} counts"),
            None => length(log, travel),
        }),
        own_stamps: Vec::new(),
        coarse: None,
        enable: None,
        columns: Vec::new(),
        brakes: brakes(log),
    }
}

/// Whether the force brakes so clearly that its sign is the other one.
fn brakes(log: &Log) -> bool {
    log.finds(|found| matches!(found, Kind::ForceBrakes { .. }))
}

/// The encoder step that was found; none where it is in a unit that is probably wrong: it would stay when that is corrected.
fn step(log: &Log) -> Option<f64> {
    let is_doubtful = log.finds(Kind::is_unlikely_size);
    log.quantum.filter(|_| !is_doubtful)
}

/// A length or angle as an axis file has it, to the last bit.
fn length(log: &Log, value: f64) -> String {
    let unit = log.motion.position().si_text();
    // A step found in data is known to no more digits, and the last ones of a double are not for people.
    let value: f64 = format!("{value:.8e}").parse().unwrap_or(value);
    match (1e-3..1e6).contains(&value) {
        true => format!("{value} {unit}"),
        false => format!("{value:e} {unit}"),
    }
}

/// Columns whose unit was assumed, with the value for the axis file.
fn assumed(log: &Log) -> impl Iterator<Item = (Role, &str)> {
    log.columns.iter().filter_map(|column| {
        let (_, value) = column.assumed.as_ref()?.line.split_once(" = ")?;
        Some((column.role?, value))
    })
}

/// The travel after which the position starts again, where all its jumps are of one size.
fn wrap(log: &Log) -> Option<f64> {
    let x = log.position.as_ref()?;
    if !log.finds(|found| matches!(found, Kind::Jumps { .. })) {
        return None;
    }
    let jump = |i: usize| (x[i] - x[i - 1]).abs();
    let low = x.iter().copied().fold(f64::INFINITY, f64::min);
    let high = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let starts = log.segments.iter().map(|s| s.start).filter(|i| *i > 0);
    let jumps: Vec<f64> = starts
        .map(jump)
        .filter(|j| *j > 0.5 * (high - low))
        .collect();
    let most = jumps.iter().copied().fold(0.0, f64::max);
    let least = jumps.iter().copied().fold(f64::INFINITY, f64::min);
    // Two digits: the motion of one sample is lost in every jump.
    let rounded = format!("{most:.1e}").parse().ok();
    rounded.filter(|_| !jumps.is_empty() && least > 0.9 * most)
}

/// What a template holds that is not a comment.
fn filled_in(mapping: &Mapping, found: &Found) -> Vec<String> {
    let mut out: Vec<String> = mapping
        .motion
        .iter()
        .map(|kind| format!("kind = \"{kind}\""))
        .collect();
    for role in Role::ALL {
        if mapping.channel(role).is_some() {
            out.push(match found.assumed.contains(&role) {
                true => format!("{role}, its unit assumed"),
                false if found.own_stamps.iter().any(|own| own.role == role) => {
                    format!("{role}, with time stamps of its own")
                }
                false if role == Role::Force && found.brakes => {
                    "force, its sign turned: as it stands it brakes".into()
                }
                false => role.to_string(),
            });
        }
    }
    out.extend(mapping.rate_hz.map(|rate| format!("rate = \"{rate} Hz\"")));
    out.extend(
        found
            .resolution
            .iter()
            .map(|step| format!("resolution = \"{step}\"")),
    );
    out
}

/// What an axis file lacks and the log shows.
fn additions(given: &Axis, log: &Log) -> Vec<Addition> {
    let line =
        |table: &'static str, names: &'static [&'static str], value: String, why: &str| Addition {
            table,
            names,
            value,
            why: why.into(),
            replaces: false,
        };
    let mut out = Vec::new();
    if given.mapping.motion.is_none() {
        let why = "from the units or names of the columns";
        out.push(line("", &["kind"], format!("\"{}\"", log.motion), why));
    }
    for column in &log.columns {
        let Some(role) = column.role else { continue };
        let Some(channel) = log.mapping.channel(role) else {
            continue;
        };
        // The log has this column under a number that its file does not know.
        if given.joined.iter().any(|joined| joined.from.role == role) {
            continue;
        }
        let replaces = given.mapping.channel(role).is_some();
        let is_turned = role == Role::Force && !channel.invert && brakes(log);
        if replaces && column.assumed.is_none() && !is_turned {
            continue;
        }
        let channel = &Channel {
            invert: channel.invert || is_turned,
            ..channel.clone()
        };
        let why = match is_turned {
            true => "its sign turned: as it stands it brakes",
            false => &column.reason,
        };
        out.push(Addition {
            replaces,
            ..line(
                "columns",
                names(role),
                stiction_files::axis::entry(channel),
                why,
            )
        });
    }
    if let (None, Some(step)) = (given.mapping.resolution, step(log)) {
        let value = format!("\"{}\"", length(log, step));
        out.push(line(
            "log",
            &["resolution"],
            value,
            "one encoder step, found in the data",
        ));
    }
    out
}

/// The names that a column may have in an axis file.
pub fn names(role: Role) -> &'static [&'static str] {
    match role {
        Role::Time => &["time"],
        Role::Position => &["position"],
        Role::Velocity => &["velocity"],
        Role::Acceleration => &["acceleration"],
        Role::Force => &["force", "torque", "current"],
        Role::Reference => &["reference"],
        Role::Temperature => &["temperature"],
        Role::Load => &["load"],
        Role::External => &["external"],
    }
}

/// What the numbers of each column look like, so that columns without names can be told apart.
fn described(table: &Table) -> Vec<String> {
    table
        .columns
        .iter()
        .map(|column| looks(&column.values))
        .collect()
}

fn looks(values: &[f64]) -> String {
    let numbers: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    let (Some(first), Some(last)) = (numbers.first(), numbers.last()) else {
        return "no numbers".into();
    };
    let low = numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let high = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let short = stiction_number::four_digits;
    if low == high {
        return format!("{} throughout", short(low));
    }
    let range = format!("{} .. {}", short(low), short(high));
    if numbers.windows(2).all(|w| w[1] > w[0]) {
        let step = (last - first) / (numbers.len() - 1) as f64;
        return format!(
            "{range}, rises all the time, by {} a sample: time?",
            short(step)
        );
    }
    range
}
