//! What to type next where a file is not there, is another one, or cannot be written.

use crate::arguments::{Arguments, Identify, Target};
use crate::misplaced;
use crate::typed::Typed;
use crate::usage::with_value;
use clap::parser::ValueSource;
use clap::{CommandFactory, ValueEnum};
use std::path::{Path, PathBuf};
use stiction::commands::batch::read_results;
use stiction::commands::recording::Motion;
use stiction::commands::shell::{cycle_time, free_folder, quoted, quoted_path, text as path_text};
use stiction::commands::{
    FileError, Looks, Remedy, check_apart, has_runs, is_regular, looks, sha256,
};
use stiction::{Axis, Code, Error, ModelFile};

/// What is to be known or done first, on a line of its own, and a command alone behind `next:`, to be pasted as it stands.
pub fn after(first: &str, command: &str) -> String {
    format!("{first}\nnext: {command}")
}

/// The same of two commands.
pub fn either(first: &str, command: &str, second: &str, other: &str) -> String {
    format!("{}\n{}", after(first, command), after(second, other))
}

/// Two commands, one after the other.
pub fn in_turn(command: &str, then: &str) -> String {
    format!("next: {command}\nthen: {then}")
}

/// What leads on from an input that is not there: the same command with the file that was probably meant, or a look at the folder.
pub fn missing(error: &Error) -> Option<String> {
    let listed;
    let path = match error {
        Error::File(FileError::Misfit { file, code, .. }) if *code == Code::LogIo => {
            let axis = Axis::read(file).ok()?;
            let mut logs = axis.logs.into_iter().map(|log| log.file);
            listed = logs.find(|log| log.symlink_metadata().is_err())?;
            &listed
        }
        Error::File(FileError::Log(e)) if e.kind.code() == Code::LogIo => e.file.as_deref()?,
        Error::File(FileError::Config { file, .. }) => file,
        _ => return None,
    };
    not_there(path)
}

/// What leads on from a path at which there is nothing.
pub fn not_there(path: &Path) -> Option<String> {
    if path.as_os_str().is_empty() || path.symlink_metadata().is_ok() {
        return None;
    }
    let folder = folder(path);
    if let Some(meant) = meant(path, folder) {
        if !std::env::args_os().any(|argument| Path::new(&argument) == path) {
            return Some(after(
                &format!("was {} meant? Name it there, then", quoted_path(&meant)),
                &again(),
            ));
        }
        let arguments = with(path, &meant);
        let command = stiction::commands::text::command(arguments.into_iter());
        return Some(after("was another file meant?", &command));
    }
    shown(folder)
}

/// The command that shows what is in a folder, or in the nearest one above it that is there.
pub fn shown(folder: &Path) -> Option<String> {
    let there = folder.ancestors().map(or_here).find(|dir| dir.is_dir())?;
    Some(after(
        "which files there are:",
        &format!("ls {}", quoted_path(there)),
    ))
}

/// What leads on from a folder, or from what is no regular file, where a file is wanted.
pub fn no_file(error: &Error) -> Option<String> {
    let Error::File(FileError::Config { file, .. }) = error else {
        return None;
    };
    if file.is_file() || file.symlink_metadata().is_err() {
        return None;
    }
    if let Some(next) = for_axis(file) {
        return Some(next);
    }
    let takes = misplaced::typed().filter(|(_, files)| files.contains(file));
    takes
        .and_then(|(takes, _)| misplaced::inside(takes, file))
        .or_else(|| shown(file))
}

/// What leads on where the folder of a file that is to be written is not there.
pub fn no_folder(error: &Error) -> Option<String> {
    let Error::File(FileError::Output { path, .. }) = error else {
        return None;
    };
    let folder = folder(path);
    let is_missing = folder.symlink_metadata().is_err() && path.symlink_metadata().is_err();
    is_missing.then(|| format!("next: mkdir -p {} && {}", quoted_path(folder), again()))
}

