//! The first step: the logs and the files beside them are read and checked against the options.

use super::beside::Beside;
use super::method::Method;
use super::options::Options;
use super::searched;
use crate::error::Error;
use crate::source::Source;
use crate::wording::Setting;
use std::time::Instant;
use stiction_files::{Axis, Warning};
use stiction_formats::Limits;
use stiction_identify::{ForceFilter, LawKind};
use stiction_log::{Log, Motion, Role, Understood};

/// What is asked, of which axis, and since when.
#[derive(Clone, Copy)]
pub(crate) struct Asked<'a> {
    pub options: &'a Options,
    pub axis: &'a Axis,
    pub clock: Instant,
}

/// Logs of one axis, and what stands beside them.
pub(super) struct Loaded {
    /// Fitted together; at least one.
    pub sources: Vec<Source>,
    /// Validated on.
    pub held_out: Vec<Source>,
    pub beside: Beside,
    /// By how much later than in their rows the force of all logs is taken, s; 0 where it is not.
    pub late: f64,
    /// The low-pass behind which the force of all logs was logged, which was undone.
    pub filter: Option<ForceFilter>,
    /// By how much the logs differ in that, in words, where no delay can be that of all.
    pub apart: Option<String>,
    /// What the axis file states and the log contradicts.
    pub contradicted: Option<Warning>,
}

impl Loaded {
    /// Linear or rotary.
    pub fn motion(&self) -> Motion {
        self.sources[0].log.motion
    }
}

/// Reads what stands beside logs that were read, and refuses what does not go together.
pub(super) fn load(
    asked: Asked,
    sources: Vec<Source>,
    held_out: Vec<Source>,
) -> Result<Loaded, Error> {
    let Asked { options, axis, .. } = asked;
    let chooses = options.law.is_none() && options.procedures.method == Method::Separable;
    if chooses && options.asymmetric {
        return Err(Error::usage(
            [
                Setting::Law.is("auto"),
                " with ".into(),
                Setting::Asymmetric.into(),
            ],
            [
                "one law, such as ".into(),
                Setting::Law.is("lugre"),
                "; auto tries laws both symmetric and asymmetric".into(),
            ],
        ));
    }
    if chooses && !options.compare_laws {
        return Err(Error::usage(
            [
                Setting::Law.is("auto"),
                " without a comparison of laws, which is how it chooses".into(),
            ],
            [
                "a comparison, or one law, such as ".into(),
                Setting::Law.is("lugre"),
            ],
        ));
    }
    let beside = Beside::load(options, axis, &held_out)?;
    // A simulated axis is fitted to ramps like to any commanded force; what they show of break-away is read beside that.
    let is_fitted = |ramp: &&Source| {
        options.procedures.method == Method::OutputError
            && sources.iter().any(|s| s.sha256 == ramp.sha256)
    };
    let ramps = beside.break_away.iter().filter(|ramp| !is_fitted(ramp));
    let ramps: Vec<Source> = ramps.cloned().collect();
    let others = [held_out.as_slice(), &beside.statics, &ramps].concat();
    check_together(&sources, &others)?;
    check_size(&sources, &held_out)?;
    beside.check_model(options, &sources[0])?;
    for source in sources.iter().chain(&held_out) {
        source.check_axis(axis)?;
    }
    let elements = options.law.is_some_and(LawKind::has_elements);
    if axis.exponent_fitted && (elements || options.procedures.method != Method::Separable) {
        return Err(Error::usage(
            "stribeck_exponent = \"fit\" with another method than separable, or a Maxwell-slip law",
            "a number; only the separable method fits it, beside laws with one curve",
        ));
    }
    searched::check(options)?;
    Ok(Loaded {
        sources,
        held_out,
        beside,
        late: 0.0,
        filter: None,
        apart: None,
        contradicted: None,
    })
}

/// Bytes that a sample takes at the peak of a fit: a record, the columns and slopes of the law with the most of them, and replicas.
/// Measured as 560 to 690 with LuGre, 920 with the elements of GMS.
const MEMORY_OF_A_SAMPLE: u64 = 1000;

