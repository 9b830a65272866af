//! What leads on from an option that is refused: the same command with a value that it takes, or without the option.

use crate::arguments::{self, Arguments, Command};
use crate::next::{after, again, shown};
use crate::wording;
use clap::CommandFactory;
use clap::error::{ContextKind, ContextValue};
use std::path::{Path, PathBuf};
use stiction::commands::shell::{free_folder, quoted_path, text as path_text};
use stiction::commands::{FileError, Setting, Want, is_regular, sha256, text};
use stiction::{Code, Error};

/// The shortest and the longest motion that is planned, s.
const TIMES: [f64; 2] = [2.0, 600.0];

/// What leads on from options that a command refuses.
pub fn next(error: &Error, command: &Command) -> Option<String> {
    if error.code() != Code::Usage {
        return None;
    }
    let message = wording::message(error);
    let named = named(&message);
    match (command, named.first().copied()) {
        (Command::Plan(plan), Some(option)) => of_plan(plan, option, &message),
        (Command::Plan(plan), None) => of_known(plan, &message),
        (Command::Identify(_) | Command::Batch(_), Some("split")) => {
            let share = match error {
                Error::Usage { allowed, .. } => allowed.value(Setting::Split),
                _ => None,
            };
            match share {
                None => without(&["split"]),
                Some(share) => Some(format!("next: {}", with_value("split", share))),
            }
        }
        (Command::Identify(identify), None) => match validated_on_itself(identify) {
            true => without(&["validate"]),
            false => Some(looked_at(identify)),
        },
        (_, Some(_)) => without(&named),
        (_, None) => None,
    }
}

/// The options that a message begins with, by name.
fn named(message: &str) -> Vec<&str> {
    let ends = |c: char| !(c.is_alphanumeric() || c == '-');
    let found = message.split([';']).next().unwrap_or_default();
    let found = found.split(" together with ").next().unwrap_or_default();
    let words = found
        .split([' ', ','])
        .filter_map(|word| word.strip_prefix("--"));
    let names = words.map(|word| word.split(ends).next().unwrap_or_default());
    match message.starts_with("--") {
        true => names.collect(),
        false => Vec::new(),
    }
}

/// Whether a log that is fitted is one of those that the fit is validated on.
fn validated_on_itself(identify: &arguments::Identify) -> bool {
    let twin = |log: &PathBuf| sha256(log).ok();
    let mut own = identify.logs.iter().filter(|log| is_regular(log));
    own.any(|log| {
        let mut others = identify.validate.iter().filter(|log| is_regular(log));
        others.any(|other| other == log || twin(other) == twin(log))
    })
}

fn of_plan(plan: &arguments::Plan, option: &str, message: &str) -> Option<String> {
    match option {
        "time" => {
            let [least, most] = TIMES;
            // No number is above none.
            let time = plan.time.filter(|time| time.is_finite()).unwrap_or(most);
            let time = format!("{}s", time.clamp(least, most));
            Some(format!("next: {}", with_value("time", &time)))
        }
        "want" => {
            // Elements have names of their own.
            let law = plan.law.unwrap_or(arguments::PlannedLaw::Lugre);
            let example = match law {
                arguments::PlannedLaw::Lugre => "sigma0 < 2 %",
                _ => "all < 2 %",
            };
            let is_refused = |wish: &str| Want::parse(wish).is_err();
            let words = replaced(|option, wish| {
                (option == "want" && is_refused(wish)).then(|| example.into())
            });
            match plan.wants.iter().any(|wish| is_refused(wish)) {
                true => Some(after("as an example:", &pasted(words))),
                false => without(&["want"]),
            }
        }
        "law" if message.starts_with("--law") && message.contains(" --asymmetric;") => {
            without(&["asymmetric"])
        }
        "law" if plan.log.is_none() && plan.model.is_none() => {
            let probe = free_folder(&plan.out.with_file_name("probe"));
            let log = plan.out.with_file_name("probe.csv");
            let [axis, first, points, log] =
                [&plan.axis, &probe, &probe.join("setpoints.csv"), &log].map(|p| quoted_path(p));
            let words = [words(), vec!["--log".into(), log.clone()]].concat();
            let stage = ["--stage", "--stage=probe", "probe"];
            let whole = words
                .into_iter()
                .filter(|word| !stage.contains(&word.as_str()));
            Some(format!(
                "next: stiction plan {axis} --stage probe --out {first}\nrecord {points} as {log},\nthen: {}",
                pasted(whole.collect())
            ))
        }
        _ => without(&[option]),
    }
}

/// What leads on from a first log or model for which nothing is planned: the limits of the axis alone; else the axis file is to be
/// corrected.
fn of_known(plan: &arguments::Plan, message: &str) -> Option<String> {
    let is_of = |file: &Path| {
        let names = [path_text(file), file.display().to_string()];
        names.iter().any(|name| message.starts_with(name.as_str()))
    };
    let log = plan.log.as_deref().filter(|file| is_of(file));
    let model = plan.model.as_deref().filter(|file| is_of(file));
    match (log, model) {
        (Some(_), _) => without(&["log"]),
        (_, Some(_)) => without(&["model"]),
        _ => Some(after(
            &format!("correct {} as said above, then", quoted_path(&plan.axis)),
            &again(),
        )),
    }
}

