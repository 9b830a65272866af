//! Rests: where the axis stands still, at the ends of the record and in between.
//!
//! The force of an axis at rest may lie anywhere up to break-away, wherever integrator, brake or gravity have put it; a
//! fit of the whole record would take it for friction. So rests at the ends are left out of such fits, up to 0.02 s
//! beside the motion. Carried along and not fitted are rests in which the force varies without motion: in between,
//! before whose end it begins to vary at the start (a ramp or steps to break-away), in which it goes to and fro at the
//! end. Those may have been made on purpose, for procedures that start from rest.

mod still;
mod varies;

use super::finding::Finding;
use crate::log::Log;
use crate::mapping::{Mapping, Parts, Rests};
use std::ops::Range;
use stiction_codes::Code;
use stiction_policy::rest;
use stiction_say::{AtRest, Found};

/// A rest at an end of the record, and what becomes of it.
struct End {
    /// Whether it is the start of the record.
    is_first: bool,
    /// Time at which the motion begins or ends, s.
    at: f64,
    /// The samples to leave out; nothing where the force says something.
    cut: Option<Range<usize>>,
}

pub(super) fn rests(log: &mut Log, mapping: &Mapping) {
    log.rests = still::stretches(log, rest::MIN_TIME);
    if log.rests.is_empty() {
        return;
    }
    let spread = varies::spread(log);
    let ends: Vec<End> = log
        .rests
        .iter()
        .filter_map(|rest| end(log, rest.clone(), spread))
        .collect();
    // Where the ends were chosen, they are as they were chosen.
    let chosen = mapping.parts.as_ref().is_some_and(Parts::are_inside);
    let keep = match mapping.rests {
        Some(Rests::Keep) => Some("rests = \"keep\""),
        None if chosen => Some("fit or validate"),
        None if mapping.crop.is_some() => Some("crop"),
        None | Some(Rests::Cut) => None,
    };
    if !ends.is_empty() {
        let finding = at_the_ends(log, &ends, keep);
        log.findings.push(finding);
    }
    let varying: Vec<Range<usize>> = match mapping.rests {
        Some(Rests::Keep) => Vec::new(),
        _ => {
            let rests = log.rests.iter().cloned();
            rests
                .filter(|rest| varies::at_all(log, rest, spread))
                .collect()
        }
    };
    if let Some(finding) = in_between(log, &varying) {
        log.findings.push(finding);
    }
    for rest in varying {
        let rest = unfitted(log, rest, &ends);
        log.exclude(rest, Code::RestBetween);
    }
    if keep.is_none() {
        for cut in ends.into_iter().filter_map(|end| end.cut) {
            log.exclude(cut, Code::RestAtEnd);
        }
    }
}

/// The samples of a rest that are carried along and not fitted: but for those beside the motion and those that are left
/// out altogether.
fn unfitted(log: &Log, rest: Range<usize>, ends: &[End]) -> Range<usize> {
    let time = &log.time;
    let (first, last) = (
        time[rest.start] + rest::FITTED_TIME,
        time[rest.end - 1] - rest::FITTED_TIME,
    );
    let mut from = time.partition_point(|t| *t <= first);
    let mut to = time.partition_point(|t| *t < last);
    if rest.start == 0 {
        from = 0;
    }
    if rest.end == time.len() {
        to = rest.end;
    }
    for cut in ends.iter().filter_map(|end| end.cut.as_ref()) {
        if rest.contains(&cut.start) {
            match cut.start {
                0 => from = from.max(cut.end),
                start => to = to.min(start),
            }
        }
    }
    from..to.max(from)
}

/// What becomes of a rest, if it is at an end of the record.
fn end(log: &Log, rest: Range<usize>, spread: f64) -> Option<End> {
    let time = &log.time;
    let samples = time.len();
    let cut = if rest.start == 0 {
        let until = varies::first_change(log, &rest, spread);
        let last = time[until - 1] - rest::FITTED_TIME;
        0..time.partition_point(|t| *t < last)
    } else if rest.end == samples {
        let first = time[rest.start] + rest::FITTED_TIME;
        let from = time.partition_point(|t| *t <= first);
        match varies::to_and_fro(log, &(from..samples), spread) {
            true => samples..samples,
            false => from..samples,
        }
    } else {
        return None;
    };
    let at = match rest.start {
        0 => time[rest.end - 1],
        start => time[start],
    };
    let long = !cut.is_empty() && time[cut.end - 1] - time[cut.start] >= 0.9 * rest::MIN_TIME;
    Some(End {
        is_first: rest.start == 0,
        at,
        cut: long.then_some(cut),
    })
}

fn at_the_ends(log: &Log, ends: &[End], keep: Option<&'static str>) -> Finding {
    let cuts: Vec<&Range<usize>> = ends.iter().filter_map(|end| end.cut.as_ref()).collect();
    let then = match keep {
        Some(key) => AtRest::Kept { key },
        None if cuts.is_empty() => AtRest::Varying,
        None => {
            let seconds = cuts
                .iter()
                .map(|cut| [log.time[cut.start], log.time[cut.end - 1]]);
            let samples: usize = cuts.iter().map(|cut| cut.len()).sum();
            AtRest::Cut {
                seconds: seconds.collect(),
                samples,
                part: samples as f64 / log.time.len() as f64,
            }
        }
    };
    let time = |is_first| {
        let mut ends = ends.iter();
        ends.find(|end| end.is_first == is_first).map(|end| end.at)
    };
    let at = cuts.first().map_or(0, |cut| cut.start);
    Finding::note(Found::RestAtEnds {
        until: time(true),
        from: time(false),
        then,
    })
    .at(at)
}

fn in_between(log: &Log, varying: &[Range<usize>]) -> Option<Finding> {
    let samples = log.time.len();
    let inside = |rest: &&Range<usize>| rest.start > 0 && rest.end < samples;
    let inside: Vec<&Range<usize>> = log.rests.iter().filter(inside).collect();
    let seconds = |rest: &Range<usize>| log.time[rest.end - 1] - log.time[rest.start];
    let longest = inside
        .iter()
        .max_by(|a, b| seconds(a).total_cmp(&seconds(b)))?;
    let share = inside.iter().map(|rest| rest.len()).sum::<usize>() as f64 / samples as f64;
    let found = Found::RestBetween {
        rests: inside.len(),
        part: share,
        longest: seconds(longest),
        from: log.time[longest.start],
        varying: inside.iter().filter(|rest| varying.contains(rest)).count(),
    };
    Some(Finding::graded(found, share > rest::MAX_SHARE).at(longest.start))
}