/// What leads on from a batch of a folder that holds no logs, or the result of an earlier command.
pub fn no_logs(inputs: &[PathBuf]) -> Option<String> {
    let folder = inputs
        .iter()
        .find(|input| input.is_dir() && !has_logs(input, DEPTH))?;
    misplaced::inside(misplaced::Takes::Logs, folder)
}

/// Folders below each other in which logs are looked for.
const DEPTH: usize = 4;

/// Whether a folder that holds no result, or one below it, holds a recording.
fn has_logs(folder: &Path, depth: usize) -> bool {
    let holds_result = ["result.json", "batch.json", "study.json", "drift.json"];
    if holds_result.iter().any(|name| folder.join(name).is_file()) {
        return false;
    }
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let mut paths = entries.take(MOST_NAMES).flatten().map(|entry| entry.path());
    paths.any(|path| match path.is_dir() {
        true => depth > 0 && !path.is_symlink() && has_logs(&path, depth - 1),
        false => looks(&path) == Some(Looks::Log),
    })
}

/// What leads on from a table that a batch wrote where a log is wanted.
pub fn table_as_log(error: &Error) -> Option<String> {
    let Error::File(FileError::Log(e)) = error else {
        return None;
    };
    let is_table = |file: &&Path| file.extension().is_some_and(|end| end == "parquet");
    let file = e.file.as_deref().filter(is_table)?;
    stiction::commands::drift::drift(file, &[], Default::default()).ok()?;
    Some(after(
        "it is a table that stiction batch writes:",
        &format!("stiction drift {}", quoted_path(file)),
    ))
}

/// What leads on from a file that is something else than what is read: the same command with the one that is wanted, or what
/// makes one.
pub fn other_form(error: &Error) -> Option<String> {
    let Error::File(FileError::OtherForm { file, instead, .. }) = error else {
        return None;
    };
    let Some(instead) = instead else {
        if let Some(next) = for_axis(file) {
            return Some(next);
        }
        let (takes, typed) = misplaced::typed()?;
        let file = typed.iter().find(|typed| *typed == file)?;
        return match file.is_dir() {
            true => misplaced::inside(takes, file),
            false => misplaced::next(takes, file),
        };
    };
    let arguments = with(file, instead);
    Some(format!(
        "next: {}",
        stiction::commands::text::command(arguments.into_iter())
    ))
}

/// What makes an axis file where one is given to `--axis` that is none.
fn for_axis(file: &Path) -> Option<String> {
    let given = Typed::new()?
        .values("axis")
        .iter()
        .any(|axis| axis == file.as_os_str());
    let (takes, typed) = misplaced::typed()?;
    let log = typed
        .first()
        .filter(|_| given && takes == misplaced::Takes::Logs)?;
    let log = path_text(log);
    let axis = stiction::commands::shell::new_axis_file(Path::new(&log));
    Some(after(
        "for an axis file of that log:",
        &format!("stiction check {} --init {axis}", quoted(&log)),
    ))
}

/// What leads on from a file whose content is refused: where to correct it, and the same command again.
pub fn corrected(error: &Error) -> Option<String> {
    let Error::File(error) = error else {
        return None;
    };
    let mut files: Vec<(&Path, Vec<usize>)> = Vec::new();
    for (file, line) in error.to_correct() {
        match files.iter_mut().find(|(known, _)| *known == file) {
            Some((_, lines)) => lines.extend(line),
            None => files.push((file, line.into_iter().collect())),
        }
    }
    // What cannot be read at all, or is no text, is not corrected in an editor.
    let is_typed = |file: &Path| {
        is_regular(file)
            && file.extension().is_none_or(|end| end != "parquet")
            && std::fs::File::open(file).is_ok()
    };
    if files.is_empty() || !files.iter().all(|(file, _)| is_typed(file)) {
        return None;
    }
    let places = files.into_iter().map(|(file, mut lines)| {
        lines.sort_unstable();
        lines.dedup();
        let numbers: Vec<String> = lines.iter().map(usize::to_string).collect();
        let place = match numbers.as_slice() {
            [] => String::new(),
            [one] => format!(" (line {one})"),
            [most @ .., last] => format!(" (lines {} and {last})", most.join(", ")),
        };
        format!("{}{place}", quoted_path(file))
    });
    let places: Vec<String> = places.collect();
    Some(after(
        &format!("correct {}, then", places.join(" and ")),
        &again(),
    ))
}

