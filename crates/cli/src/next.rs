//! What to type after a refusal: from the kind of the error and the command that was typed.

use crate::arguments::{Arguments, Command};
use crate::typed::Typed;
use crate::wording;
use crate::words;
use clap::CommandFactory;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use std::path::{Path, PathBuf};
use stiction_files::result::Action;
use stiction_files::shell::{
    cycle_option, cycle_time, free_folder, new_axis_file, quoted_path, text as path_text,
};
use stiction_files::{Axis, ModelFile};
use stiction_files::{Error as FileError, Looks, check_apart, has_runs, looks};
use stiction_formats::{Error as LogError, Kind, is_recording_folder, is_regular};
use stiction_pages::text;
use stiction_workflows::Error;
use stiction_workflows::Wording;

/// What is to be known or done first, on a line of its own, and a command alone behind `next:`, to be pasted as it stands.
pub fn after(first: &str, command: &str) -> String {
    format!("{first}\nnext: {command}")
}

fn next(command: &str) -> String {
    format!("next: {command}")
}

/// What to type next after an error; `None` where its message says all.
pub fn of(error: &Error, command: &Command) -> Option<String> {
    let given = Given::of(command);
    match error {
        Error::File(e) => given.of_file(e),
        Error::Identify { action, .. } => Some(given.of_action(action)),
        Error::SameLog { second, .. } => {
            let typed = words();
            let last = typed.iter().rposition(|word| Path::new(word) == second)?;
            let mut kept = typed.clone();
            kept.remove(last);
            let once = is_read(&kept).then(|| next(&pasted(kept)));
            once.or_else(|| Some(given.check()))
        }
        Error::Urdf { file, .. } => {
            let first = format!("correct {}, then", quoted_path(file));
            Some(after(&first, &again()))
        }
        Error::Usage { found, allowed } => given.of_usage(found, allowed),
        Error::Checkpoint { file, .. } if is_regular(file) => {
            let anew = without("resume");
            Some(match anew == words() {
                true => next(&with_value("checkpoint", &path_text(&free_folder(file)))),
                false => after("to begin anew:", &pasted(anew)),
            })
        }
        Error::Checkpoint { file, .. } => shown(file),
        _ => None,
    }
}

/// What to type next where arguments are missing or cannot be read: the command completed, what was probably meant, or what it takes.
pub fn of_arguments(error: &clap::Error) -> String {
    let completed = (error.kind() == ErrorKind::MissingRequiredArgument)
        .then(completed)
        .flatten();
    if let Some(command) = completed {
        return next(&command);
    }
    let of = |kind: ContextKind| match error.get(kind)? {
        ContextValue::String(one) => Some(one.clone()),
        ContextValue::Strings(many) => many.first().cloned(),
        _ => None,
    };
    let suggested = [
        (ContextKind::InvalidValue, ContextKind::SuggestedValue),
        (ContextKind::InvalidArg, ContextKind::SuggestedArg),
    ];
    let meant = suggested.into_iter().find_map(|(wrong, meant)| {
        let (wrong, meant) = (of(wrong)?, of(meant)?);
        let kept = words().into_iter().map(|word| match word.split_once('=') {
            _ if word == wrong => meant.clone(),
            Some((name, value)) if value == wrong => format!("{name}={meant}"),
            Some((name, value)) if name == wrong => format!("{meant}={value}"),
            _ => word,
        });
        let kept: Vec<String> = kept.collect();
        is_read(&kept).then(|| pasted(kept))
    });
    match meant {
        Some(command) => after("was this meant?", &command),
        None => {
            let typed = Typed::new().map_or(String::new(), |typed| format!("{} ", typed.command));
            after("what it takes:", &format!("stiction {typed}--help"))
        }
    }
}

