//! An identification from logs to outcome: load, condition, fit, judge.

use super::assemble::{self, Parts};
use super::condition::{Conditioned, condition, enough};
use super::contradictions;
use super::fit::fit;
use super::friction;
use super::heard::Heard;
use super::judge::judge;
use super::load::{Asked, Loaded, load};
use super::method::Method;
use super::options::{Files, Options};
use super::outcome::{ForceFit, Found, Outcome};
use super::outside;
use super::planned;
use super::procedure::{static_map, step};
use super::remedy;
use super::simulate;
use super::time_offset::{aligned, realigned, unfiltered};
use super::weight;
use crate::error::Error;
use crate::source::{Source, Used, load_held_out, refuse_several, usage_at};
use crate::wording::{Setting, TOGETHER_WITH};
use std::path::PathBuf;
use std::time::Instant;
use stiction_files::{Axis, Warning};
use stiction_identify as engine;
use stiction_identify::{Observer, Record, Series};
use stiction_number::counted;
use stiction_say::Notice;

/// Reads, conditions, fits, compares laws and validates.
///
/// # Errors
/// Where an input cannot be read or nothing can be identified from it. A fit that should not be
/// trusted is not an error: see [`ResultFile::trust`](stiction_files::result::ResultFile::trust).
pub fn identify(
    files: &Files,
    options: &Options,
    observer: &mut dyn Observer,
) -> Result<Outcome, Error> {
    let axis = match &files.axis {
        Some(file) => Axis::read(file)?,
        None => Axis::default(),
    };
    identify_files(options, &axis, &files.logs, &files.validate, observer)
}

/// The same on an axis file that was read: logs that it lists, and parts of them, are used as it says.
///
/// # Errors
/// As [`identify`].
pub fn identify_files(
    options: &Options,
    axis: &Axis,
    given: &[PathBuf],
    validate: &[PathBuf],
    observer: &mut dyn Observer,
) -> Result<Outcome, Error> {
    let clock = Instant::now();
    let ramps = &options.procedures.break_away;
    let logs = match options.procedures.method {
        // Ramps are a commanded force like any other.
        Method::OutputError if given.is_empty() => ramps.as_slice(),
        _ if given.is_empty() && axis.logs.is_empty() && !ramps.is_empty() => {
            return Err(Error::usage(
                [Setting::BreakAway.into(), " without a log".into()],
                [
                    "a log that a law is fitted to, or ".into(),
                    Setting::Method.is(Method::OutputError.name()),
                    ", which fits the ramps themselves".into(),
                ],
            ));
        }
        _ => given,
    };
    let listed: Vec<PathBuf> = axis.logs.iter().map(|log| log.file.clone()).collect();
    let logs = if given.is_empty() && !listed.is_empty() {
        &listed
    } else {
        logs
    };
    refuse_split(options, axis, logs)?;
    let others = [
        validate,
        &options.procedures.statics,
        &options.procedures.break_away,
    ];
    let others = others
        .into_iter()
        .flatten()
        .filter(|log| !logs.contains(log));
    refuse_several(axis, logs.len() + others.count())?;
    let used = Used::load(logs, axis)?;
    let mut held_out = used.held_out;
    held_out.extend(load_held_out(validate, axis)?);
    if used.fitted.is_empty() && !held_out.is_empty() {
        if let Some(listed) = logs.iter().find_map(|path| axis.listed(path)) {
            let found = format!(
                "\"all\", and nothing else is fitted: {}",
                stiction_files::shell::text(&listed.file)
            );
            let allowed = "stretches of the log, or a log beside it that is fitted: without logs on the command line all that are listed \
                           are taken";
            return Err(usage_at(
                axis,
                &format!("{}.validate", listed.key),
                found,
                allowed,
            ));
        }
        return Err(Error::usage(
            "no log to fit: validate = \"all\" under [[log]] of the axis file takes every one",
            "at least one log, or a part of one, that is fitted",
        ));
    }
    let asked = Asked {
        options,
        axis,
        clock,
    };
    identify_asked(asked, used.fitted, held_out, observer)
}

/// Refuses a split of logs whose parts the axis file chooses.
fn refuse_split(options: &Options, axis: &Axis, logs: &[PathBuf]) -> Result<(), Error> {
    let Some(part) = options.split else {
        return Ok(());
    };
    let mut listed = logs.iter().filter_map(|path| axis.listed(path));
    let Some(log) = listed.find(|log| log.has_parts()) else {
        return Ok(());
    };
    Err(Error::usage(
        [
            Setting::Split.is(part),
            TOGETHER_WITH.into(),
            format!(
                "fit or validate of {} under [[log]] of the axis file",
                log.file.display()
            )
            .into(),
        ],
        "one of the two says what is fitted",
    ))
}

/// The same for logs that are in memory already, read with this axis.
///
/// # Errors
/// As [`identify`].
pub fn identify_logs(
    options: &Options,
    axis: &Axis,
    sources: Vec<Source>,
    held_out: Vec<Source>,
    observer: &mut dyn Observer,
) -> Result<Outcome, Error> {
    let asked = Asked {
        options,
        axis,
        clock: Instant::now(),
    };
    identify_asked(asked, sources, held_out, observer)
}