/// What leads on where there is a file already that an axis file was to be begun in: another name for it.
pub fn another_init(error: &Error, file: &Path, log: &Path) -> Option<String> {
    let Error::File(FileError::Output { path, .. }) = error else {
        return None;
    };
    if path != file || path.symlink_metadata().is_err() {
        return None;
    }
    let log_as_typed = quoted_path(log);
    let begun = format!(
        "stiction check {log_as_typed} --init {}",
        stiction::commands::shell::new_axis_file(log)
    );
    if Axis::read(file).is_err() {
        return Some(format!("next: {begun}"));
    }
    let own = format!("stiction check {log_as_typed} --axis {}", quoted_path(file));
    Some(either(
        "where that is the axis file of this log:",
        &own,
        "else:",
        &begun,
    ))
}

/// What leads on from a folder of logs, where one log is wanted: all of them, one by one.
pub fn many(error: &Error, logs: &[PathBuf]) -> Option<String> {
    let Error::File(FileError::Log(e)) = error else {
        return None;
    };
    let folder = e
        .file
        .as_deref()
        .filter(|file| file.is_dir() && logs.iter().any(|log| log == file))?;
    all_of(folder, logs)
}

/// The batch of all logs in a folder and the others that were typed beside it; where it holds none, what leads on from it.
fn all_of(folder: &Path, logs: &[PathBuf]) -> Option<String> {
    if !has_logs(folder, DEPTH) {
        return misplaced::inside(misplaced::Takes::Logs, folder);
    }
    // The options of one log that are also those of many.
    const SHARED: [&str; 8] = [
        "axis",
        "law",
        "method",
        "asymmetric",
        "split",
        "seed",
        "threads",
        "max-memory",
    ];
    let typed = Typed::new()?;
    let mut command = vec!["batch".to_string()];
    command.extend(logs.iter().map(|log| path_text(log)));
    command.extend(typed.again(&SHARED));
    let out = typed.again(&["out"]);
    match out.is_empty() {
        true => command.extend(["--out".to_string(), path_text(&beside(folder, "batch"))]),
        false => command.extend(out),
    }
    let command = stiction::commands::text::command(command.into_iter());
    Some(after("for every log of the folder:", &command))
}

/// What leads on from a folder without a table of results: one in a folder below it, else what makes one of the logs in it.
pub fn table(error: &Error, folder: &Path) -> Option<String> {
    if !folder.is_dir()
        || !matches!(error, Error::File(FileError::Config { file, .. }) if file == folder)
    {
        return None;
    }
    let entries = std::fs::read_dir(folder).ok()?.take(MOST_NAMES).flatten();
    let mut tables: Vec<PathBuf> = entries
        .map(|entry| entry.path().join("results.parquet"))
        .collect();
    tables.retain(|table| table.is_file());
    if let Some(table) = tables.iter().min() {
        return Some(format!("next: {}", in_place_of(folder, table)));
    }
    if !has_logs(folder, DEPTH) {
        return misplaced::inside(misplaced::Takes::Table, folder);
    }
    let out = beside(folder, "batch");
    let table = out.join("results.parquet");
    let [folder, out, table] = [folder, &out, &table].map(quoted_path);
    let batch = format!("stiction batch {folder} --law lugre --out {out}");
    let drift = format!("stiction drift {table}");
    Some(format!(
        "where it is a folder of logs:\n{}",
        in_turn(&batch, &drift)
    ))
}