/// The command that was typed with a folder for what is written, and for an export a target, where nothing else is missing.
fn completed() -> Option<String> {
    let typed = Typed::new()?;
    let file = typed.files().into_iter().next()?;
    if !(file.is_file() || typed.command == "batch" && file.is_dir()) {
        return None;
    }
    let mut more = Vec::new();
    let out = match typed.command.as_str() {
        "export" => {
            let model = ModelFile::read(&file).ok();
            let rate = model.and_then(|model| model.source.rate_hz);
            if let Some(rate) = rate.filter(|_| typed.values("cycle_time").is_empty()) {
                more.extend(["--cycle-time".into(), cycle_time(rate).to_string()]);
            }
            if typed.values("target").is_empty() {
                more.extend(["--target".into(), "c".into()]);
            }
            file.with_file_name("c")
        }
        "plan" | "batch" | "compare" => file.with_file_name(&typed.command),
        _ => file.with_extension(""),
    };
    let out = match out == file {
        true => file.with_file_name("result"),
        false => out,
    };
    if typed.values("out").is_empty() {
        more.extend(["--out".into(), path_text(&free_folder(&out))]);
    }
    let kept = with(more);
    is_read(&kept).then(|| pasted(kept))
}

/// The files of the command that was typed.
struct Given<'a> {
    command: &'a Command,
    logs: Vec<&'a Path>,
    axis: Option<&'a Path>,
}

impl<'a> Given<'a> {
    fn of(command: &'a Command) -> Self {
        let all = |logs: &'a [PathBuf]| logs.iter().map(PathBuf::as_path).collect();
        let (logs, axis) = match command {
            Command::Check(own) => (all(&own.logs), own.axis.as_deref()),
            Command::Identify(own) => (all(&own.logs), own.axis.as_deref()),
            Command::Robot(own) => (all(&own.logs), own.axis.as_deref()),
            Command::Compare(own) => (all(&own.logs), own.axis.as_deref()),
            Command::Plan(own) => (own.log.as_deref().into_iter().collect(), Some(&*own.axis)),
            _ => (Vec::new(), None),
        };
        Self {
            command,
            logs,
            axis,
        }
    }

    /// A look at the logs.
    fn check(&self) -> String {
        let logs = self.logs.iter().map(|log| path_text(log)).collect();
        self.of_action(&Action::Check { logs })
    }

    fn of_action(&self, action: &Action) -> String {
        let file = self.axis.map_or("the axis file".into(), quoted_path);
        match action {
            Action::Check { logs } if logs.is_empty() && !self.logs.is_empty() => self.check(),
            Action::Check { logs } => {
                let logs = logs.iter().map(|log| quoted_path(Path::new(log)));
                let axis = self
                    .axis
                    .map(|axis| format!("--axis {}", quoted_path(axis)));
                let words: Vec<String> = logs.chain(axis).collect();
                let command = format!("stiction check {}", words.join(" "));
                after(
                    "what the log shows, and what motion to record instead:",
                    &command,
                )
            }
            Action::Line { table, line, .. } => after(
                &format!(
                    "in {file}, under [{table}], in place of the line {0} write {line}, or leave it out, then",
                    Action::key(line)
                ),
                &again(),
            ),
            Action::Remove { table, line } => after(
                &format!("leave {line} out of {table} of {file}, or correct it, then"),
                &again(),
            ),
            Action::Simulate => {
                let mut kept = words();
                let out = kept.iter().position(|word| word.starts_with("--out"));
                let method = ["--method".into(), "output-error".into()];
                let at = out.unwrap_or(kept.len());
                kept.splice(at..at, method);
                next(&pasted(kept))
            }
            _ => next(&again()),
        }
    }

