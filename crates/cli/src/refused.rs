//! What leads on from a refusal, by the command that was typed.

use crate::arguments::{self, Command};
use crate::commands::{law, method};
use crate::large;
use crate::next::after;
use crate::output;
use crate::wording;
use clap::ValueEnum;
use std::io::Write;
use std::path::{Path, PathBuf};
use stiction::commands::Settled;
use stiction::commands::number::full;
use stiction::commands::shell::{quoted_path, text as path_text};
use stiction::commands::{FileError, limits_to_fill_in};
use stiction::{Axis, Code, Error, LawKind, Method};

/// Writes the lines of `[limits]` that an axis file lacks for a plan, as they are pasted.
pub fn limits(error: &Error, plan: &arguments::Plan) {
    let Error::File(refused) = error else { return };
    // What is missing has no line.
    let is_lacking = |(file, line): &(&Path, Option<usize>)| *file == plan.axis && line.is_none();
    if !refused.to_correct().iter().any(is_lacking) {
        return;
    }
    if let Some(lines) = limits_to_fill_in(&plan.axis, plan.log.as_deref()) {
        // With standard error closed there is nowhere to say it.
        let _ = writeln!(
            std::io::stderr(),
            "stiction: lines for {}, under [limits], to be filled in:\n{}",
            output::line(&path_text(&plan.axis)),
            output::plain(&lines)
        );
    }
}

/// What to type next, where that is clear.
pub fn next(error: &Error, command: &Command) -> Option<String> {
    if let Error::File(FileError::TooLarge { needed, .. }) = error {
        return Some(large::with_more_samples(*needed));
    }
    if let Some(next) = crate::next::missing(error)
        .or_else(|| crate::next::other_form(error))
        .or_else(|| crate::next::table_as_log(error))
        .or_else(|| crate::next::no_room(error))
        .or_else(|| crate::next::another_folder(error))
    {
        return Some(next);
    }
    if let Error::File(FileError::Runs { .. }) = error {
        return Some(large::anew());
    }
    if let Command::Identify(identify) = command {
        match error.code() {
            Code::TooFewSamples => return more_samples(error, identify),
            Code::NoMotion | Code::NoForce => return Some(still(error, identify)),
            Code::BadRecord => {
                let log = std::slice::from_ref(faulty(&identify.logs, error)?);
                let what = "which channels it has (logs that are fitted together have the same):";
                return Some(looked_at(log, identify, what));
            }
            Code::Usage
                if law(identify.law).is_some_and(LawKind::needs_no_search)
                    && is_search(identify.method) =>
            {
                return Some(again(identify, "", &identify.out));
            }
            Code::NoStep => {
                let what = "how the force runs, and what else the log is good for:";
                return Some(looked_at(&identify.logs, identify, what));
            }
            Code::NoBreakAway => {
                let what =
                    "what to record instead is in docs/procedures.md; what the log is good for:";
                return Some(looked_at(&identify.break_away, identify, what));
            }
            _ => {}
        }
    }
    if let Command::Check(check) = command
        && let (Some(file), Some(log)) = (&check.init, check.logs.first())
        && check.axis.is_none()
        && let Some(next) = crate::next::another_init(error, file, log)
    {
        return Some(next);
    }
    if let Command::Identify(identify) = command
        && let Some(next) = crate::next::another_checkpoint(error, identify)
    {
        return Some(next);
    }
    if let Some(next) = crate::next::no_folder(error) {
        return Some(next);
    }
    if let Command::Drift(drift) = command {
        return crate::next::table(error, &drift.results)
            .or_else(|| crate::next::not_followed(error, &drift.results, !drift.limit.is_empty()));
    }
    if let Command::Check(arguments::Check { logs, .. })
    | Command::Identify(arguments::Identify { logs, .. }) = command
        && error.code() == Code::Usage
        && let Some(next) = crate::next::once(logs)
    {
        return Some(next);
    }
    if let Command::Batch(batch) = command
        && error.code() == Code::Usage
    {
        return crate::next::no_logs(&batch.inputs);
    }
    if let Some(next) = crate::next::no_file(error) {
        return Some(next);
    }
    let first;
    let (logs, axis) = match command {
        Command::Plan(plan) => {
            first = (Vec::from_iter(plan.log.clone()), Some(plan.axis.clone()));
            (&first.0, &first.1)
        }
        Command::Check(check) if check.init.is_none() || axis_is_no_way_out(error) => {
            (&check.logs, &check.axis)
        }
        Command::Identify(identify) => (&identify.logs, &identify.axis),
        Command::Check(check) => return crate::next::many(error, &check.logs),
        _ => return None,
    };
    if let Some(next) = crate::next::many(error, logs) {
        return Some(next);
    }
    let unclear = matches!(
        error.code(),
        Code::LogMissing | Code::LogAmbiguous | Code::LogUnit
    );
    if let Error::File(FileError::Log(e)) = error
        && e.file.as_ref().is_some_and(|file| logs.contains(file))
        && (is_in_a_row(error) || is_read(error) || e.settled_by_line().is_some())
    {
        return Some(unread(e, logs, axis.as_deref()));
    }
    if let Some(axis) = axis
        .as_deref()
        .filter(|_| unclear && crate::next::corrected(error).is_none())
    {
        let lines = match wording::lines(error).len() {
            1 => "that line",
            _ => "those lines",
        };
        return Some(after(
            &format!("with {lines} in {}:", typed(axis)),
            &crate::next::again(),
        ));
    }
    if let Command::Plan(plan) = command
        && let Some(log) = plan.log.as_deref()
        && !matches!(error, Error::File(FileError::Config { .. }))
        && begins_with(&wording::message(error), log)
        && error.code() != Code::Usage
    {
        let check = format!("stiction check {} --axis {}", typed(log), typed(&plan.axis));
        return Some(after("what the log shows:", &check));
    }
    // Of a time or of values by which no axis moves the axis file gives the unit.
    let is_scaled = matches!(error.code(), Code::LogTime | Code::LogValue);
    if let Some(axis) = axis
        .as_deref()
        .filter(|_| is_scaled && crate::next::corrected(error).is_none())
    {
        return Some(after(
            &format!("correct {} as said above, then", typed(axis)),
            &crate::next::again(),
        ));
    }
    let log = faulty(logs, error).filter(|_| (unclear || is_scaled) && axis.is_none())?;
    Some(crate::next::begun(log))
}