/// What the logs hold that cannot be identified as it was asked for.
fn looked_at(identify: &arguments::Identify) -> String {
    let mut check = String::from("stiction check");
    for log in &identify.logs {
        check.push_str(&format!(" {}", quoted_path(log)));
    }
    if let Some(axis) = &identify.axis {
        check.push_str(&format!(" --axis {}", quoted_path(axis)));
    }
    after("what the logs show:", &check)
}

/// The words behind the name of the program.
fn words() -> Vec<String> {
    let words = std::env::args_os().skip(1);
    words.map(|word| path_text(Path::new(&word))).collect()
}

fn pasted(words: Vec<String>) -> String {
    text::command(words.into_iter())
}

/// The command that was typed, with another value of an option.
pub fn with_value(option: &str, value: &str) -> String {
    pasted(replaced(|own, _| (own == option).then(|| value.into())))
}

/// What was typed, with another value for each option for which there is one, by its name and its value.
fn replaced(other: impl Fn(&str, &str) -> Option<String>) -> Vec<String> {
    let mut words = words();
    for k in 0..words.len() {
        let Some(option) = words[k].strip_prefix("--") else {
            continue;
        };
        if let Some((name, value)) = option.split_once('=') {
            if let Some(value) = other(name, value) {
                words[k] = format!("--{name}={value}");
            }
        } else if let Some(value) = words.get(k + 1).and_then(|value| other(option, value)) {
            words[k + 1] = value;
        }
    }
    words
}

/// What leads on from another file than is wanted, where nothing else does: the same without it where it is a plan of a motion, which
/// may be left out, else what there is beside it.
pub fn other_file(error: &Error, command: &Command) -> Option<String> {
    let Error::File(FileError::OtherForm { file, .. }) = error else {
        return None;
    };
    let is_plan = |typed: &arguments::Identify| typed.plan.as_ref() == Some(file);
    match command {
        Command::Identify(typed) if is_plan(typed) => without(&["plan"]),
        _ => shown(file.parent()?),
    }
}

/// The command that was typed, without options that it may be without.
fn without(options: &[&str]) -> Option<String> {
    let typed = words();
    let known = Arguments::command();
    let command = typed
        .iter()
        .find_map(|word| known.find_subcommand(word.as_str()))?;
    let mut kept = typed.clone();
    for option in options {
        kept = without_one(kept, command, option);
    }
    (kept.len() < typed.len()).then(|| format!("next: {}", pasted(kept)))
}

/// Words without an option and its values.
fn without_one(typed: Vec<String>, command: &clap::Command, option: &str) -> Vec<String> {
    let mut options = command.get_arguments();
    let is_own = |own: &&clap::Arg| own.get_long() == Some(option) && !own.is_required_set();
    let Some(own) = options.find(is_own) else {
        return typed;
    };
    let most = match own.get_action().takes_values() {
        true => own
            .get_num_args()
            .map_or(1, |count| count.max_values().max(1)),
        false => 0,
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

/// What leads on from arguments that cannot be read: the same with what was probably meant, else what the command takes.
pub fn unread(error: &clap::Error) -> Option<String> {
    let of = |kind: ContextKind| match error.get(kind)? {
        ContextValue::String(one) => Some(one.clone()),
        ContextValue::Strings(many) => many.first().cloned(),
        _ => None,
    };
    let meant = [
        (ContextKind::InvalidValue, ContextKind::SuggestedValue),
        (ContextKind::InvalidArg, ContextKind::SuggestedArg),
        (
            ContextKind::InvalidSubcommand,
            ContextKind::SuggestedSubcommand,
        ),
    ];
    let meant = meant.into_iter().find_map(|(wrong, meant)| {
        let (wrong, meant) = (of(wrong)?, of(meant)?);
        let words: Vec<String> = words()
            .into_iter()
            .map(|word| match word.split_once('=') {
                _ if word == wrong => meant.clone(),
                Some((name, value)) if value == wrong => format!("{name}={meant}"),
                Some((name, value)) if name == wrong => format!("{meant}={value}"),
                _ => word,
            })
            .collect();
        let whole = std::iter::once("stiction".to_string()).chain(words.clone());
        let is_whole = Arguments::command().try_get_matches_from(whole).is_ok();
        is_whole.then(|| pasted(words))
    });
    let help = || {
        let known = Arguments::command();
        let typed = words();
        let command = typed
            .iter()
            .find_map(|word| known.find_subcommand(word.as_str()));
        let command = command.map_or(String::new(), |command| format!("{} ", command.get_name()));
        after("what it takes:", &format!("stiction {command}--help"))
    };
    Some(match meant {
        Some(command) => after("was this meant?", &command),
        None => help(),
    })
}
