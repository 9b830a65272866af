//! The check workflow: what was read and detected, and what a log can and cannot determine.

mod init;
mod motion;
mod shows;
mod tracking;

pub use init::{Started, init, names};
pub use motion::{Motion, speeds};
pub use shows::Shows;
pub use tracking::{Peak, Tracking, TrackingChange};

use crate::error::Error;
use crate::identify::{Asked, Options, Outcome, identify_asked};
use crate::source::{self, Source};
use serde::Serialize;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::time::Instant;
use stiction_codes::Code;
use stiction_files::Warning;
use stiction_files::axis::{Axis, Use};
use stiction_files::result::{Action, Input, Origin};
use stiction_identify::{Error as Fit, Observer};
use stiction_log::{Found, Log, Severity, Understood};
use stiction_number::four_digits as short;
use stiction_say::Notice;

/// Whether a warning is of what only the fit shows of the log itself; `known` is what the log showed before.
fn is_of_the_fit(warning: &Warning, known: &[Found]) -> bool {
    match warning.kind() {
        Some(Notice::InaccurateStamps { .. }) => true,
        Some(kind) => kind.found().is_some_and(|found| {
            (found.is_jitter() || found.is_force_moved()) && !known.contains(found)
        }),
        None => false,
    }
}

/// What a check found, log by log.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    /// `stiction.check/1`.
    pub schema: String,
    /// The axis file, as given; `null` without one.
    pub axis: Option<PathBuf>,
    /// One entry a log.
    pub logs: Vec<LogCheck>,
    /// How the following of the reference changed from the first log to each other one that has reversals of a reference.
    pub tracking: Vec<TrackingChange>,
}

/// What a check found in one log.
#[derive(Clone, Debug, Serialize)]
pub struct LogCheck {
    /// The file, and how it was understood.
    pub input: Input,
    /// `linear` or `rotary`.
    pub kind: String,
    /// Length of the record, s.
    pub seconds: f64,
    /// What became of every column of the file.
    pub columns: Vec<ColumnCheck>,
    /// Ranges of the channels, for people: `position -0.1 .. 0.1 m`.
    pub ranges: Vec<String>,
    /// What is wrong or worth knowing.
    pub findings: Vec<Finding>,
    /// How it would be conditioned.
    pub conditioning: Vec<String>,
    /// How the axis moves; `null` where it does not.
    pub motion: Option<Motion>,
    /// How well it follows its reference; `null` without a reference that turns back.
    pub tracking: Option<Tracking>,
    /// Why it is not known, or not compared with the first log, in words that complete a sentence.
    pub not_tracked: Option<String>,
    /// What that motion can show, from plain facts.
    pub shows: Vec<Shows>,
    /// What the law that the data choose would and would not determine.
    pub parameters: Vec<ParameterCheck>,
    /// Why nothing could be identified, if so.
    pub refused: Option<String>,
    /// What leads on: a fit, a line of the axis file, or another record.
    pub next: Action,
}

/// A column of the file, as it was understood.
#[derive(Clone, Debug, Serialize)]
pub struct ColumnCheck {
    /// Its number, counted from 1, and its name: `2 "Position [mm]"`.
    pub column: String,
    /// `time`, `position` and so on; `null` where it is not used.
    pub role: Option<String>,
    /// The unit its numbers are read in, with scale and sign.
    pub unit: String,
    /// Why.
    pub reason: String,
}

/// A finding about a log.
#[derive(Clone, Debug, Serialize)]
pub struct Finding {
    /// What it is; each code has a page in `docs/codes/`.
    pub code: Code,
    /// `note` or `warning`.
    pub severity: String,
    /// What was found.
    pub message: String,
}

/// Whether a log determines a parameter.
#[derive(Clone, Debug, Serialize)]
pub struct ParameterCheck {
    /// Name.
    pub name: String,
    /// Estimate, SI.
    pub value: f64,
    /// Unit.
    pub unit: String,
    /// Whether the log determines it.
    pub identifiable: bool,
    /// Why not.
    pub reason: String,
}

/// Reads each log and tries what can be identified from it.
///
/// # Errors
/// Where a log or the axis file is refused.
pub fn check(
    logs: &[PathBuf],
    axis: Option<&Path>,
    observer: &mut dyn Observer,
) -> Result<Check, Error> {
    let axis = match axis {
        Some(file) => Axis::read(file)?,
        None => Axis::default(),
    };
    check_files(logs, &axis, observer)
}

