//! One function a command: arguments to a workflow, its outcome to the terminal and to disk.

use crate::arguments::{self, Arguments, Command, Common};
use crate::batch;
use crate::brought;
use crate::drift;
use crate::exit::Exit;
use crate::interrupt;
use crate::large;
use crate::output;
use crate::progress::{self, Bar};
use crate::wording;
use clap::ValueEnum;
use std::io::Write;
use std::path::{Path, PathBuf};
use stiction::commands::Settled;
use stiction::commands::number::full;
use stiction::commands::reproduce::{Budget, OwnAxis, canudas_1995, zhang_2025, zhang_2025_on};
use stiction::commands::shell::{quoted, quoted_path, text as path_text};
use stiction::commands::{
    Bundle, Carrier, CompareOptions, Comparison, Cost, Excitation, ExportedC, FileError, Files,
    Input, Kept, Known, Outcome, PlanOptions, Scheme, Want, check_apart, check_folder,
    check_folder_of, check_inputs, compare_exported, compare_file, limits_to_fill_in, plan_motion,
    visible, write_atomic,
};
use stiction::result::Next;
use stiction::{
    Axis, Code, CostKind, Error, ExportOptions, Feedforward, LawKind, Method, Options, Procedures,
    Searching, Study, Target, bundle,
};

/// Runs a command; every error is printed here, once.
pub fn run(arguments: &Arguments) -> Exit {
    interrupt::listen();
    if let Some(threads) = arguments.common.threads {
        stiction::set_threads(usize::from(threads));
    }
    let common = &arguments.common;
    if let Some(bytes) = common.max_memory {
        stiction::allow_memory(bytes);
    }
    // Logs of a batch are read all the time; how many are done is what is told of it.
    if !matches!(arguments.command, Command::Batch(_)) {
        progress::watch_readings(common.json || common.quiet);
    }
    let result = match &arguments.command {
        Command::Demo(demo) => self::demo(demo, common),
        Command::Check(check) => self::check(check, common),
        Command::Identify(identify) => self::identify(identify, common),
        Command::Batch(typed) => batch::run(typed, common),
        Command::Drift(typed) => drift::run(typed, common),
        Command::Plan(plan) => self::plan(plan, common),
        Command::Compare(compare) => self::compare(compare, common),
        Command::Simulate(simulate) => self::simulate(simulate, common),
        Command::Reproduce(reproduce) => self::reproduce(reproduce, common),
        Command::Export(export) => self::export(export, common),
        #[cfg(feature = "studio")]
        Command::Studio(typed) => crate::studio::run(typed, common),
        Command::Completions(wanted) => text(&brought::completions(wanted.shell), common),
        Command::Man(wanted) => text(&brought::manual(wanted.command.as_deref()), common),
    };
    result.unwrap_or_else(|e| {
        // With standard error closed only the exit code is left to tell.
        let message = wording::message(&e);
        for (code, line) in wording::lines(&e) {
            let line = output::line(&line);
            let _ = writeln!(std::io::stderr(), "stiction: [{code}] {line}");
        }
        if let Command::Plan(plan) = &arguments.command {
            limits(&e, plan);
        }
        let next = next(&e, &arguments.command)
            .or_else(|| crate::next::corrected(&e))
            .or_else(|| crate::next::not_regular(&e));
        if let Some(next) = next {
            // As above.
            let _ = writeln!(std::io::stderr(), "stiction: {}", output::line(&next));
        }
        if common.json {
            let error = serde_json::json!({ "error": { "code": e.code(), "message": message } });
            // The same was said on standard error; there is nowhere else to complain.
            let _ = output::json(&error);
        }
        Exit::BadInput
    })
}

