//! From the table to alarms.

use super::asked::Limit;
use super::courses::{Courses, Followed, Number, Times};
use crate::batch::batch_of;
use crate::error::Error;
use std::collections::BTreeMap;
use std::path::Path;
use stiction_drift::{Judged, Kind, Limits, Noise, Point, Settings, judge, plain};
use stiction_files::batch::{LogRow, read_results_while};
use stiction_files::drift_file::{Alarm, DriftFile, NoiseEntry, SCHEMA, Table, Unclear};
use stiction_files::{sha256_of, shell};

/// What changed, and the courses of what did.
pub struct DriftOutcome {
    /// What goes into `drift.json`.
    pub file: DriftFile,
    /// Machine, parameter, course and what became of it, of each that is alarmed, once, in the order of the alarms.
    pub shown: Vec<Shown>,
    /// The same of some that are not.
    pub quiet: Vec<Shown>,
}

/// Most courses without an alarm that are kept to be drawn.
const MOST_QUIET: usize = 24;

/// A course to be drawn.
pub struct Shown {
    /// Machine.
    pub machine: String,
    /// Parameter.
    pub parameter: String,
    /// Law that it is of.
    pub law: String,
    /// SI unit.
    pub unit: String,
    /// The estimates.
    pub followed: Followed,
    /// What became of them.
    pub judged: Judged,
}

const DAY: f64 = 86_400.0; // s

/// Logs of one machine from which on something is said of it.
pub fn least_logs() -> usize {
    Settings::default().reference + stiction_drift::WINDOWS[0]
}

/// Follows every parameter of every machine of a table that `batch` wrote, or of a folder of such tables, with times of the table or
/// others.
///
/// # Errors
/// Where it cannot be read, holds no parameter that its logs determine, a log has no time of the kind that is asked for, or a limit is
/// of a parameter or a unit that it does not have.
pub fn drift(table: &Path, limits: &[Limit], times: Times) -> Result<DriftOutcome, Error> {
    Ok(drift_while(table, limits, times, || true)?.expect("goes on"))
}

/// The same for as long as `goes_on` says so, which is asked all the time; else `None`.
///
/// # Errors
/// As of [`drift`].
pub fn drift_while(
    table: &Path,
    limits: &[Limit],
    times: Times,
    mut goes_on: impl FnMut() -> bool,
) -> Result<Option<DriftOutcome>, Error> {
    let mut courses = Courses::new(times);
    check_finished(table)?;
    let mut fault = None;
    let hash = read_results_while(table, &mut goes_on, |row| {
        fault = fault.take().or_else(|| courses.take(&row).err());
        Ok(())
    })?;
    if let Some(fault) = fault {
        return Err(fault);
    }
    let Some(hash) = hash else {
        return Ok(None);
    };
    followed(shell::text(table), hash, courses, limits, &mut goes_on)
}

/// The same of rows that are in memory; the hash is of what is written of them as JSON, one after the other.
///
/// # Errors
/// As of [`drift`].
pub fn drift_of_rows_while(
    name: &str,
    rows: impl IntoIterator<Item = LogRow>,
    limits: &[Limit],
    times: Times,
    mut goes_on: impl FnMut() -> bool,
) -> Result<Option<DriftOutcome>, Error> {
    let mut courses = Courses::new(times);
    let mut hash = String::new();
    for row in rows {
        if !goes_on() {
            return Ok(None);
        }
        let text = serde_json::to_string(&row).expect("plain data");
        hash = sha256_of(format!("{hash}{text}").as_bytes());
        courses.take(&row)?;
    }
    followed(name.into(), hash, courses, limits, &mut goes_on)
}