    /// The command with the value that the error states for an option, or without the options that it names.
    fn of_usage(&self, found: &Wording, allowed: &Wording) -> Option<String> {
        let named: Vec<_> = found.settings().collect();
        if let Some((setting, value)) = named
            .iter()
            .rev()
            .find_map(|setting| Some((*setting, allowed.value(*setting)?)))
        {
            return Some(next(&with_value(&wording::option(setting), value)));
        }
        let typed = words();
        let left_out = named.into_iter().find_map(|setting| {
            let kept = without(&wording::option(setting));
            (kept != typed && is_read(&kept)).then(|| next(&pasted(kept)))
        });
        left_out
            .or_else(|| match self.command {
                Command::Plan(own) if own.model.is_some() => Some(next(&pasted(without("model")))),
                Command::Drift(drift) if !drift.limit.is_empty() => {
                    Some(next(&pasted(without("limit"))))
                }
                Command::Robot(robot) => {
                    let urdf = robot.urdf.as_ref();
                    shown(urdf.filter(|urdf| !is_regular(urdf))?)
                }
                Command::Batch(batch) => {
                    self.of_other(batch.inputs.iter().find(|input| input.is_dir())?)
                }
                _ => None,
            })
            .or_else(|| (!self.logs.is_empty()).then(|| self.check()))
            .or_else(|| {
                let axis = quoted_path(self.axis?);
                Some(after(
                    &format!("correct {axis} as said above, then"),
                    &again(),
                ))
            })
    }

    fn of_file(&self, error: &FileError) -> Option<String> {
        if let Some(next) = corrected(error) {
            return Some(next);
        }
        match error {
            FileError::TooLarge { needed, .. } => Some(after(
                "make it smaller, or allow so many samples:",
                &with_value("max-samples", &rounded_up(*needed)),
            )),
            FileError::Runs { .. } => Some(after("to begin anew:", &pasted(without("resume")))),
            FileError::Taken { .. } => {
                let out = Typed::new()?.values("out");
                let out = Path::new(out.first()?);
                let free = free_folder(out);
                (free != out).then(|| next(&with_value("out", &path_text(&free))))
            }
            FileError::Output { path, .. } => self.of_output(error, path),
            FileError::OtherForm { file, instead, .. } => match instead {
                Some(instead) => Some(next(&in_place_of(file, instead))),
                None => self.of_other(file),
            },
            FileError::Config { file, .. } => self.of_other(file),
            FileError::Log(e) => self.of_log(e),
            _ => None,
        }
    }

    /// What leads on where something cannot be written.
    fn of_output(&self, error: &FileError, path: &Path) -> Option<String> {
        if error.is_full_disk() {
            let out = match self.command {
                Command::Batch(own) => Some(&own.out),
                Command::Compare(own) => Some(&own.out),
                Command::Simulate(own) => own.out.as_ref(),
                _ => None,
            };
            // What was done by then is kept in the folder.
            let kept = match out.is_some_and(|out| has_runs(out)) {
                true => resumed(),
                false => words(),
            };
            return Some(after("make room on the disk, then", &pasted(kept)));
        }
        match self.command {
            Command::Check(check) if check.init.as_deref() == Some(path) && path.exists() => {
                let log = check.logs.first()?;
                return Some(next(&begun(log)));
            }
            Command::Identify(own)
                if own.searching.checkpoint.as_deref() == Some(path)
                    && check_apart(&own.out, path).is_err() =>
            {
                let mut name = own.out.file_name()?.to_os_string();
                name.push(".checkpoint");
                let beside = own.out.with_file_name(name);
                return Some(next(&with_value("checkpoint", &path_text(&beside))));
            }
            _ => {}
        }
        let folder = folder(path);
        let is_missing = folder.symlink_metadata().is_err() && path.symlink_metadata().is_err();
        is_missing.then(|| next(&format!("mkdir -p {} && {}", quoted_path(folder), again())))
    }