/// Refuses logs whose fit would take more memory than is allowed, before it begins.
pub(super) fn check_size(fitted: &[Source], held_out: &[Source]) -> Result<(), Error> {
    let all = || fitted.iter().chain(held_out);
    let samples: u64 = all().map(|source| source.log.time.len() as u64).sum();
    let bytes = samples.saturating_mul(MEMORY_OF_A_SAMPLE);
    let what = format!("a fit of {samples} samples");
    let instead = "fit a part of the log: crop = [\"0 s\", \"60 s\"] under [log] of the axis file";
    let allowed = Limits::default().check(&what, bytes, instead);
    let Err(refused) = allowed else {
        return Ok(());
    };
    Err(Error::File(match all().next() {
        Some(first) => refused.in_file(&first.path).into(),
        None => refused.into(),
    }))
}

/// Whether two logs have the same samples, bit by bit: one recording in two files, such as one with a line feed more.
fn is_copy(a: &Log, b: &Log) -> bool {
    let same = |a: &[f64], b: &[f64]| {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
    };
    let both = |a: &Option<Vec<f64>>, b: &Option<Vec<f64>>| match (a, b) {
        (Some(a), Some(b)) => same(a, b),
        (None, None) => true,
        _ => false,
    };
    same(&a.time, &b.time)
        && both(&a.position, &b.position)
        && both(&a.velocity, &b.velocity)
        && both(&a.force, &b.force)
}

/// All logs must be of one kind of axis, with force in one unit, and no log may count twice.
pub(super) fn check_together(sources: &[Source], held_out: &[Source]) -> Result<(), Error> {
    let Some(first) = sources.first() else {
        return Err(Error::usage(
            "no log given",
            "at least one log, here or under [[log]] of the axis file",
        ));
    };
    let all: Vec<&Source> = sources.iter().chain(held_out).collect();
    for (i, log) in all.iter().enumerate() {
        // Parts of one log do not overlap.
        let apart =
            |a: &Source, b: &Source| a.part.is_some() && b.part.is_some() && a.part != b.part;
        let same_bytes = |other: &Source| other.sha256 == log.sha256;
        let same = |other: &&&Source| {
            !apart(other, log) && (same_bytes(other) || is_copy(&other.log, &log.log))
        };
        if let Some(twin) = all[..i].iter().find(same) {
            return Err(Error::SameLog {
                first: twin.path.clone(),
                second: log.path.clone(),
                copied: (!same_bytes(twin)).then_some(log.log.time.len()),
            });
        }
    }
    for other in sources.iter().chain(held_out).skip(1) {
        if other.log.motion != first.log.motion || other.log.force_unit != first.log.force_unit {
            return Err(Error::usage(
                format!("{}, {}", axis_of(first), axis_of(other)),
                "logs that are fitted or validated together must be of one axis",
            ));
        }
        if let Some((role, [one, another])) = other_column(&first.log, &other.log) {
            return Err(Error::usage(
                format!(
                    "the {role} is column {one} in {} and column {another} in {}, which both have",
                    first.path.display(),
                    other.path.display()
                ),
                format!(
                    "one of them for all logs, named in axis.toml under [columns]: {role} = {0} or {role} = {1}",
                    name(one),
                    name(another)
                ),
            ));
        }
    }
    Ok(())
}

/// A role for which two logs with the same columns were read from different ones: the joint that moves need not be the same.
fn other_column<'a>(a: &'a Log, b: &'a Log) -> Option<(Role, [&'a str; 2])> {
    [Role::Position, Role::Velocity, Role::Force]
        .into_iter()
        .find_map(|role| {
            let taken = |log: &'a Log| log.columns.iter().find(|c| c.role == Some(role));
            let (one, another) = (taken(a)?, taken(b)?);
            let has = |log: &Log, column: &Understood| {
                log.columns
                    .iter()
                    .any(|c| name(&c.column) == name(&column.column))
            };
            let differ = name(&one.column) != name(&another.column);
            let both = differ && has(b, one) && has(a, another);
            both.then_some((role, [one.column.as_str(), another.column.as_str()]))
        })
}

/// The name of a column without its number: `"position"` of `2 "position"`; the number where it has no name.
fn name(column: &str) -> &str {
    column.split_once(' ').map_or(column, |(_, name)| name)
}

/// Of what kind of axis a log is.
fn axis_of(source: &Source) -> String {
    let log = &source.log;
    let force = match log.force_unit.is_empty() {
        true => "without a force".into(),
        false => format!("with force in {}", log.force_unit),
    };
    format!("{} is {} {force}", source.path.display(), log.motion)
}