/// The same on a clock that started with the work.
pub(crate) fn identify_asked(
    asked: Asked,
    sources: Vec<Source>,
    held_out: Vec<Source>,
    observer: &mut dyn Observer,
) -> Result<Outcome, Error> {
    let overflown = sources.iter().find_map(|source| {
        let refused = source.log.overflow()?;
        Some(Error::from(refused.in_file(&source.path)))
    });
    let plan = asked.options.procedures.plan.as_deref();
    let plan = plan.map(|file| planned::read(file, &sources)).transpose()?;
    let loaded = load(asked, sources, held_out)?;
    let motion = loaded.sources[0].log.motion;
    let outcome = match asked.options.procedures.method {
        Method::Static => static_map::run(asked, loaded, observer),
        Method::PreslidingStep => step::run(asked, loaded, observer),
        Method::OutputError => simulate::run(asked, loaded, observer),
        Method::Separable | Method::StaticThenDynamic | Method::Searched(_) => {
            fit_force(asked, loaded, observer)
        }
    };
    // Between two overflows there may be too little left of anything.
    let outcome = outcome.map_err(|e| match (e.losses(), overflown) {
        (Some(_), Some(refused)) => refused,
        _ => remedy::led_on(e, asked, motion).at_axis(asked.axis),
    });
    let mut outcome = outcome?;
    if let Some(plan) = &plan {
        planned::into_outcome(plan, &mut outcome);
    }
    Ok(outcome)
}

/// Noise of the position that grows with speed.
fn beside_stamps(record: &Record) -> Option<Warning> {
    let (seconds, step) = (record.timing_noise, record.step());
    let notice = Notice::InaccurateStamps {
        seconds,
        of_sample: seconds / step,
    };
    (seconds > 0.0).then(|| notice.into())
}

/// The refusal of a record that is too short, where the split alone makes it so.
fn of_the_split(asked: Asked, conditioned: &Conditioned, error: Error) -> Error {
    let fitted = conditioned.record.kept();
    let usable = fitted + conditioned.unseen.iter().map(Record::kept).sum::<usize>();
    match (asked.options.split, error.losses()) {
        (Some(part), Some((_, needed))) if usable >= needed => {
            let left = format!(" leaves {} to fit", counted(fitted, "sample"));
            let allowed = enough(needed, (needed, usable));
            Error::usage([Setting::Split.is(part), left.into()], allowed)
        }
        _ => error,
    }
}

/// Fits the force of whole records.
fn fit_force(asked: Asked, loaded: Loaded, observer: &mut dyn Observer) -> Result<Outcome, Error> {
    let heard = &mut Heard::new(observer);
    let mut loaded = aligned(asked, loaded)?;
    let mut conditioned = condition(asked, &loaded, heard)?;
    if !heard.stopped {
        loaded.contradicted = contradictions::named(asked, &loaded, &conditioned, heard);
    }
    if !heard.stopped {
        let realigned = realigned(asked, loaded, conditioned, heard)?;
        (loaded, conditioned) = match heard.stopped {
            true => (realigned.0, realigned.1),
            false => unfiltered(asked, realigned, heard)?,
        };
    }
    // Beside another motion than its own a force says nothing of what is stated.
    let is_moved = loaded.late != 0.0 || loaded.filter.is_some();
    if !heard.stopped && loaded.contradicted.is_none() && is_moved {
        loaded.contradicted = contradictions::named(asked, &loaded, &conditioned, heard);
    }
    let weight = match heard.stopped {
        true => None,
        false => weight::taken(asked, &loaded, &mut conditioned, heard)
            .or_else(|| weight::load_taken(asked, &loaded, &mut conditioned, heard)),
    };
    let ranges = asked.axis.search_box(&loaded.sources[0].log)?;
    let fitted = fit(asked, &loaded, &conditioned, heard);
    let fitted = fitted.map_err(|e| of_the_split(asked, &conditioned, e))?;
    let names = conditioned.unseen_names.iter().cloned();
    let validation: Vec<(String, Series)> = names
        .zip(&conditioned.unseen)
        .map(|(name, record)| (name, engine::predict(record, &fitted.choice.estimate)))
        .collect();
    let mut judged = judge(asked, &loaded, &conditioned, &fitted, &validation);
    let estimate = fitted.choice.estimate;
    let outside = outside::named(&ranges, &estimate, &loaded.sources[0].log);
    judged.warnings.extend(outside);
    judged.warnings.extend(beside_stamps(&conditioned.record));
    let notes = conditioned.record.notes.iter().cloned();
    let mut result = assemble::result(Parts {
        asked,
        sources: &loaded.sources,
        conditioning: notes
            .chain(weight)
            .chain(conditioned.note)
            .chain(assemble::correction_note(&estimate))
            .chain(assemble::counts_note(&estimate))
            .chain(assemble::delay_note(&estimate, loaded.late))
            .chain(assemble::acceleration_note(asked, &loaded.sources))
            .collect(),
        unsettled: assemble::unsettled(&conditioned.record, conditioned.conditioning.settling),
        law: &estimate,
        validation: &validation,
        laws: fitted.choice.laws,
        late: loaded.late,
        without: fitted.choice.without,
        law_chosen_by: fitted.choice.by,
        judged,
    });
    fitted.break_away.into_result(&mut result);
    result.searched = fitted.searched;
    if !heard.stopped {
        let curve =
            engine::friction_curve(&conditioned.record, &estimate, &conditioned.settings, heard);
        // What a law could be fitted to, a curve may still have too little for.
        let curve = curve.ok().flatten();
        let unit = &loaded.sources[0].log.force_unit;
        result.friction_curve = curve.map(|own| friction::entry(&own, loaded.motion(), unit));
    }
    if let Some(both) = fitted.two_steps {
        both.into_result(&estimate, &mut result, loaded.motion());
    }
    Ok(Outcome::new(
        result,
        Found::Force(Box::new(ForceFit {
            estimate,
            conditioning: conditioned.conditioning,
        })),
        validation,
        loaded.sources,
    ))
}