    /// What leads on from a recording that is refused.
    fn of_log(&self, e: &LogError) -> Option<String> {
        let file = e.file.as_deref()?;
        if !is_regular(file) && !is_recording_folder(file) {
            return self.of_other(file);
        }
        let is_unclear = matches!(
            e.kind,
            Kind::Missing | Kind::Ambiguous | Kind::Unit | Kind::Time | Kind::Value
        );
        if !self.logs.contains(&file) {
            return None;
        }
        if matches!(self.command, Command::Robot(_)) && (is_unclear || e.is_settled_by_line()) {
            let axis = self.axis.unwrap_or(Path::new("robot.toml"));
            return Some(after(
                &format!("with what is said above in {}:", quoted_path(axis)),
                &with_value("axis", &path_text(axis)),
            ));
        }
        if e.is_settled_by_line() {
            let axis = self
                .axis
                .map_or_else(|| text::axis_file(&path_text(file)), quoted_path);
            let check = format!("stiction check {} --axis {axis}", quoted_path(file));
            return Some(after(&format!("with that line in {axis}:"), &check));
        }
        if e.kind == Kind::Format || e.place.row.is_some() && e.kind != Kind::Limit {
            return Some(after("correct the file, then", &again()));
        }
        match self.axis {
            _ if !is_unclear => None,
            Some(axis) => Some(after(
                &format!("with what is said above in {}:", quoted_path(axis)),
                &again(),
            )),
            None => {
                let own = text::axis_file(&path_text(file));
                let (first, command) = match own == new_axis_file(file) {
                    true => (
                        "for an axis file with the columns that are clear filled in:",
                        begun(file),
                    ),
                    false => (
                        "with its axis file:",
                        format!("stiction check {} --axis {own}", quoted_path(file)),
                    ),
                };
                Some(format!("{}{}", of_robot(e, file), after(first, &command)))
            }
        }
    }

    /// What leads on from a file that is missing, or something else than what the command takes: the one that is meant in a folder, what
    /// that file is good for, or a look at the folder.
    fn of_other(&self, file: &Path) -> Option<String> {
        if self.axis == Some(file)
            && let Command::Robot(own) = self.command
        {
            return own.urdf.is_some().then(|| next(&pasted(without("axis"))));
        }
        if self.axis == Some(file) && !matches!(self.command, Command::Plan(_)) && file.exists() {
            return Some(after(
                "for an axis file of that log:",
                &begun(self.logs.first()?),
            ));
        }
        if file.exists()
            && matches!(self.command, Command::Identify(own) if own.plan.as_deref() == Some(file))
        {
            return Some(next(&pasted(without("plan"))));
        }
        if !file.is_dir() {
            return self
                .use_of(file)
                .map(|use_of| next(&use_of))
                .or_else(|| shown(file));
        }
        let entries = std::fs::read_dir(file).ok()?.take(MOST_NAMES).flatten();
        let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
        files.retain(|file| file.is_file());
        files.sort();
        let of = |wanted: Looks| files.iter().find(|file| looks(file) == Some(wanted));
        let wanted = match self.command {
            Command::Simulate(_) => of(Looks::Study),
            Command::Plan(own) if own.axis == file => of(Looks::Axis),
            Command::Export(_) => of(Looks::Model).or_else(|| of(Looks::Robot)),
            _ => None,
        };
        if let Some(wanted) = wanted {
            return Some(next(&in_place_of(file, wanted)));
        }
        if let Some(use_of) = of(Looks::Model).and_then(|model| self.use_of(model)) {
            return Some(next(&use_of));
        }
        // A batch leaves out what an earlier command has written.
        let is_written = [
            "result.json",
            "batch.json",
            "study.json",
            "drift.json",
            "robot.json",
        ]
        .iter()
        .any(|name| file.join(name).is_file());
        if !is_written && of(Looks::Log).is_some() {
            let axis = self.axis.filter(|axis| *axis != file);
            let axis = axis.map_or(String::new(), |axis| {
                format!(" --axis {}", quoted_path(axis))
            });
            let out = quoted_path(&free_folder(&match file.file_name() {
                Some(_) => file.with_file_name("batch"),
                // `.` and `..` have none.
                None => "batch".into(),
            }));
            let batch = format!(
                "stiction batch {}{axis} --law lugre --out {out}",
                quoted_path(file)
            );
            return Some(after("for every log of the folder:", &batch));
        }
        shown(file)
    }