fn followed(
    name: String,
    hash: String,
    mut courses: Courses,
    limits: &[Limit],
    goes_on: &mut dyn FnMut() -> bool,
) -> Result<Option<DriftOutcome>, Error> {
    let settings = Settings::default();
    courses.sort();
    if courses.stands_still() {
        return Err(Error::usage(
            format!("{name}: all logs have the same time"),
            "times in the list of the batch, or none for the order of the table",
        ));
    }
    if courses.of.is_empty() {
        return Err(Error::usage(
            format!(
                "{name}: {} logs, and none determines a parameter",
                courses.logs
            ),
            "a table of stiction batch with logs of which something was identified",
        ));
    }
    check(limits, &courses)?;
    let long = |followed: &Followed| followed.points.len() >= least_logs();
    // Of a machine as many parameters are looked at as have courses.
    let mut looked: BTreeMap<&str, usize> = BTreeMap::new();
    for (machine, followed) in courses.of.values().flatten() {
        *looked.entry(machine).or_default() += usize::from(long(followed));
    }
    let numbers = looked.values().copied().max().unwrap_or(1);
    let mut noise = Vec::new();
    let mut unclear = Vec::new();
    let mut alarms = Vec::new();
    let (mut shown, mut quiet): (Vec<Shown>, Vec<Shown>) = (Vec::new(), Vec::new());
    for (number, machines) in &courses.of {
        let points: Vec<&[Point]> = machines.values().map(|f| &f.points[..]).collect();
        if !goes_on() {
            return Ok(None);
        }
        let any_long = machines.values().any(long);
        let found = Noise::of(&points).filter(|_| any_long);
        let mut beyond = None;
        if let Some(found) = &found {
            let Some(limits) = Limits::of_while(found, numbers, &settings, &mut *goes_on) else {
                return Ok(None);
            };
            noise.push(entry(number, &points, found, &limits));
            beyond = Some((found, limits));
        }
        let tells = |(found, limits): &(&Noise, Limits)| limits.tell(found);
        if !beyond.as_ref().is_some_and(tells) {
            unclear.push(Unclear {
                parameter: number.name.clone(),
                law: number.law.clone(),
                logs: points.iter().map(|course| course.len()).max().unwrap_or(0),
                too_few: beyond.is_none(),
            });
        }
        for (machine, followed) in machines {
            if !goes_on() {
                return Ok(None);
            }
            let judged = beyond
                .as_ref()
                .and_then(|(found, limits)| judge(&followed.points, found, limits));
            // A limit holds for the logs as they stand where nothing is known of their noise.
            let judged = judged.unwrap_or_else(|| plain(&followed.points));
            let mut own = changes(number, machine, followed, &judged);
            own.extend(exceeded(limits, number, machine, followed, &judged));
            let into = match own.is_empty() {
                false => &mut shown,
                true if quiet.len() < MOST_QUIET => &mut quiet,
                true => continue,
            };
            alarms.extend(own);
            into.push(Shown {
                machine: machine.clone(),
                parameter: number.name.clone(),
                law: number.law.clone(),
                unit: number.unit.clone(),
                followed: followed.clone(),
                judged,
            });
        }
    }
    alarms.sort_by(|a, b| b.over.total_cmp(&a.over));
    let place = |s: &Shown| {
        let same =
            |a: &Alarm| a.machine == s.machine && a.parameter == s.parameter && a.law == s.law;
        alarms.iter().position(same)
    };
    shown.sort_by_key(place);
    let too_short = courses
        .machines
        .keys()
        .filter(|m| looked.get(m.as_str()).is_none_or(|n| *n == 0));
    Ok(Some(DriftOutcome {
        file: DriftFile {
            schema: SCHEMA.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            input: Table {
                path: name,
                sha256: hash,
                logs: courses.logs,
                failed: courses.failed,
                unnamed: courses.unnamed,
            },
            alarmed: settings.alarmed,
            horizon_days: settings.horizon / DAY,
            reference_logs: settings.reference,
            timed: courses.is_timed(),
            times: courses.other_times(),
            machines: courses.machines.len(),
            too_short: too_short.count(),
            noise,
            unclear,
            alarms,
            apart: courses.levels.apart(),
        },
        shown,
        quiet,
    }))
}

/// Refuses the table of a batch that is not there since the batch was not finished.
fn check_finished(table: &Path) -> Result<(), Error> {
    let dir = table.parent().unwrap_or(Path::new(""));
    let batch = batch_of(dir);
    match batch.filter(|_| !table.exists()) {
        None => Ok(()),
        Some(batch) => Err(Error::usage(
            format!(
                "{}: is not there, since the batch was not finished ({})",
                shell::text(table),
                batch.status
            ),
            format!("a batch that is complete: {}", batch.command(dir)),
        )),
    }
}

