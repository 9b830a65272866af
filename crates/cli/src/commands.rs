//! One file a command: arguments to a workflow, its outcome to the terminal and to disk.

mod batch;
mod check;
mod compare;
mod demo;
mod drift;
mod export;
mod identify;
mod library;
mod plan;
mod record;
mod reproduce;
mod robot;
mod simulate;
#[cfg(feature = "studio")]
mod studio;

use crate::arguments::{self, Arguments, Command, Common};
use crate::brought;
use crate::exit::Exit;
use crate::interrupt;
use crate::output;
use crate::progress::{self};
use crate::typed::Typed;
use crate::{next, wording, words};
use clap::ValueEnum;
use std::io::Write;
use std::path::{Path, PathBuf};
use stiction_files::result::Action;
use stiction_files::shell::text as path_text;
use stiction_files::{Bundle, Error as FileError};
use stiction_pages::bundle;
use stiction_parameters::LawKind;
use stiction_workflows::Error;
use stiction_workflows::identify::Method;
use stiction_workflows::identify::Outcome;

/// Runs a command; every error is printed here, once.
pub fn run(arguments: &Arguments) -> Exit {
    interrupt::listen();
    if let Some(threads) = arguments.common.threads.or_else(threads_of_too_many) {
        stiction_workflows::set_threads(usize::from(threads));
    }
    let common = &arguments.common;
    if let Some(bytes) = common.max_memory {
        stiction_formats::allow_memory(bytes);
    }
    // Logs of a batch are read all the time; how many are done is what is told of it.
    if !matches!(arguments.command, Command::Batch(_)) {
        progress::watch_readings(common.json || common.quiet);
    }
    let result = match &arguments.command {
        Command::Demo(typed) => demo::run(typed, common),
        Command::Record(typed) => record::run(typed, common),
        Command::Check(typed) => check::run(typed, common),
        Command::Identify(typed) => identify::run(typed, common),
        Command::Robot(typed) => robot::run(typed, common),
        Command::Batch(typed) => batch::run(typed, common),
        Command::Drift(typed) => drift::run(typed, common),
        Command::Plan(typed) => plan::run(typed, common),
        Command::Compare(typed) => compare::run(typed, common),
        Command::Simulate(typed) => simulate::run(typed, common),
        Command::Reproduce(typed) => reproduce::run(typed, common),
        Command::Export(typed) => export::run(typed, common),
        Command::Library(typed) => library::run(typed, common),
        #[cfg(feature = "studio")]
        Command::Studio(typed) => studio::run(typed, common),
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
            plan::limits(&e, plan);
        }
        if let Some(next) = next::of(&e, &arguments.command) {
            output::complain(&next);
        }
        if common.json {
            let error = serde_json::json!({ "error": { "code": e.code(), "message": message } });
            // The same was said on standard error; there is nowhere else to complain.
            let _ = output::json(&error);
        }
        Exit::BadInput
    })
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

/// As many threads as there are cores where the environment asks for more than `--threads` takes.
fn threads_of_too_many() -> Option<u16> {
    /// The most that `--threads` takes.
    const MOST: usize = 1024;
    let asked: usize = std::env::var("RAYON_NUM_THREADS").ok()?.parse().ok()?;
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    (asked > MOST).then(|| u16::try_from(cores.min(MOST)).unwrap_or(1))
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

/// The law under the name that it has on the command line; none where the data choose it.
pub fn law(typed: arguments::Law) -> Option<LawKind> {
    let name = typed.to_possible_value()?;
    LawKind::from_name(name.get_name())
}

/// The method under the name that it has on the command line.
pub fn method(typed: arguments::Method) -> Method {
    let name = typed.to_possible_value().expect("no method is hidden");
    Method::from_name(name.get_name()).expect("the engine knows every method of the command line")
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
    let (dir, written) = put(&bundle, dir, stiction_files::result::SCHEMA)?;
    let dir = dir.as_path();
    if common.json {
        output::json(&outcome.result)?;
    } else if !common.quiet {
        let text = match common.verbose {
            true => stiction_pages::text::outcome(outcome),
            false => stiction_pages::text::brief(outcome),
        };
        let next = match &outcome.result.trust.next {
            next @ (Action::Again | Action::Finish) => {
                let arguments = words::typed();
                let arguments = arguments.map(|a| path_text(Path::new(&a)));
                let kept = arguments.filter(|a| *next == Action::Again || a != "--no-finish");
                let command = stiction_pages::text::command(going_on(next, kept).into_iter());
                let why = stiction_pages::text::why(next);
                format!("{why}\nnext: {command}\n")
            }
            _ => {
                let is_study = |path: &&PathBuf| path.ends_with("study.toml");
                let study = written.iter().find(is_study).map(PathBuf::as_path);
                match common.verbose {
                    true => stiction_pages::text::next(&outcome.result, dir, study),
                    false => stiction_pages::text::next_in_short(&outcome.result, dir, study),
                }
            }
        };
        let files = written_to(dir, &written);
        let files = match common.verbose {
            true => format!("\n{files}"),
            false => format!("{} (in full: --verbose)\n", files.trim_end()),
        };
        output::print(&format!("{text}{files}{next}"))?;
    }
    // An interrupt may also have come while laws were compared, after the search had converged.
    if interrupt::stopped() {
        return Ok(Exit::Interrupted);
    }
    Ok(outcome.verdict().into())
}

/// The same arguments, from the state that was kept where a search was stopped.
fn going_on(next: &Action, arguments: impl Iterator<Item = String>) -> Vec<String> {
    let mut all: Vec<String> = arguments.collect();
    if *next == Action::Again
        && let Some(typed) = Typed::new()
        && typed.values("resume").is_empty()
        && let Some(kept) = typed.values("checkpoint").first()
    {
        all.extend(["--resume".to_string(), path_text(Path::new(kept))]);
    }
    all
}

/// The line that says which files are where.
pub fn written_to(dir: &Path, written: &[PathBuf]) -> String {
    let names: Vec<_> = written
        .iter()
        .filter_map(|p| p.file_name().map(|n| n.to_string_lossy().into_owned()))
        .collect();
    let dir = stiction_files::shell::shown(&path_text(dir));
    format!("written to {dir}: {}\n", names.join(", "))
}