/// What leads on from a table of which no log was identified: why the first one was not; and from a limit of another: one that is.
pub fn not_followed(error: &Error, table: &Path, has_limit: bool) -> Option<String> {
    if error.code() != Code::Usage || !table.is_file() {
        return None;
    }
    let mut first = None;
    let mut followed = None;
    read_results(table, |row| {
        let mut known = row.parameters.iter().filter(|p| p.identifiable);
        followed = followed.take().or_else(|| Some(known.next()?.name.clone()));
        first.get_or_insert(row);
        Ok(())
    })
    .ok()?;
    if let Some(parameter) = followed.filter(|_| has_limit) {
        // What is wrong is a limit that was typed.
        let limit = quoted(&format!("{parameter} > 1.3"));
        let table = quoted_path(table);
        let example = format!("stiction drift {table} --limit {limit}");
        return Some(after("as an example:", &example));
    }
    let row = first?;
    let axis = row
        .axis
        .map_or(String::new(), |axis| format!(" --axis {}", quoted(&axis)));
    Some(after(
        "what the first log shows:",
        &format!("stiction check {}{axis}", quoted(&row.path)),
    ))
}

/// A folder of this name beside another one.
fn beside(folder: &Path, name: &str) -> PathBuf {
    match folder.file_name() {
        Some(_) => folder.with_file_name(name),
        // `.` and `..` have none.
        None => PathBuf::from(name),
    }
}

/// The whole command, where nothing but the folder for what is written is missing.
fn without_out() -> Option<String> {
    let typed: Vec<_> = std::env::args_os().collect();
    let Typed { command: name, .. } = Typed::new()?;
    let (_, files) = misplaced::typed()?;
    let first = files.first()?;
    if first.is_dir() && matches!(name.as_str(), "check" | "identify") {
        return all_of(first, &files);
    }
    let out = match name.as_str() {
        "plan" | "batch" | "compare" => first.with_file_name(&name),
        _ => first.with_extension(""),
    };
    let out = match out == *first {
        true => first.with_file_name("result"),
        false => out,
    };
    let whole = typed
        .iter()
        .cloned()
        .chain(["--out".into(), out.clone().into_os_string()]);
    Arguments::command().try_get_matches_from(whole).ok()?;
    let mut words: Vec<String> = typed
        .iter()
        .skip(1)
        .map(|a| path_text(Path::new(a)))
        .collect();
    words.extend(["--out".to_string(), path_text(&out)]);
    Some(format!(
        "next: {}",
        stiction::commands::text::command(words.into_iter())
    ))
}

/// The command that was typed.
pub fn again() -> String {
    let arguments = std::env::args_os().skip(1);
    stiction::commands::text::command(arguments.map(|a| path_text(Path::new(&a))))
}

/// The command that was typed, with another path in place of one.
pub fn in_place_of(file: &Path, instead: &Path) -> String {
    stiction::commands::text::command(with(file, instead).into_iter())
}

/// What leads on from a log of which not all is clear: its axis file where one of that name is there, else one to begin.
pub fn begun(log: &Path) -> String {
    let log_as_typed = quoted_path(log);
    let file = stiction::commands::text::axis_file(&path_text(log));
    let new = stiction::commands::shell::new_axis_file(log);
    let begin = "for an axis file with the columns that are clear filled in:";
    let command = format!("stiction check {log_as_typed} --init {new}");
    match file == new {
        true => after(begin, &command),
        false => either(
            &format!("where {file} is the axis file of this log:"),
            &format!("stiction check {log_as_typed} --axis {file}"),
            &format!("else, {begin}"),
            &command,
        ),
    }
}

/// What was typed, with another path in place of one.
fn with(file: &Path, instead: &Path) -> Vec<String> {
    let arguments = std::env::args_os().skip(1);
    let arguments = arguments.map(|a| match Path::new(&a) == file {
        true => path_text(instead),
        false => path_text(Path::new(&a)),
    });
    arguments.collect()
}

/// What is wrong with the file of a command of which another argument is missing, and what leads on.
pub fn incomplete() -> Option<(Option<Error>, String)> {
    let misplaced = || {
        let (takes, typed) = misplaced::typed()?;
        let (error, next) = typed
            .iter()
            .find_map(|file| misplaced::refused(takes, file))?;
        Some((Some(error), next))
    };
    incomplete_export()
        .or_else(misplaced)
        .or_else(|| Some((None, without_out()?)))
}