/// Whether something is wrong with a row; memory that ends at one is wrong with none.
fn is_in_a_row(error: &Error) -> bool {
    let of_row = |e: &stiction::commands::LogError| e.place.row.is_some();
    let is_placed = matches!(error, Error::File(FileError::Log(e)) if of_row(e));
    is_placed && error.code() != Code::LogLimit
}

/// Whether a log was refused while it was read, for what is written in it.
fn is_read(error: &Error) -> bool {
    // Columns that are too many are of the file; of memory more may be allowed.
    let is_wide = error.code() == Code::LogLimit && wording::message(error).contains("columns");
    error.code() == Code::LogFormat || is_wide
}

/// Whether a log could not be read at all, so that no axis file can be made of it either.
fn axis_is_no_way_out(error: &Error) -> bool {
    let read = |e: &stiction::commands::LogError| e.place.row.is_none();
    is_read(error) || matches!(error, Error::File(FileError::Log(e)) if !read(e))
}

/// What leads on from a text whose rows cannot be read: the line of the axis file that says how, else the same again once the
/// file is mended.
fn unread(error: &stiction::commands::LogError, logs: &[PathBuf], axis: Option<&Path>) -> String {
    if let Some(settled) = error.settled_by_line() {
        let file = axis.map_or_else(
            || {
                let log = error.file.as_deref().unwrap_or(Path::new("log"));
                stiction::commands::text::axis_file(&path_text(log))
            },
            typed,
        );
        let line = match settled {
            Settled::InText => "[text] and that line",
            Settled::Elsewhere => "that line",
        };
        return after(
            &format!("with {line} in {file}:"),
            &format!("{} --axis {file}", check(logs, None)),
        );
    }
    after("once the file is mended:", &check(logs, axis))
}

/// The log that an error begins with, and else the first.
fn faulty<'a>(logs: &'a [PathBuf], error: &Error) -> Option<&'a PathBuf> {
    let message = wording::message(error);
    let faulty = |log: &&PathBuf| begins_with(&message, log);
    logs.iter().find(faulty).or(logs.first())
}

/// Whether a message is about a file.
fn begins_with(message: &str, file: &Path) -> bool {
    let begins = |path: String| message.starts_with(&format!("{path}:"));
    begins(file.display().to_string()) || begins(path_text(file))
}

fn is_search(typed: arguments::Method) -> bool {
    matches!(method(typed), Method::Searched(_))
}

/// Samples of a log with which a simulation goes on for any law: ten for each of thirty unknowns.
const ENOUGH_TO_SIMULATE: usize = 300;