/// Writes the lines of `[limits]` that an axis file lacks for a plan, as they are pasted.
fn limits(error: &Error, plan: &arguments::Plan) {
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
fn next(error: &Error, command: &Command) -> Option<String> {
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
    if let Command::Identify(identify) = command
        && error.code() == Code::TooFewSamples
    {
        return more_samples(error, identify);
    }
    if let Command::Identify(identify) = command
        && matches!(error.code(), Code::NoMotion | Code::NoForce)
    {
        let axis = identify.axis.iter();
        let axis = axis.map(|file| format!(" --axis {}", typed(file)));
        let log = identify.logs.first();
        let log = log.map_or(String::new(), |log| format!(" {}", typed(log)));
        let rough = identify.axis.iter().find(|file| {
            error.code() == Code::NoMotion
                && Axis::read(file).is_ok_and(|axis| axis.mapping.resolution.is_some())
        });
        let rough = rough.map(|file| {
            format!(
                "leave resolution out of [log] of {} unless it is one encoder count: what moves by less does not move. ",
                typed(file)
            )
        });
        return Some(format!(
            "next: {}stiction check{log}{} shows what was read as position and force",
            rough.unwrap_or_default(),
            axis.collect::<String>()
        ));
    }
    if let Command::Identify(identify) = command
        && error.code() == Code::BadRecord
    {
        let log = faulty(&identify.logs, error);
        return log.map(|log| {
            looked_at(
                std::slice::from_ref(log),
                identify,
                "shows which channels it has: logs that are fitted together have the same",
            )
        });
    }
    if let Command::Identify(identify) = command
        && error.code() == Code::Usage
        && law(identify.law).is_some_and(LawKind::needs_no_search)
        && is_search(identify.method)
    {
        return Some(again(identify, "", &identify.out));
    }
    if let Command::Identify(identify) = command
        && error.code() == Code::NoStep
    {
        return Some(shown(
            identify,
            "shows how the force runs, and what else the log is good for",
        ));
    }
    if let Command::Identify(identify) = command
        && error.code() == Code::NoBreakAway
    {
        return Some(looked_at(
            &identify.break_away,
            identify,
            "shows what the log is good for; what to record instead: docs/procedures.md",
        ));
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
            .or_else(|| crate::next::none_identified(error, &drift.results));
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
    let (logs, axis) = match command {
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
        && (e.place.row.is_some() || is_read(error) || e.settled_by_line().is_some())
    {
        return Some(unread(e, logs, axis.as_deref()));
    }
    if let Some(axis) = axis
        .as_deref()
        .filter(|_| unclear && crate::next::corrected(error).is_none())
    {
        return Some(format!(
            "next, with {} in {}: {}",
            match wording::lines(error).len() {
                1 => "that line",
                _ => "those lines",
            },
            typed(axis),
            crate::next::again()
        ));
    }
    let log = faulty(logs, error).filter(|_| unclear && axis.is_none())?;
    Some(crate::next::begun(log))
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
    let mut check = String::from("stiction check");
    for log in logs {
        check.push_str(&format!(" {}", typed(log)));
    }
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
        return format!("next, with {line} in {file}: {check} --axis {file}");
    }
    if let Some(axis) = axis {
        check.push_str(&format!(" --axis {}", typed(axis)));
    }
    format!("next, once the file is mended: {check}")
}

/// The log that an error begins with, and else the first.
fn faulty<'a>(logs: &'a [PathBuf], error: &Error) -> Option<&'a PathBuf> {
    let message = wording::message(error);
    let begins = |path: String| message.starts_with(&format!("{path}:"));
    let faulty = |log: &&PathBuf| begins(log.display().to_string()) || begins(path_text(log));
    logs.iter().find(faulty).or(logs.first())
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
            return Some(format!(
                "next: in {file}, under [conditioning], in place of the line {key} write {line}, or leave it out, then: {}",
                crate::next::again()
            ));
        }
    }
    if let Some(axis) = &identify.axis
        && Axis::read(axis).is_ok_and(|axis| axis.mapping.force_limit.is_some())
        && losses.excluded * losses.decimate.max(1) > losses.logged / 2
    {
        return Some(format!(
            "next: raise force_limit in [log] of {}, or leave it out: samples at or above it are saturated and not fitted",
            typed(axis)
        ));
    }
    // A simulation drops the stretches between gaps that are too short, as filters do.
    let is_long = losses.left_to_simulate() >= ENOUGH_TO_SIMULATE.max(needed);
    simulated(identify).filter(|_| is_long).or_else(|| {
        Some(shown(
            identify,
            "says what the log shows, and what motion to record instead",
        ))
    })
}