/// What leads on from an export without its target or its folder: the whole command, and before it what is wrong with the file that
/// it names.
fn incomplete_export() -> Option<(Option<Error>, String)> {
    let optional = |export: clap::Command| export.mut_args(|argument| argument.required(false));
    let command = Arguments::command().mut_subcommand("export", optional);
    let typed = command.try_get_matches().ok()?;
    let export = typed.subcommand_matches("export")?;
    let file: &PathBuf = export.get_one("model")?;
    let refused = ModelFile::read(file).err();
    let model = match &refused {
        None => file,
        Some(FileError::OtherForm { instead, .. }) => instead.as_ref()?,
        Some(_) => return None,
    };
    let mut arguments = with(file, model);
    let rate = ModelFile::read(model).ok().and_then(|m| m.source.rate_hz);
    if export.value_source("cycle_time") != Some(ValueSource::CommandLine)
        && let Some(rate) = rate
    {
        arguments.extend(["--cycle-time".to_string(), cycle_time(rate).to_string()]);
    }
    let target: Option<&Target> = export.get_one("target");
    if target.is_none() {
        arguments.extend(["--target".to_string(), "c".to_string()]);
    }
    if !export.contains_id("out") {
        let named = target.and_then(ValueEnum::to_possible_value);
        let dir = model.with_file_name(named.as_ref().map_or("c", |value| value.get_name()));
        arguments.extend(["--out".to_string(), path_text(&free_folder(&dir))]);
    }
    let next = stiction::commands::text::command(arguments.into_iter());
    Some((refused.map(Error::from), format!("next: {next}")))
}

/// What leads on from a folder for what is written that holds something else: the same command into one that is free.
pub fn another_folder(error: &Error) -> Option<String> {
    let Error::File(FileError::Taken { remedy, .. }) = error else {
        return None;
    };
    let out = Typed::new()?.values("out");
    let out = Path::new(out.first()?);
    let free = match remedy {
        Remedy::Folder => return None,
        Remedy::AnotherFolder | Remedy::AnotherFolderOrForce => free_folder(out),
    };
    let command = with_value("out", &path_text(&free));
    (free != out).then(|| format!("next: {command}"))
}

/// What leads on from a checkpoint that is where the result is written: one beside that folder.
pub fn another_checkpoint(error: &Error, identify: &Identify) -> Option<String> {
    let checkpoint = identify.searching.checkpoint.as_deref()?;
    let is_of_it =
        matches!(error, Error::File(FileError::Output { path, .. }) if path == checkpoint);
    if !is_of_it || check_apart(&identify.out, checkpoint).is_ok() {
        return None;
    }
    let mut name = identify.out.file_name()?.to_os_string();
    name.push(".checkpoint");
    let beside = identify.out.with_file_name(name);
    let command = with_value("checkpoint", &path_text(&beside));
    Some(format!("next: {command}"))
}

/// What leads on from a log that is given by two paths, or as two copies: the same command with one of them.
pub fn once(logs: &[PathBuf]) -> Option<String> {
    let bytes = |log: &PathBuf| is_regular(log).then(|| sha256(log).ok()).flatten();
    let bytes: Vec<Option<String>> = logs.iter().map(bytes).collect();
    let twin = (1..logs.len()).find(|k| bytes[*k].is_some() && bytes[..*k].contains(&bytes[*k]))?;
    let mut before = logs[..twin]
        .iter()
        .filter(|log| *log == &logs[twin])
        .count();
    let arguments = std::env::args_os().skip(1).filter(|argument| {
        let is_twin = Path::new(argument) == logs[twin] && before == 0;
        before = before.saturating_sub(usize::from(Path::new(argument) == logs[twin]));
        !is_twin
    });
    let arguments = arguments.map(|a| path_text(Path::new(&a)));
    let command = stiction::commands::text::command(arguments);
    Some(format!("next: {command}"))
}