/// The same on an axis file that was read.
///
/// # Errors
/// As [`check`].
pub fn check_files(
    logs: &[PathBuf],
    axis: &Axis,
    observer: &mut dyn Observer,
) -> Result<Check, Error> {
    let listed: Vec<PathBuf> = axis.logs.iter().map(|log| log.file.clone()).collect();
    let all_listed = logs.is_empty() && listed.len() > 1;
    let logs = if logs.is_empty() { &listed } else { logs };
    if logs.is_empty() {
        return Err(Error::usage(
            "no log given",
            "at least one log, here or under [[log]] of the axis file",
        ));
    }
    source::refuse_several(axis, logs.len())?;
    refuse_twice(logs)?;
    let any_fitted = axis
        .logs
        .iter()
        .any(|log| log.mapping(Use::Fitted).is_some());
    let mut out = Vec::new();
    let mut seen: HashMap<String, &PathBuf> = HashMap::new();
    for path in logs {
        let source = source::load(path, axis)?;
        // Two names of one file, or a copy of it.
        if let Some(twin) = seen.insert(source.sha256.clone(), path) {
            return Err(given_twice(twin, path));
        }
        let never_fitted = source.never_fitted;
        let mut found = one(source, axis, observer)?;
        let goes_on = [Action::IDENTIFY, Action::Simulate].contains(&found.next);
        if never_fitted && goes_on && !any_fitted {
            found.next = Action::Remove {
                table: "[[log]]".into(),
                line: "validate = \"all\"".into(),
            };
        } else if never_fitted && goes_on || all_listed && found.next == Action::IDENTIFY {
            found.next = Action::Listed;
        }
        out.push(found);
    }
    Ok(together(out, axis.file()))
}

/// Refuses a log that is given by two paths, as an identification does.
fn refuse_twice(logs: &[PathBuf]) -> Result<(), Error> {
    let mut seen: HashMap<PathBuf, &PathBuf> = HashMap::new();
    for log in logs {
        let place = log.canonicalize().unwrap_or_else(|_| log.clone());
        if let Some(twin) = seen.insert(place, log) {
            return Err(given_twice(twin, log));
        }
    }
    Ok(())
}

fn given_twice(one: &Path, another: &Path) -> Error {
    Error::SameLog {
        first: one.to_path_buf(),
        second: another.to_path_buf(),
        copied: None,
    }
}

/// The same of logs that are in memory already, read with this axis.
///
/// # Errors
/// As [`check`].
pub fn check_logs(
    sources: &[Source],
    axis: &Axis,
    observer: &mut dyn Observer,
) -> Result<Check, Error> {
    let mut out = Vec::new();
    for source in sources {
        out.push(one(source.clone(), axis, observer)?);
    }
    Ok(together(out, axis.file()))
}

/// What is told of several logs.
fn together(mut logs: Vec<LogCheck>, axis: Option<&Path>) -> Check {
    let tracking = changes(&mut logs);
    Check {
        schema: "stiction.check/1".into(),
        axis: axis.map(Path::to_path_buf),
        logs,
        tracking,
    }
}

/// What changed from the first log to each other one that follows a reference of the same kind.
fn changes(logs: &mut [LogCheck]) -> Vec<TrackingChange> {
    let Some((first, later)) = logs.split_first_mut() else {
        return Vec::new();
    };
    let Some(before) = &first.tracking else {
        return Vec::new();
    };
    let mut out = Vec::new();
    for log in later {
        match &log.tracking {
            Some(after) if log.kind == first.kind => match TrackingChange::between(before, after) {
                Ok(change) => out.push(change),
                Err(why) => log.not_tracked = Some(why),
            },
            Some(_) => {
                log.not_tracked = Some(format!("it is {}, the first log {}", log.kind, first.kind))
            }
            None => {}
        }
    }
    out
}

/// Whether an engine refused what an axis file or an option gives.
fn is_setting(error: &Fit) -> bool {
    matches!(error, Fit::Setting { .. } | Fit::Filter { .. })
}