/// The command that shows what the logs hold, and what for.
fn shown(identify: &arguments::Identify, what: &str) -> String {
    looked_at(&identify.logs, identify, what)
}

/// The same of some of its logs.
fn looked_at(logs: &[PathBuf], identify: &arguments::Identify, what: &str) -> String {
    let mut next = String::from("next: stiction check");
    for log in logs {
        next.push_str(&format!(" {}", typed(log)));
    }
    if let Some(axis) = &identify.axis {
        next.push_str(&format!(" --axis {}", typed(axis)));
    }
    format!("{next} {what}")
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
    let law = match identify.law {
        // By simulation auto is LuGre.
        arguments::Law::Auto => "",
        arguments::Law::Lugre => " --law lugre",
        arguments::Law::CoulombViscous => " --law coulomb-viscous",
        arguments::Law::Stribeck => " --law stribeck",
        arguments::Law::Dahl => " --law dahl",
        arguments::Law::MaxwellSlip => " --law maxwell-slip",
        arguments::Law::Gms => " --law gms",
        arguments::Law::ElastoPlastic => " --law elasto-plastic",
    };
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
    out.push_str(law);
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

/// Prints a text that is asked for itself.
fn text(text: &str, common: &Common) -> Result<Exit, Error> {
    if common.json {
        output::json(&serde_json::json!({ "text": text }))?;
    } else {
        output::print_as_it_is(text)?;
    }
    Ok(Exit::Done)
}

fn demo(demo: &arguments::Demo, common: &Common) -> Result<Exit, Error> {
    check_folder(&demo.out, demo.force)?;
    if demo.procedures {
        return procedure_logs(demo, common);
    }
    if let Some(plan) = &demo.plan {
        return planned_log(plan, demo, common);
    }
    let mut bar = Bar::new(common.json || common.quiet);
    let done = stiction::demo::demo(&demo.out, demo.seed, &mut bar);
    bar.finish();
    let (outcome, kept) = done?;
    say_kept(kept);
    finish(&outcome, &demo.out, common)
}

/// Says which files that the demo did not write are kept.
fn say_kept(kept: impl IntoIterator<Item = Kept>) {
    for (from, to) in kept {
        let (from, to) = (from.display(), to.display());
        let line = format!("{from} is not what is written now: it is kept as {to}");
        // With standard error closed there is nowhere to say it.
        let _ = writeln!(std::io::stderr(), "stiction: {}", output::line(&line));
    }
}

fn planned_log(plan: &Path, demo: &arguments::Demo, common: &Common) -> Result<Exit, Error> {
    let (log, kept) = stiction::demo::planned(plan, &demo.out, demo.seed)?;
    say_kept(kept);
    if common.json {
        output::json(&serde_json::json!({ "written": [log.to_string_lossy()] }))?;
    } else if !common.quiet {
        let truth = stiction::demo::truth_of_demo();
        output::print(&stiction::commands::text::planned_log(plan, &log, &truth))?;
    }
    Ok(Exit::Done)
}

fn procedure_logs(demo: &arguments::Demo, common: &Common) -> Result<Exit, Error> {
    let (written, kept) = stiction::demo::procedures(&demo.out, demo.seed)?;
    say_kept(kept);
    if common.json {
        let paths: Vec<_> = written.iter().map(|p| p.to_string_lossy()).collect();
        output::json(&serde_json::json!({ "written": paths }))?;
    } else if !common.quiet {
        output::print(&stiction::commands::text::procedure_commands(
            &demo.out,
            &written,
            &stiction::demo::truth_of_demo(),
        ))?;
    }
    Ok(Exit::Done)
}

fn check(check: &arguments::Check, common: &Common) -> Result<Exit, Error> {
    if let Some(file) = &check.init {
        return init(check, file, common);
    }
    interrupt::nothing_to_keep();
    let mut bar = Bar::new(common.json || common.quiet);
    let found = stiction::commands::check::check(&check.logs, check.axis.as_deref(), &mut bar);
    bar.finish();
    let found = found?;
    if common.json {
        output::json(&found)?;
    } else if !common.quiet {
        output::print(&stiction::commands::text::check(&found))?;
    }
    Ok(found.verdict().into())
}

/// Whether there is no file to begin yet.
fn is_new(file: &Path) -> Result<(), FileError> {
    // A dangling link is something too, and renaming onto it would replace it.
    if file.symlink_metadata().is_ok() {
        let reason = "exists already and is kept; name another file: --init OTHER.toml";
        return Err(FileError::output(file, reason));
    }
    Ok(())
}

fn init(check: &arguments::Check, file: &Path, common: &Common) -> Result<Exit, Error> {
    is_new(file)?;
    let listed = match (check.logs.first(), &check.axis) {
        (None, Some(axis)) => Axis::read(axis)?.logs.first().map(|log| log.file.clone()),
        (log, _) => log.cloned(),
    };
    let Some(log) = &listed else {
        let reason = "needs a log, here or under [[log]] of the axis file";
        return Err(FileError::output(file, reason).into());
    };
    let started = stiction::commands::check::init(log, check.axis.as_deref())?;
    let mut logs: Vec<&Path> = check.logs.iter().map(PathBuf::as_path).collect();
    if logs.is_empty() {
        logs.push(log);
    }
    write_atomic(file, visible::toml(started.text.clone()).as_bytes())?;
    if common.json {
        output::json(&serde_json::json!({
            "written": file.to_string_lossy(),
            "changes": started.changes,
            "undecided": started.undecided,
        }))?;
    } else if !common.quiet {
        output::print(&stiction::commands::text::started(&started, &logs, file))?;
    }
    Ok(Exit::Done)
}

fn identify(identify: &arguments::Identify, common: &Common) -> Result<Exit, Error> {
    check_folder(&identify.out, identify.force)?;
    let inputs = [
        &identify.logs,
        &identify.validate,
        &identify.statics,
        &identify.break_away,
    ];
    let axis = identify
        .axis
        .as_ref()
        .and_then(|axis| Axis::read(axis).ok());
    let listed = axis.iter().flat_map(|axis| &axis.logs).map(|log| &log.file);
    let files = inputs.into_iter().flatten().chain(listed);
    check_inputs(
        &identify.out,
        files
            .chain(&identify.model)
            .chain(&identify.plan)
            .chain(&identify.axis)
            .chain(&identify.searching.resume),
    )?;
    if let Some(checkpoint) = &identify.searching.checkpoint {
        check_apart(&identify.out, checkpoint)?;
    }
    let files = Files {
        logs: identify.logs.clone(),
        axis: identify.axis.clone(),
        validate: identify.validate.clone(),
    };
    let mut options = Options::default();
    options.law = law(identify.law);
    options.asymmetric = identify.asymmetric;
    options.split = identify.split;
    options.seed = identify.seed;
    options.procedures = Procedures {
        method: method(identify.method),
        statics: identify.statics.clone(),
        model: identify.model.clone(),
        break_away: identify.break_away.clone(),
        plan: identify.plan.clone(),
    };
    options.searching = searching(&identify.searching);
    let mut bar = Bar::new(common.json || common.quiet);
    let outcome = stiction::commands::identify(&files, &options, &mut bar);
    bar.finish();
    finish(&outcome?, &identify.out, common)
}

fn compare(compare: &arguments::Compare, common: &Common) -> Result<Exit, Error> {
    check_folder_of(&compare.out, compare_file::SCHEMA, compare.force)?;
    check_inputs(&compare.out, compare.logs.iter().chain(&compare.axis))?;
    let options = CompareOptions {
        input: match &compare.problem {
            Some(name) => Input::Named(name.clone()),
            None => Input::Log {
                logs: compare.logs.clone(),
            },
        },
        axis: compare.axis.clone(),
        methods: compare.methods.clone(),
        seeds: compare.seeds,
        evaluations: compare.evaluations,
        noise: compare.noise,
        excitation: compare.excitation.map(|motion| match motion {
            arguments::Excitation::Sine => Excitation::Sine,
            arguments::Excitation::MultiSine => Excitation::MultiSine,
            arguments::Excitation::ThreeSegments => Excitation::ThreeSegments,
            arguments::Excitation::BreakAway => Excitation::BreakAway,
        }),
        rate: compare.rate,
        other_law: compare.other_law,
        decades: compare.decades,
        integrator: match compare.integrator {
            arguments::Integrator::Explin => Scheme::Explin,
            arguments::Integrator::Euler => Scheme::Euler,
            arguments::Integrator::Rk4 => Scheme::RungeKutta,
        },
        cost: compare.cost.map(|cost| match cost {
            arguments::CompareCost::Six => Cost::Six,
            arguments::CompareCost::Separable => Cost::Separable,
            arguments::CompareCost::Position => Cost::Position,
        }),
        max_samples: compare.max_samples,
    };
    let mut bar = Bar::new(common.json || common.quiet);
    let comparison = Comparison::new(&options, &mut bar)?;
    large::announce(
        stiction::commands::text::announced_comparison(comparison.size()),
        common,
    );
    let runs = large::keeping(&compare.out, compare.resume, |dir, resume| {
        comparison.keep(dir, resume)
    })?;
    let found = comparison.run_keeping(&runs, &mut bar);
    bar.finish();
    let found = found?;
    let bundle = bundle::comparison(&found);
    let (out, _) = put(&bundle, &compare.out, compare_file::SCHEMA)?;
    large::kept(runs, found.status == "done");
    if common.json {
        output::json(&found)?;
    } else if !common.quiet {
        output::print(&format!(
            "{}\nwritten to {}: report.html, compare.json\n",
            stiction::commands::text::comparison(&found),
            out.display()
        ))?;
    }
    Ok(stiction::commands::verdict::of_comparison(&found).into())
}

/// The law under the name that it has on the command line; none where the data choose it.
pub fn law(typed: arguments::Law) -> Option<LawKind> {
    match typed {
        arguments::Law::Auto => None,
        arguments::Law::CoulombViscous => Some(LawKind::CoulombViscous),
        arguments::Law::Stribeck => Some(LawKind::Stribeck),
        arguments::Law::Dahl => Some(LawKind::Dahl),
        arguments::Law::Lugre => Some(LawKind::LuGre),
        arguments::Law::ElastoPlastic => Some(LawKind::ElastoPlastic),
        arguments::Law::MaxwellSlip => Some(LawKind::MaxwellSlip),
        arguments::Law::Gms => Some(LawKind::Gms),
    }
}

/// The method under the name that it has on the command line.
pub fn method(typed: arguments::Method) -> Method {
    let name = typed.to_possible_value().expect("no method is hidden");
    Method::from_name(name.get_name()).expect("the engine knows every method of the command line")
}

fn searching(typed: &arguments::Searching) -> Searching {
    let names = Method::SEARCHES;
    let name = |search: &String| names.into_iter().find(|name| name == search);
    Searching {
        search: typed.search.as_ref().and_then(name),
        no_finish: typed.no_finish,
        cost: typed.cost.map(|cost| match cost {
            arguments::Cost::Six => CostKind::Six,
            arguments::Cost::Separable => CostKind::Separable,
        }),
        evaluations: typed.evaluations,
        target: typed.target,
        time: typed.time,
        checkpoint: typed.checkpoint.clone(),
        resume: typed.resume.clone(),
    }
}

/// Writes files into a folder, or beside it where they are of an outcome that was stopped early and a complete one is there; says
/// what is kept. The folder, and what was written.
pub fn put(bundle: &Bundle, dir: &Path, schema: &str) -> Result<(PathBuf, Vec<PathBuf>), Error> {
    let beside = bundle::beside_complete(bundle, dir, schema, interrupt::stopped());
    let out = beside.as_deref().unwrap_or(dir);
    let kept = bundle.kept(out);
    let written = bundle.write(out)?;
    let mut lines = Vec::new();
    if beside.is_some() {
        lines.push(format!(
            "{} holds a complete result and is kept; what was found before the stop is in {}",
            dir.display(),
            out.display()
        ));
    }
    lines.extend(kept.iter().map(|(from, to)| {
        let why = match written.contains(from) {
            true if to.is_symlink() => "is a link, and a file of this name is written",
            true => "was changed after it was written",
            false => "is of an earlier result, and this one has none",
        };
        format!("{} {why}: it is kept as {}", from.display(), to.display())
    }));
    for line in lines {
        // With standard error closed there is nowhere to say it.
        let _ = writeln!(std::io::stderr(), "stiction: {}", output::line(&line));
    }
    Ok((out.to_path_buf(), written))
}

/// Writes the files, says what was found, and what it is worth.
fn finish(outcome: &Outcome, dir: &Path, common: &Common) -> Result<Exit, Error> {
    let bundle = bundle::identification_in(outcome, dir);
    let (dir, written) = put(&bundle, dir, stiction::result::SCHEMA)?;
    let dir = dir.as_path();
    if common.json {
        output::json(&outcome.result)?;
    } else if !common.quiet {
        let text = stiction::commands::text::outcome(outcome);
        let next = match outcome.result.trust.next {
            next @ (Next::Again | Next::Finish) => {
                let arguments = std::env::args_os().skip(1);
                let arguments = arguments.map(|a| path_text(Path::new(&a)));
                let kept = arguments.filter(|a| next == Next::Again || a != "--no-finish");
                let command = stiction::commands::text::command(kept);
                let why = stiction::commands::text::why(next);
                format!("next: {why}\n  {command}\n")
            }
            _ => {
                let is_study = |path: &&PathBuf| path.ends_with("study.toml");
                let study = written.iter().find(is_study).map(PathBuf::as_path);
                stiction::commands::text::next(&outcome.result, dir, study)
            }
        };
        output::print(&format!("{text}\n{}{next}", written_to(dir, &written)))?;
    }
    // An interrupt may also have come while laws were compared, after the search had converged.
    if interrupt::stopped() {
        return Ok(Exit::Interrupted);
    }
    Ok(outcome.verdict().into())
}

fn plan(plan: &arguments::Plan, common: &Common) -> Result<Exit, Error> {
    let schema = stiction::commands::plan::SCHEMA;
    check_folder_of(&plan.out, schema, plan.force)?;
    let files = [Some(&plan.axis), plan.model.as_ref(), plan.log.as_ref()];
    check_inputs(&plan.out, files.into_iter().flatten())?;
    let model = plan.model.clone().map(Known::Model);
    let options = PlanOptions {
        time: plan.time,
        probe: plan.stage == arguments::Stage::Probe,
        asymmetric: plan.asymmetric,
        law: plan.law.map(|law| match law {
            arguments::PlannedLaw::Lugre => LawKind::LuGre,
            arguments::PlannedLaw::MaxwellSlip => LawKind::MaxwellSlip,
            arguments::PlannedLaw::Gms => LawKind::Gms,
        }),
        known: model.or(plan.log.clone().map(Known::Log)),
        seed: plan.seed,
        wants: (plan.wants.iter())
            .map(|text| Want::parse(text))
            .collect::<Result<_, _>>()?,
        carriers: plan.formats.iter().copied().map(carrier).collect(),
        start: plan.start.clone(),
    };
    let mut bar = Bar::new(common.json || common.quiet);
    let planned = plan_motion(&plan.axis, &options, &mut bar);
    bar.finish();
    let Some(planned) = planned? else {
        // With standard error closed there is nowhere to say it.
        let _ = writeln!(
            std::io::stderr(),
            "stiction: stopped before there was a motion; nothing is written"
        );
        return Ok(Exit::Interrupted);
    };
    let (dir, written) = put(&bundle::plan(&planned), &plan.out, schema)?;
    if common.json {
        output::json(&planned.file)?;
    } else if !common.quiet {
        let text = stiction::commands::text::planned(&planned, &plan.axis, &dir);
        output::print(&format!("{text}\n{}", written_to(&dir, &written)))?;
    }
    match interrupt::stopped() {
        true => Ok(Exit::Interrupted),
        false => Ok(planned.verdict().into()),
    }
}

fn carrier(form: arguments::Form) -> Carrier {
    match form {
        arguments::Form::St => Carrier::St,
        arguments::Form::Cam => Carrier::Cam,
        arguments::Form::Feed => Carrier::Feed,
        arguments::Form::Csp => Carrier::Csp,
        arguments::Form::Ros2 => Carrier::Ros2,
        arguments::Form::Halstreamer => Carrier::Halstreamer,
        arguments::Form::Gcode => Carrier::Gcode,
    }
}

fn simulate(simulate: &arguments::Simulate, common: &Common) -> Result<Exit, Error> {
    // The arguments have both but for --init.
    let (Some(study), Some(dir)) = (&simulate.study, &simulate.out) else {
        let file = simulate.init.as_deref().unwrap_or(Path::new("study.toml"));
        let models = [&simulate.model, &simulate.second_model];
        return init_study(file, models.map(Option::as_deref), common);
    };
    check_folder_of(
        dir,
        stiction::commands::study::result::SCHEMA,
        simulate.force,
    )?;
    let study = Study::read_within(study, simulate.max_samples)?;
    let inputs: Vec<PathBuf> = study.inputs().map(PathBuf::from).collect();
    check_inputs(dir, &inputs)?;
    let exported = simulate.exported_c.as_deref();
    let exported = exported.map(|dir| ExportedC::open(dir, &study));
    let exported = exported.transpose()?;
    large::announce(stiction::commands::text::announced(&study), common);
    let runs = large::keeping(dir, simulate.resume, |dir, resume| {
        let exported = exported.as_ref();
        Ok(stiction::commands::keep(&study, exported, dir, resume)?)
    })?;
    let mut bar = Bar::new(common.json || common.quiet);
    let mut outcome = stiction::commands::simulate_keeping(&study, &runs, &mut bar);
    bar.finish();
    if let Some(exported) = exported.filter(|_| !interrupt::stops()) {
        compare_exported(&mut outcome, &study, &exported, &runs)?;
    }
    let schema = stiction::commands::study::result::SCHEMA;
    let (dir, written) = put(&bundle::study(&outcome), dir, schema)?;
    large::kept(runs, outcome.file.status == "complete");
    if common.json {
        output::json(&outcome.file)?;
    } else if !common.quiet {
        let text = stiction::commands::text::study(&outcome);
        output::print(&format!("{text}\n{}", written_to(&dir, &written)))?;
    }
    // Exported C may be what was left out.
    if interrupt::stopped() {
        return Ok(Exit::Interrupted);
    }
    Ok(outcome.verdict().into())
}

fn init_study(
    file: &Path,
    [model, second]: [Option<&Path>; 2],
    common: &Common,
) -> Result<Exit, Error> {
    is_new(file)?;
    let started = stiction::commands::study::start(model, second, file)?;
    write_atomic(file, visible::toml(started.text.clone()).as_bytes())?;
    if common.json {
        output::json(&serde_json::json!({
            "written": file.to_string_lossy(),
            "undecided": started.undecided,
        }))?;
    } else if !common.quiet {
        output::print(&stiction::commands::text::started_study(&started, file))?;
    }
    Ok(Exit::Done)
}

fn export(export: &arguments::Export, common: &Common) -> Result<Exit, Error> {
    let target = match export.target {
        arguments::Target::C => Target::C,
        arguments::Target::Cpp => Target::Cpp,
        arguments::Target::Ros2 => Target::Ros2,
        arguments::Target::St => Target::St,
        arguments::Target::Tcpou => Target::TcPou,
        arguments::Target::Plcopen => Target::PlcOpen,
        arguments::Target::Rust => Target::Rust,
        arguments::Target::Mujoco => Target::Mujoco,
        arguments::Target::Modelica => Target::Modelica,
        arguments::Target::Urdf => Target::Urdf,
        arguments::Target::Sdf => Target::Sdf,
        arguments::Target::Isaaclab => Target::IsaacLab,
        arguments::Target::Hal => Target::Hal,
        arguments::Target::Fmu => Target::Fmu,
        arguments::Target::Matlab => Target::Matlab,
        arguments::Target::Tf5200 => Target::Tf5200,
        arguments::Target::DriveTable => Target::DriveTable,
    };
    let mut options = ExportOptions::new(target, export.cycle_time);
    options.name.clone_from(&export.name);
    options.limit = export.limit;
    options.rated_force = export.rated_force;
    options.gain = export.gain;
    options.safety.ramp = export.ramp;
    options.safety.dead_zone = export.dead_zone;
    options.safety.slew = export.slew;
    options.safety.window = export.window;
    options.adapt = export.adapt;
    let parts = export.feedforward.iter().map(String::as_str);
    options.feedforward = Feedforward::from_names(parts).map_err(fed_line)?;
    let exported = stiction::export_file(&export.model, &options).map_err(fed_line)?;
    match export.force {
        true => exported.write_over(&export.out)?,
        false => exported.write(&export.out)?,
    }
    if common.json {
        output::json(&exported)?;
    } else if !common.quiet {
        output::print(&stiction::commands::text::exported(&exported, &export.out))?;
    }
    Ok(exported.verdict().into())
}

/// An error about what is fed forward, with the line that works.
fn fed_line(error: Error) -> Error {
    let Error::NotFed { found, instead } = error else {
        return error;
    };
    let parts = instead.join(",");
    let given = std::env::args_os().skip(1);
    let given: Vec<String> = given.map(|a| path_text(Path::new(&a))).collect();
    let mut line = vec!["stiction".to_string()];
    let mut rest = given.iter();
    while let Some(word) = rest.next() {
        if word == "--feedforward" {
            line.extend([word.clone(), parts.clone()]);
            rest.next();
        } else if word.starts_with("--feedforward=") {
            line.push(format!("--feedforward={parts}"));
        } else if word.starts_with('-') {
            line.push(word.clone());
        } else {
            line.push(quoted(word));
        }
    }
    Error::Usage {
        found: found.into(),
        allowed: format!("what works: {}", line.join(" ")).into(),
    }
}

fn reproduce(reproduce: &arguments::Reproduce, common: &Common) -> Result<Exit, Error> {
    let dir = &reproduce.out;
    check_folder_of(
        dir,
        stiction::commands::reproduce_file::SCHEMA,
        reproduce.force,
    )?;
    let inputs: Vec<PathBuf> = [&reproduce.model, &reproduce.axis]
        .into_iter()
        .flatten()
        .cloned()
        .collect();
    check_inputs(dir, &inputs)?;
    let mut bar = Bar::new(common.json || common.quiet);
    let budget = Budget::default();
    let outcome = match (reproduce.publication, &reproduce.model) {
        (arguments::Publication::Canudas1995, None) => canudas_1995(&mut bar),
        (arguments::Publication::Canudas1995, Some(_)) => {
            return Err(Error::Usage {
                found: "reproduce 1995 --model".into(),
                allowed: "reproduce paper --model: the experiments of 1995 are those of one block"
                    .into(),
            });
        }
        (arguments::Publication::Zhang2025, None) => zhang_2025(budget, &mut bar),
        (arguments::Publication::Zhang2025, Some(model)) => {
            let own = OwnAxis {
                axis: reproduce.axis.clone(),
                model: model.clone(),
            };
            zhang_2025_on(&own, budget, &mut bar)?
        }
    };
    bar.finish();
    let schema = stiction::commands::reproduce_file::SCHEMA;
    let (dir, written) = put(&bundle::reproduction(&outcome), dir, schema)?;
    if common.json {
        output::json(&outcome.file)?;
    } else if !common.quiet {
        let text = stiction::commands::text::reproduction(&outcome.file);
        output::print(&format!("{text}{}", written_to(&dir, &written)))?;
    }
    Ok(outcome.verdict().into())
}

/// The line that says which files are where.
pub fn written_to(dir: &Path, written: &[PathBuf]) -> String {
    let names: Vec<_> = written
        .iter()
        .filter_map(|p| p.file_name().map(|n| n.to_string_lossy().into_owned()))
        .collect();
    let dir = stiction::commands::shell::shown(&path_text(dir));
    format!("written to {dir}: {}\n", names.join(", "))
}