/// What leads to enough samples: a setting of the axis file where that is what left them out, a simulation where filters did, and
/// else a look at the log.
fn more_samples(error: &Error, identify: &arguments::Identify) -> Option<String> {
    let Some((losses, needed)) = error.losses() else {
        return simulated(identify);
    };
    if let Some(axis) = &identify.axis {
        let file = typed(axis);
        let read = Axis::read(axis).ok();
        let decimate = read.as_ref().and_then(|axis| axis.conditioning.decimate);
        let motion = read.as_ref().and_then(|axis| axis.mapping.motion);
        let motion = motion.unwrap_or_else(|| crate::next::motion_of_min_speed(axis));
        if let Some(line) = stiction::commands::lowered(losses, needed, decimate, motion) {
            let key = line.split(' ').next().unwrap_or_default();
            return Some(after(
                &format!(
                    "in {file}, under [conditioning], in place of the line {key} write {line}, or leave it out, then"
                ),
                &crate::next::again(),
            ));
        }
    }
    if let Some(axis) = &identify.axis
        && Axis::read(axis).is_ok_and(|axis| axis.mapping.force_limit.is_some())
        && losses.excluded * losses.decimate.max(1) > losses.logged / 2
    {
        return Some(after(
            &format!(
                "raise force_limit in [log] of {}, or leave it out: samples at or above it are saturated and not fitted; then",
                typed(axis)
            ),
            &crate::next::again(),
        ));
    }
    // A simulation drops the stretches between gaps that are too short, as filters do.
    let is_long = losses.left_to_simulate() >= ENOUGH_TO_SIMULATE.max(needed);
    simulated(identify).filter(|_| is_long).or_else(|| {
        let what = "what the log shows, and what motion to record instead:";
        Some(looked_at(&identify.logs, identify, what))
    })
}

/// The command that shows what logs hold, and what for.
fn looked_at(logs: &[PathBuf], identify: &arguments::Identify, what: &str) -> String {
    after(what, &check(logs, identify.axis.as_deref()))
}

/// What to look at where nothing moves, or nothing is pushed.
fn still(error: &Error, identify: &arguments::Identify) -> String {
    let rough = identify.axis.as_deref().filter(|file| {
        error.code() == Code::NoMotion
            && Axis::read(file).is_ok_and(|axis| axis.mapping.resolution.is_some())
    });
    let rough = rough.map_or(String::new(), |file| {
        format!(
            "leave resolution out of [log] of {} unless it is one encoder count: what moves by less does not move; ",
            typed(file)
        )
    });
    let first = &identify.logs[..identify.logs.len().min(1)];
    let what = format!("{rough}what was read as position and force:");
    looked_at(first, identify, &what)
}

/// The command that looks at logs.
fn check(logs: &[PathBuf], axis: Option<&Path>) -> String {
    let logs = logs.iter().map(|log| format!(" {}", typed(log)));
    let axis = axis.map(|file| format!(" --axis {}", typed(file)));
    format!("stiction check{}", logs.chain(axis).collect::<String>())
}

/// The same identification by simulation, which filters nothing and needs fewer samples; for a law that can be simulated.
fn simulated(identify: &arguments::Identify) -> Option<String> {
    let from_force = identify.method == arguments::Method::Separable;
    let has_mass = identify
        .axis
        .as_ref()
        .is_none_or(|file| Axis::read(file).is_ok_and(|axis| axis.has_inertia()));
    let is_simulated = identify.law != arguments::Law::ElastoPlastic;
    let again = || again(identify, " --method output-error", &identify.out);
    (from_force && has_mass && is_simulated).then(again)
}

/// The same identification by another method, given as an option.
fn again(identify: &arguments::Identify, method: &str, dir: &Path) -> String {
    // By simulation auto is LuGre.
    let law = Some(identify.law).filter(|law| *law != arguments::Law::Auto);
    let law = law.and_then(|law| law.to_possible_value());
    let law = law.map_or(String::new(), |law| format!(" --law {}", law.get_name()));
    let mut out = String::from("next: stiction identify");
    let files = |out: &mut String, paths: &[PathBuf]| {
        for path in paths {
            out.push_str(&format!(" {}", typed(path)));
        }
    };
    files(&mut out, &identify.logs);
    if let Some(axis) = &identify.axis {
        out.push_str(&format!(" --axis {}", typed(axis)));
    }
    out.push_str(&law);
    if identify.asymmetric {
        out.push_str(" --asymmetric");
    }
    out.push_str(method);
    for (option, paths) in [
        ("--validate", &identify.validate),
        ("--break-away", &identify.break_away),
    ] {
        if !paths.is_empty() {
            out.push_str(&format!(" {option}"));
            files(&mut out, paths);
        }
    }
    if let Some(part) = identify.split {
        out.push_str(&format!(" --split {}", full(part)));
    }
    out.push_str(&format!(" --out {}", typed(dir)));
    out
}

/// A path as it is typed.
fn typed(path: &Path) -> String {
    quoted_path(path)
}
