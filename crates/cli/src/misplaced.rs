//! What to type next where a file is given to a command that is for another: a log to export, a result to identify.

use std::path::{Path, PathBuf};
use stiction::commands::shell::quoted_path;
use stiction::commands::{FileError, Looks, looks, refuse_as_log};
use stiction::{Axis, Error, ModelFile, Study};

/// What a command takes as its first file.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Takes {
    /// `check`, `identify`, `compare`, `batch`.
    Logs,
    /// `export`.
    Model,
    /// `simulate`.
    Study,
    /// `plan`.
    Axis,
    /// `drift`.
    Table,
}

impl Takes {
    /// What the command of this name takes.
    pub fn of(command: &str) -> Option<Self> {
        Some(match command {
            "check" | "identify" | "compare" | "batch" => Takes::Logs,
            "export" => Takes::Model,
            "simulate" => Takes::Study,
            "plan" => Takes::Axis,
            "drift" => Takes::Table,
            _ => return None,
        })
    }
}

/// The whole command that leads on from a file that is none of those that the command takes.
pub fn next(takes: Takes, file: &Path) -> Option<String> {
    let looks = looks(file)?;
    let path = quoted_path(file);
    let beside = |name: &str| quoted_path(&file.with_file_name(name));
    let dir = file.with_extension("");
    let inside = |name: &str| quoted_path(&dir.join(name));
    let identified = || format!("stiction identify {path} --out {}", quoted_path(&dir));
    Some(match (takes, looks) {
        (Takes::Model, Looks::Log) => format!(
            "next: {}, then: stiction export {} --target c --out {}",
            identified(),
            inside("model.toml"),
            inside("c")
        ),
        (Takes::Study, Looks::Log) => format!(
            "next: {}, then: stiction simulate {} --out {}",
            identified(),
            inside("study.toml"),
            inside("study")
        ),
        (Takes::Axis, Looks::Log) => {
            let axis = quoted_path(&file.with_extension("axis.toml"));
            format!(
                "next: stiction check {path} --init {axis}, then, with what the axis may do under [limits] of it (docs/plan.md): \
                 stiction plan {axis} --log {path} --out {}",
                beside("plan")
            )
        }
        (Takes::Table, Looks::Log) => format!(
            "next, with every log that is to be followed: stiction batch {path} --law lugre --out {}, then: stiction drift {}",
            beside("batch"),
            quoted_path(&file.with_file_name("batch").join("results.parquet"))
        ),
        (Takes::Logs, Looks::Model) => exported(file),
        (Takes::Logs, Looks::Result) => match file.with_file_name("model.toml") {
            model if model.is_file() => exported(&model),
            _ => return None,
        },
        (Takes::Logs | Takes::Model, Looks::Study) => {
            format!("next: stiction simulate {path} --out {}", beside("study"))
        }
        (Takes::Logs, Looks::Axis) => {
            let listed = Axis::read(file).is_ok_and(|axis| !axis.logs.is_empty());
            let log = if listed { "" } else { " LOG" };
            format!("next: stiction check{log} --axis {path}")
        }
        (Takes::Study, Looks::Model) => {
            let study = beside("study.toml");
            format!(
                "next: stiction simulate --init {study} --model {path}, then: stiction simulate {study} --out {}",
                beside("study")
            )
        }
        _ => return None,
    })
}

fn exported(model: &Path) -> String {
    format!(
        "next: stiction export {} --target c --out {}",
        quoted_path(model),
        quoted_path(&model.with_file_name("c"))
    )
}

/// What is wrong with the file of a command whose other arguments are missing, and what leads on from it.
pub fn refused(takes: Takes, file: &Path) -> Option<(Error, String)> {
    let error = match takes {
        Takes::Logs => refuse_as_log(file).err(),
        Takes::Model => ModelFile::read(file).err(),
        Takes::Axis => Axis::read(file).err(),
        Takes::Study => Study::read(file).err(),
        Takes::Table => None,
    };
    let error = error.filter(|error| matches!(error, FileError::OtherForm { .. }))?;
    Some((error.into(), next(takes, file)?))
}

/// The command that was typed, and what stands behind it without an option before it.
pub fn typed() -> Option<(Takes, Vec<PathBuf>)> {
    /// Options that have no value.
    const FLAGS: [&str; 6] = [
        "--json",
        "--quiet",
        "--force",
        "--asymmetric",
        "--resume",
        "--adapt",
    ];
    let words: Vec<String> = std::env::args_os()
        .skip(1)
        .map(|word| word.to_string_lossy().into_owned())
        .collect();
    let at = words.iter().position(|word| Takes::of(word).is_some())?;
    let takes = Takes::of(&words[at])?;
    let has_value =
        |word: &str| word.starts_with("--") && !word.contains('=') && !FLAGS.contains(&word);
    let files = words[at..].windows(2).filter_map(|pair| {
        let is_file = !has_value(&pair[0]) && !pair[1].starts_with('-');
        is_file.then(|| PathBuf::from(&pair[1]))
    });
    Some((takes, files.collect()))
}