/// Refuses a limit of what the table does not have.
fn check(limits: &[Limit], courses: &Courses) -> Result<(), Error> {
    for limit in limits {
        let same = |number: &&Number| number.name == limit.parameter;
        let mut units: Vec<&str> = courses
            .of
            .keys()
            .filter(same)
            .map(|n| n.unit.as_str())
            .collect();
        units.dedup();
        if units.is_empty() {
            let mut names: Vec<&str> = courses.of.keys().map(|n| n.name.as_str()).collect();
            names.sort_unstable();
            names.dedup();
            let found = format!(
                "the limit {:?}: no log determines {}",
                limit.text, limit.parameter
            );
            return Err(Error::usage(found, format!("one of {}", names.join(", "))));
        }
        if let Some(unit) = limit
            .unit
            .as_ref()
            .filter(|_| units.iter().all(|unit| limit.in_unit(unit).is_none()))
        {
            let found = format!(
                "the limit {:?}: {} is not in {unit}",
                limit.text, limit.parameter
            );
            return Err(Error::usage(
                found,
                format!("{}, or none for times the first logs", units.join(", ")),
            ));
        }
    }
    Ok(())
}

fn entry(number: &Number, points: &[&[Point]], noise: &Noise, limits: &Limits) -> NoiseEntry {
    NoiseEntry {
        parameter: number.name.clone(),
        law: number.law.clone(),
        unit: number.unit.clone(),
        relative: noise.measure == stiction_drift::Measure::Relative,
        machines: points.len(),
        logs: points.iter().map(|course| course.len()).sum(),
        scatter: noise.scatter,
        wandering: noise.wandering,
        memory_days: noise.memory / DAY,
        by_temperature: noise.by_temperature,
        limits: limits.of_window.to_vec(),
    }
}

fn changes(number: &Number, machine: &str, followed: &Followed, judged: &Judged) -> Vec<Alarm> {
    let relative = judged.measure == stiction_drift::Measure::Relative;
    let one = |change: &stiction_drift::Change| {
        let (log, axis) = followed.logs[change.found].clone();
        Alarm {
            machine: machine.into(),
            parameter: number.name.clone(),
            law: number.law.clone(),
            unit: number.unit.clone(),
            kind: match change.kind {
                Kind::Step => "step".into(),
                Kind::Creep => "creep".into(),
            },
            since: followed.points[change.since].time,
            found: followed.points[change.found].time,
            log,
            axis,
            before: change.before,
            after: match relative {
                true => change.before * (1.0 + change.size),
                false => change.before + change.size,
            },
            size: change.size,
            ci95: Some([change.low, change.high]),
            relative,
            over: change.over,
            limit: None,
        }
    };
    judged.changes.iter().map(one).collect()
}

fn exceeded(
    limits: &[Limit],
    number: &Number,
    machine: &str,
    followed: &Followed,
    judged: &Judged,
) -> Vec<Alarm> {
    let own = limits.iter().filter(|limit| limit.parameter == number.name);
    let own = own.filter_map(|limit| limit.in_unit(&number.unit));
    let relative = judged.measure == stiction_drift::Measure::Relative;
    let beyond = own.filter_map(|limit| {
        let over = limit.over(judged.last, judged.reference)?;
        let (since, found) = beyond_since(&followed.points, &limit, judged.reference);
        let (log, axis) = followed.logs.get(found)?.clone();
        Some(Alarm {
            machine: machine.into(),
            parameter: number.name.clone(),
            law: number.law.clone(),
            unit: number.unit.clone(),
            kind: "limit".into(),
            since: followed.points[since].time,
            found: followed.points[found].time,
            log,
            axis,
            before: judged.reference,
            after: judged.last,
            size: match relative {
                true => judged.last / judged.reference - 1.0,
                false => judged.last - judged.reference,
            },
            ci95: None,
            relative,
            over,
            limit: Some(limit.text.clone()),
        })
    });
    beyond.collect()
}

/// Since which log a limit has been exceeded: the middle one of the first of the shortest windows whose medians are beyond it,
/// without a break up to the last; and with which log of that window this was known.
fn beyond_since(points: &[Point], limit: &Limit, reference: f64) -> (usize, usize) {
    let logs = stiction_drift::WINDOWS[0].min(points.len());
    let is_beyond = |begin: &usize| {
        let mut values: Vec<f64> = points[*begin..begin + logs]
            .iter()
            .map(|point| point.value)
            .collect();
        values.sort_by(f64::total_cmp);
        limit.over(values[logs / 2], reference).is_some()
    };
    let last = points.len() - logs;
    let since = (0..=last).rev().take_while(is_beyond).last();
    let since = since.unwrap_or(last);
    (since + logs / 2, since + logs - 1)
}