fn one(source: Source, axis: &Axis, observer: &mut dyn Observer) -> Result<LogCheck, Error> {
    let clock = Instant::now();
    let log = &source.log;
    let known: Vec<Found> = log.findings.iter().map(|f| f.kind.clone()).collect();
    let mut out = LogCheck {
        input: source.input(true),
        kind: log.motion.to_string(),
        seconds: log.time.last().copied().unwrap_or(0.0),
        columns: columns(log),
        ranges: ranges(&source),
        findings: log
            .findings
            .iter()
            .map(|f| Finding {
                code: f.code(),
                severity: match f.severity {
                    Severity::Note => "note".into(),
                    Severity::Warning => "warning".into(),
                },
                message: f.to_string(),
            })
            .collect(),
        conditioning: Vec::new(),
        motion: Motion::of(log),
        tracking: None,
        not_tracked: None,
        shows: Vec::new(),
        parameters: Vec::new(),
        refused: None,
        // A force that is not recognised may well be there, or in another file.
        next: match log.force {
            Some(_) => Action::Record,
            None => Action::AxisFile,
        },
    };
    match Tracking::of(&source.path.display().to_string(), log) {
        Ok(tracking) => out.tracking = Some(tracking),
        Err(why) => out.not_tracked = Some(why.into()),
    }
    // Without a force nothing shows, whatever the motion.
    if let (Some(motion), true) = (&out.motion, log.force.is_some()) {
        out.shows = shows::shows(log, motion, axis.terms.mass);
    }
    let slides = out
        .shows
        .iter()
        .any(|s| s.name == "coulomb" && s.shown != "no");
    let simulates = axis.has_inertia() && log.position.is_some();
    let options = Options::default();
    let asked = Asked {
        options: &options,
        axis,
        clock,
    };
    let is_overflown = log.overflow().is_some();
    match identify_asked(asked, vec![source], Vec::new(), observer) {
        Ok(outcome) => {
            out.refused = untrusted(&outcome);
            out.next = match &outcome.result.trust.next {
                own @ (Action::Simulate | Action::AxisFile) => own.clone(),
                // A fit would lead back here.
                own if *own == Action::CHECK => Action::Record,
                _ if slides => Action::IDENTIFY,
                _ => Action::Record,
            };
            let cause = outcome.result.trust.cause.as_ref();
            if let Some(unscaled) = cause.filter(|cause| cause.code == Code::ForceUnit) {
                out.next = unscaled.cure.clone().unwrap_or(Action::AxisFile);
            }
            out.parameters = verdicts(&outcome);
            out.shows.iter_mut().for_each(|shown| {
                let told = |p: &ParameterCheck| p.identifiable && p.name == shown.name;
                shown.told_by_fit(out.parameters.iter().any(told));
            });
            out.conditioning = outcome.result.axis.conditioning;
            let shown = outcome.result.warnings.into_iter();
            let of_the_fit = shown.filter(|warning| is_of_the_fit(warning, &known));
            out.findings.extend(of_the_fit.map(|warning| Finding {
                code: warning.code,
                severity: "warning".into(),
                message: warning.message,
            }));
        }
        // What the log cannot give is a verdict on the log; a bad axis file is an error of its own.
        Err(
            ref e @ Error::Identify {
                ref source,
                ref action,
                ..
            },
        ) if !is_setting(source) => {
            let is_short = matches!(source, Fit::TooFewSamples { .. });
            out.refused = Some(format!("{}: {e}", e.code()));
            let left = e.losses().map(|(losses, _)| losses.left_to_simulate());
            let simulates = simulates && left.is_none_or(|left| left > 0);
            if is_short && simulates && slides {
                out.next = Action::Simulate;
            }
            if matches!(**action, Action::Line { .. } | Action::Remove { .. }) {
                out.next = (**action).clone();
            }
        }
        Err(Error::File(stiction_files::Error::Log(e))) => {
            out.refused = Some(format!("{}: {e}", e.kind.code()))
        }
        Err(e) => return Err(e),
    }
    if is_overflown {
        out.next = Action::AxisFile;
    }
    Ok(out)
}

fn untrusted(outcome: &Outcome) -> Option<String> {
    let trust = &outcome.result.trust;
    (!trust.trustworthy).then(|| trust.reasons.join("; "))
}

fn verdicts(outcome: &Outcome) -> Vec<ParameterCheck> {
    outcome
        .result
        .parameters
        .iter()
        .filter(|p| p.origin == Origin::Identified)
        .map(|p| ParameterCheck {
            name: p.name.clone(),
            value: p.value,
            unit: p.unit.clone(),
            identifiable: outcome.result.trust.constants.contains(&p.name),
            reason: match p.identifiable {
                _ if outcome.result.trust.constants.contains(&p.name) => String::new(),
                false => p.reason.clone(),
                // Beside one level for both directions.
                true if p.name == "offset" && outcome.result.trust.trustworthy => {
                    "it cannot be told from a difference of friction between the two directions"
                        .into()
                }
                true => "the law explains too little of the force".into(),
            },
        })
        .collect()
}

fn columns(log: &Log) -> Vec<ColumnCheck> {
    let one = |column: &Understood| ColumnCheck {
        column: column.column.clone(),
        role: column.role.map(|role| role.to_string()),
        unit: column.unit.clone(),
        reason: column.reason.clone(),
    };
    log.columns.iter().map(one).collect()
}

fn ranges(source: &source::Source) -> Vec<String> {
    let log = &source.log;
    let length = stiction_files::symbols::length_unit(log.motion);
    let speed = stiction_files::symbols::speed_unit(log.motion);
    let channels = [
        ("position", &log.position, length),
        ("velocity", &log.velocity, speed),
        ("force", &log.force, log.force_unit.as_str()),
        ("reference", &log.reference, length),
        ("temperature", &log.temperature, "K"),
        ("load", &log.load, log.load_unit.as_str()),
        ("external", &log.external, log.force_unit.as_str()),
    ];
    channels
        .iter()
        .filter_map(|(name, values, unit)| {
            let values = values.as_ref()?;
            let low = values.iter().copied().fold(f64::INFINITY, f64::min);
            let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            Some(format!("{name} {} .. {} {unit}", short(low), short(high)))
        })
        .collect()
}