/// What leads on from what is no regular file, where nothing else does: what there is beside it, or in it.
pub fn not_regular(error: &Error) -> Option<String> {
    let path = match error {
        Error::File(FileError::Log(e)) => e.file.as_deref()?,
        Error::File(FileError::Config { file, .. } | FileError::OtherForm { file, .. }) => file,
        Error::Checkpoint { file, .. } => file,
        _ => return None,
    };
    match (
        path.symlink_metadata().is_err() || is_regular(path),
        path.is_dir(),
    ) {
        (true, _) => None,
        (false, true) => shown(path),
        (false, false) => shown(folder(path)),
    }
}

/// Of which motion the `min_speed` of an axis file is, by its unit.
pub fn motion_of_min_speed(axis: &Path) -> Motion {
    const ROTARY: [&str; 8] = ["rad", "deg", "°", "rev", "rpm", "U/min", "1/min", "arc"];
    let text = std::fs::read_to_string(axis).unwrap_or_default();
    let mut lines = text.lines().map(str::trim_start);
    let line = lines.find(|line| line.starts_with("min_speed"));
    match line.is_some_and(|line| ROTARY.iter().any(|unit| line.contains(unit))) {
        true => Motion::Rotary,
        false => Motion::Linear,
    }
}

/// What leads on where the disk is full.
pub fn no_room(error: &Error) -> Option<String> {
    let Error::File(e @ FileError::Output { path, .. }) = error else {
        return None;
    };
    if !e.is_full_disk() {
        return None;
    }
    let there = path.ancestors().map(or_here).find(|dir| dir.is_dir())?;
    let arguments = std::env::args_os().skip(1);
    let mut arguments: Vec<String> = arguments.map(|a| path_text(Path::new(&a))).collect();
    // What was done by then is kept in the folder.
    let resume = "--resume".to_string();
    let mut folders = path.ancestors().filter(|dir| !dir.as_os_str().is_empty());
    if folders.any(has_runs) && !arguments.contains(&resume) {
        arguments.push(resume);
    }
    Some(after(
        &format!(
            "make room (df -h {} shows how much there is), then",
            quoted_path(there)
        ),
        &stiction::commands::text::command(arguments.into_iter()),
    ))
}

/// The folder of a path.
fn folder(path: &Path) -> &Path {
    or_here(path.parent().unwrap_or(Path::new("")))
}

fn or_here(dir: &Path) -> &Path {
    match dir.as_os_str().is_empty() {
        true => Path::new("."),
        false => dir,
    }
}

/// Most letters in which the name of a file that was meant differs from what was typed.
const MOST_SLIPS: usize = 2;
/// Most names of a folder that are looked at.
const MOST_NAMES: usize = 10_000;

/// The file of the folder whose name is closest to the one that was typed, if one is close.
fn meant(path: &Path, folder: &Path) -> Option<PathBuf> {
    let typed = path.file_name()?.to_str()?.to_lowercase();
    let entries = std::fs::read_dir(folder).ok()?.take(MOST_NAMES).flatten();
    let close = entries.filter_map(|entry| {
        let name = entry.file_name().into_string().ok()?;
        let slips = slips(&typed, &name.to_lowercase());
        let close = slips <= MOST_SLIPS && 2 * slips < typed.chars().count();
        (close && entry.path().is_file()).then_some((slips, name))
    });
    let (_, name) = close.min()?;
    Some(path.with_file_name(name))
}

/// How many letters have to be put in, left out or changed to make one word of another.
fn slips(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, c) in a.chars().enumerate() {
        let mut corner = row[0];
        row[0] = i + 1;
        for (j, d) in b.iter().enumerate() {
            let changed = corner + usize::from(c != *d);
            corner = row[j + 1];
            row[j + 1] = changed.min(row[j] + 1).min(corner + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::slips;

    #[test]
    fn slips_are_counted() {
        for (a, b, count) in [
            ("run.csv", "run.csv", 0),
            ("rum.csv", "run.csv", 1),
            ("run1.csv", "run.csv", 1),
            ("rn.csv", "run.csv", 1),
            ("", "ab", 2),
            ("abc", "", 3),
            ("kitten", "sitting", 3),
        ] {
            assert_eq!(slips(a, b), count, "{a} {b}");
        }
    }
}