    /// The command that a file is good for.
    fn use_of(&self, file: &Path) -> Option<String> {
        let path = quoted_path(file);
        Some(match (looks(file)?, self.command) {
            (Looks::Log, Command::Plan(_)) => begun(file),
            (Looks::Log, Command::Drift(_)) => {
                let out = free_folder(&file.with_file_name("batch"));
                format!(
                    "stiction batch {path} --law lugre --out {}",
                    quoted_path(&out)
                )
            }
            (Looks::Log, _) => {
                let out = quoted_path(&free_folder(&file.with_extension("")));
                format!("stiction identify {path} --out {out}")
            }
            (Looks::Model | Looks::Result, Command::Drift(_)) => return None,
            (Looks::Model, Command::Simulate(_)) => {
                let study = quoted_path(&free_folder(&file.with_file_name("study.toml")));
                format!("stiction simulate --init {study} --model {path}")
            }
            (Looks::Model, _) => {
                let read = ModelFile::read(file).ok();
                let cycle = cycle_option(read.and_then(|model| model.source.rate_hz));
                let out = quoted_path(&free_folder(&file.with_file_name("c")));
                format!("stiction export {path} --target c{cycle} --out {out}")
            }
            (Looks::Result, _) => {
                let model = file.with_file_name("model.toml");
                return (looks(&model)? == Looks::Model).then(|| self.use_of(&model))?;
            }
            (Looks::Study, _) => {
                let out = free_folder(&file.with_file_name("study"));
                format!("stiction simulate {path} --out {}", quoted_path(&out))
            }
            (Looks::Axis, _) => {
                let lists = Axis::read(file).is_ok_and(|axis| !axis.logs.is_empty());
                let log = if lists { "" } else { "log.csv " };
                format!("stiction check {log}--axis {path}")
            }
            (Looks::Robot, _) => {
                let out = quoted_path(&free_folder(&file.with_file_name("robot")));
                format!("stiction robot log.csv --axis {path} --out {out}")
            }
            (Looks::Plan, _) => return None,
        })
    }
}

/// What leads on from a typed file whose content is refused: where to correct it, and the same command again.
fn corrected(error: &FileError) -> Option<String> {
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
    let first = format!("correct {}, then", places.join(" and "));
    Some(after(&first, &again()))
}

/// Most names of a folder that are looked at.
const MOST_NAMES: usize = 10_000;

/// The command that shows what is in the nearest folder of a path that is there.
fn shown(path: &Path) -> Option<String> {
    let mut folders = path
        .ancestors()
        .map(|dir| match dir.as_os_str().is_empty() {
            true => Path::new("."),
            false => dir,
        });
    let there = folders.find(|dir| dir.is_dir())?;
    let ls = format!("ls {}", quoted_path(there));
    Some(after("which files there are:", &ls))
}

/// The folder of a path.
fn folder(path: &Path) -> &Path {
    let folder = path.parent().filter(|dir| !dir.as_os_str().is_empty());
    folder.unwrap_or(Path::new("."))
}

/// The line that says how all joints of a robot are identified, where a bag of ROS 2 has several; else empty.
fn of_robot(e: &LogError, log: &Path) -> String {
    let ending = log.extension().and_then(|ending| ending.to_str());
    if e.kind != Kind::Ambiguous || !ending.is_some_and(|own| BAGS.contains(&own)) {
        return String::new();
    }
    let out = quoted_path(&free_folder(Path::new("robot")));
    format!(
        "for all joints of a robot at once: stiction robot {} --urdf ARM.urdf --out {out}\n",
        quoted_path(log)
    )
}

/// Endings of bags of ROS 2, in which the joints of a robot are logged together.
const BAGS: [&str; 2] = ["db3", "mcap"];

