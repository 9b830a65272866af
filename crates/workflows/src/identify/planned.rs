//! What the logs show of the plan that they were recorded by.

use super::outcome::Outcome;
use crate::error::Error;
use crate::source::Source;
use std::path::Path;
use stiction_files::Warning;
use stiction_files::plan::ReadPlan;
use stiction_files::result::{Origin, PieceEntry, PlannedEntry, PlannedParameter, ResultFile};
use stiction_plan::{How, Recognised, recognise};
use stiction_policy::plan;
use stiction_say::{Notice, OffPlan};

/// Reads a plan, and refuses one of another kind of axis.
pub(super) fn read(file: &Path, sources: &[Source]) -> Result<ReadPlan, Error> {
    let plan = ReadPlan::read(file)?;
    let kind = sources.first().map(|source| source.log.motion.to_string());
    match kind {
        Some(kind) if kind != plan.kind => Err(Error::usage(
            format!(
                "{} is the plan of a {} axis, the log that of a {kind} one",
                file.display(),
                plan.kind
            ),
            "the plan that the log was recorded by",
        )),
        _ => Ok(plan),
    }
}

/// Puts the plan beside the result.
pub(super) fn into_outcome(plan: &ReadPlan, outcome: &mut Outcome) {
    let found = outcome.sources.iter().filter_map(|source| {
        let log = &source.log;
        // What was asked for, where the log has it: the axis itself may be held by friction.
        let position = log.reference.as_ref().or(log.position.as_ref())?;
        Some((source, recognise(&plan.motion, &log.time, position)?))
    });
    let mut found: Vec<(&Source, Recognised)> = found.collect();
    // Those that show most of it first; at equal numbers the first given.
    found.sort_by_key(|(_, found)| std::cmp::Reverse(whole(found)));
    let best = found.first();
    let result = &mut outcome.result;
    let parameters = parameters(plan, result);
    let (names, pieces) = together(plan, &found);
    let entry = PlannedEntry {
        path: stiction_files::shell::text(&plan.file),
        sha256: plan.sha256.clone(),
        log: best.map(|_| names.join(" and ")),
        pace: best.map(|(_, found)| found.pace),
        pieces,
        parameters,
    };
    let size = best.and_then(|(_, found)| found.size);
    let size = size.filter(|times| (times - 1.0).abs() > plan::MAX_SIZE_DIFFERENCE);
    let notice = |how| {
        let plan = entry.path.clone();
        Warning::from(Notice::OffPlan { plan, how })
    };
    let all = differs(&entry).into_iter().chain(size.map(OffPlan::Scale));
    result.warnings.extend(all.map(notice));
    result.planned = Some(entry);
}

fn whole(found: &Recognised) -> usize {
    let pieces = found.pieces.iter();
    pieces.filter(|piece| piece.how == How::Whole).count()
}

/// The pieces that logs show together, a motion that was stopped having been run on in another one, and the names of those that show any.
fn together(plan: &ReadPlan, found: &[(&Source, Recognised)]) -> (Vec<String>, Vec<PieceEntry>) {
    let rank = |entry: &PieceEntry| match entry.status.as_str() {
        "whole" => 2,
        "cut-short" => 1,
        _ => 0,
    };
    let (mut names, mut all): (Vec<String>, Vec<PieceEntry>) = Default::default();
    for (source, found) in found.iter().filter(|(_, found)| found.pace == 1.0) {
        let first = source.log.time.first().copied().unwrap_or(0.0);
        let own = pieces(plan, found, first);
        if all.is_empty() {
            (names, all) = (vec![source.name()], own);
            continue;
        }
        let mut more = false;
        for (known, own) in all.iter_mut().zip(own) {
            if rank(&own) > rank(known) {
                (*known, more) = (own, true);
            }
        }
        if more {
            names.push(source.name());
        }
    }
    match found.first() {
        Some((source, _)) if names.is_empty() => (vec![source.name()], all),
        _ => (names, all),
    }
}

fn pieces(plan: &ReadPlan, found: &Recognised, first: f64) -> Vec<PieceEntry> {
    let timed = plan.motion.timed().zip(&found.pieces);
    let entry =
        |((planned_start, atom), ran): ((f64, &stiction_plan::Atom), &stiction_plan::Ran)| {
            PieceEntry {
                planned_start,
                start: ran.start.map(|t| t - first),
                duration: atom.duration(),
                status: match ran.how {
                    How::Whole => "whole",
                    How::CutShort => "cut-short",
                    How::Missing => "missing",
                }
                .into(),
                followed: ran.followed,
            }
        };
    timed.map(entry).collect()
}

fn parameters(plan: &ReadPlan, result: &ResultFile) -> Vec<PlannedParameter> {
    let both = plan.expected.iter().filter_map(|expected| {
        let mut own = result.parameters.iter();
        Some((
            expected,
            own.find(|p| p.name == expected.name && p.origin != Origin::Given)?,
        ))
    });
    both.map(|(expected, found)| {
        let (times, per) = match &expected.of {
            None => (1.0, Some(found.value)),
            Some((of, times)) => (*times, value(result, of)),
        };
        // A plan promises what the same test gives at once.
        let range = || found.range().map(|(low, high)| 0.5 * (high - low));
        let half = found.half_width.map(|half| half.at_once).or_else(range);
        let half = half.zip(per);
        let half = half.map(|(half, per)| 100.0 * times * half / per.abs());
        let half = half.filter(|percent| percent.is_finite());
        let status = match half {
            _ if !found.identifiable => "open",
            Some(percent) if percent <= expected.interval90_percent => "as-expected",
            Some(_) => "wider",
            None => "open",
        };
        PlannedParameter {
            name: expected.name.clone(),
            of: expected.of.as_ref().map(|(of, _)| of.clone()),
            expected_percent: expected.interval_percent,
            expected90_percent: expected.interval90_percent,
            found_percent: half,
            status: status.into(),
        }
    })
    .collect()
}

/// The value of a parameter; of one that is another in each direction that of the positive one.
fn value(result: &ResultFile, name: &str) -> Option<f64> {
    let positive = format!("{name}_pos");
    let mut own = result.parameters.iter();
    own.find(|p| p.name == name || p.name == positive.as_str())
        .map(|p| p.value)
}

/// What was run otherwise than planned.
fn differs(entry: &PlannedEntry) -> Option<OffPlan> {
    match entry.pace {
        None => Some(OffPlan::Absent),
        Some(pace) if entry.pieces.is_empty() => Some(OffPlan::Pace(pace)),
        Some(_) => lacking(entry),
    }
}

/// Pieces that are not whole, and from where to run again.
fn lacking(entry: &PlannedEntry) -> Option<OffPlan> {
    let named = |status: &str| {
        let numbers = (1..).zip(&entry.pieces);
        let own = numbers.filter(|(_, piece)| piece.status == status);
        own.map(|(k, _): (usize, _)| k).collect::<Vec<_>>()
    };
    let (missing, cut) = (named("missing"), named("cut-short"));
    let first = *missing.iter().chain(&cut).min()?;
    Some(OffPlan::Pieces {
        of: entry.pieces.len(),
        missing,
        cut,
        from: entry.pieces[first - 1].planned_start,
    })
}
