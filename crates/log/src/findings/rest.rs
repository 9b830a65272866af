//! Rests: where the axis stands still, at the ends of the record and in between.
//!
//! The force of an axis at rest may lie anywhere up to break-away, wherever integrator, brake or gravity have put it; a
//! fit of the whole record would take it for friction. So rests at the ends are left out of such fits, up to 0.02 s
//! beside the motion. Carried along and not fitted are rests in which the force varies without motion: in between,
//! before whose end it begins to vary at the start (a ramp or steps to break-away), in which it goes to and fro at the
//! end. Those may have been made on purpose, for procedures that start from rest.

mod still;
mod varies;

use super::finding::{Finding, Severity};
use crate::log::Log;
use crate::mapping::{Mapping, Parts, Rests};
use std::ops::Range;
use stiction_codes::Code;
use stiction_number::Percent;
use stiction_number::{counted as count, short};
use stiction_policy::rest;

/// A rest at an end of the record, and what becomes of it.
struct End {
    /// `at the start until 8.2 s`.
    words: String,
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
    let words = match rest.start {
        0 => format!("at the start until {} s", short(time[rest.end - 1])),
        start => format!("at the end from {} s", short(time[start])),
    };
    let long = !cut.is_empty() && time[cut.end - 1] - time[cut.start] >= 0.9 * rest::MIN_TIME;
    Some(End {
        words,
        cut: long.then_some(cut),
    })
}

fn at_the_ends(log: &Log, ends: &[End], keep: Option<&str>) -> Finding {
    let words: Vec<&str> = ends.iter().map(|end| end.words.as_str()).collect();
    let mut message = format!("the axis stands still {}", words.join(" and "));
    let cuts: Vec<&Range<usize>> = ends.iter().filter_map(|end| end.cut.as_ref()).collect();
    if let Some(key) = keep {
        message.push_str(&format!(
            "; kept, because the axis file gives {key} under [log]"
        ));
    } else if cuts.is_empty() {
        message.push_str(
            "; the force varies meanwhile, as before a break-away: procedures that start from rest see it, fits of the whole \
             record do not",
        );
    } else {
        let times: Vec<String> = cuts
            .iter()
            .map(|cut| {
                let (from, to) = (log.time[cut.start], log.time[cut.end - 1]);
                format!("{} to {} s", short(from), short(to))
            })
            .collect();
        let samples: usize = cuts.iter().map(|cut| cut.len()).sum();
        let part = 100.0 * samples as f64 / log.time.len() as f64;
        message.push_str(&format!(
            "; fits of the whole record leave out {} ({}, {}), where the force says nothing of friction; to keep it: \
             rests = \"keep\" under [log] in the axis file",
            times.join(" and "),
            count(samples, "sample"),
            Percent::error(part).short()
        ));
    }
    let at = cuts.first().map_or(0, |cut| cut.start);
    Finding::new(Code::RestAtEnd, Severity::Note, message).at(at)
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
    let mut message = format!(
        "{} between motions, {} of the samples, the longest {} s from {} s",
        count(inside.len(), "rest"),
        Percent::error(100.0 * share).short(),
        short(seconds(longest)),
        short(log.time[longest.start]),
    );
    let unfitted = inside.iter().filter(|rest| varying.contains(rest)).count();
    if unfitted > 0 {
        message.push_str(&format!(
            "; in {unfitted} of them the force varies without motion, which no friction law follows: fits of the whole record \
             carry these along and do not fit them; to fit them: rests = \"keep\" under [log] in the axis file"
        ));
    }
    let severity = match share > rest::MAX_SHARE {
        true => Severity::Warning,
        false => Severity::Note,
    };
    Some(Finding::new(Code::RestBetween, severity, message).at(longest.start))
}