/// The command that begins an axis file of a log.
fn begun(log: &Path) -> String {
    format!(
        "stiction check {} --init {}",
        quoted_path(log),
        new_axis_file(log)
    )
}

/// The words behind the name of the program.
fn words() -> Vec<String> {
    words::typed()
        .map(|word| path_text(Path::new(&word)))
        .collect()
}

fn pasted(words: Vec<String>) -> String {
    text::command(words.into_iter())
}

/// Whether a command can be read.
fn is_read(words: &[String]) -> bool {
    let whole = std::iter::once("stiction").chain(words.iter().map(String::as_str));
    Arguments::command().try_get_matches_from(whole).is_ok()
}

/// The command that was typed.
fn again() -> String {
    pasted(words())
}

/// The command that was typed, with another path in place of one.
pub fn in_place_of(file: &Path, instead: &Path) -> String {
    let mut words = words();
    let joined = |word: &String| {
        let value = word.split_once('=').map(|(_, value)| value);
        word.starts_with("--") && value.is_some_and(|value| Path::new(value) == file)
    };
    // A name may stand for something else too: the first is the file.
    if let Some(own) = words.iter_mut().find(|word| Path::new(word) == file) {
        *own = path_text(instead);
    } else if let Some(own) = words.iter_mut().find(|word| joined(word)) {
        let name = own.split('=').next().unwrap_or_default();
        *own = format!("{name}={}", path_text(instead));
    }
    pasted(words)
}

/// The command that was typed, with another value of an option; added where it was not typed.
pub fn with_value(option: &str, value: &str) -> String {
    let mut words = words();
    let mut is_typed = false;
    for k in 0..words.len() {
        let Some(own) = words[k].strip_prefix("--") else {
            continue;
        };
        if own == option && k + 1 < words.len() {
            words[k + 1] = value.into();
            is_typed = true;
        } else if own.split_once('=').is_some_and(|(name, _)| name == option) {
            words[k] = format!("--{option}={value}");
            is_typed = true;
        }
    }
    match is_typed {
        true => pasted(words),
        false => pasted(with([format!("--{option}"), value.into()])),
    }
}

/// What was typed with more words, before those that no option may follow.
fn with(more: impl IntoIterator<Item = String>) -> Vec<String> {
    let mut words = words();
    let end = words.iter().position(|word| word == "--");
    let at = end.unwrap_or(words.len());
    words.splice(at..at, more);
    words
}

/// What was typed, to go on with what an earlier call has done.
pub fn resumed() -> Vec<String> {
    match words().iter().any(|word| word == "--resume") {
        true => words(),
        false => with(["--resume".into()]),
    }
}

/// What was typed without an option and its values.
fn without(option: &str) -> Vec<String> {
    let typed = words();
    let known = Arguments::command();
    let command = typed.iter().find_map(|word| known.find_subcommand(word));
    let own = command.and_then(|c| c.get_arguments().find(|a| a.get_long() == Some(option)));
    let most = match own {
        Some(own) if own.get_action().takes_values() => own
            .get_num_args()
            .map_or(1, |count| count.max_values().max(1)),
        _ => 0,
    };
    let (name, joined) = (format!("--{option}"), format!("--{option}="));
    let mut kept = Vec::new();
    let mut words = typed.into_iter().peekable();
    while let Some(word) = words.next() {
        if word == name {
            let mut left = most;
            let is_value = |word: &String| most == 1 || !word.starts_with("--");
            while left > 0 && words.next_if(is_value).is_some() {
                left -= 1;
            }
        } else if !word.starts_with(&joined) {
            kept.push(word);
        }
    }
    kept
}

/// A number of two digits with a power of ten that is not below it.
fn rounded_up(count: u64) -> String {
    let mut power = 0;
    let mut digits = count;
    while digits >= 100 {
        digits = digits.div_ceil(10);
        power += 1;
    }
    match power {
        0 => digits.to_string(),
        _ => format!("{digits}e{power}"),
    }
}
