//! What to type next where a file is given to a command that is for another: a log to export, a result to identify.

use crate::next::{after, in_turn};
use crate::typed::Typed;
use std::path::{Path, PathBuf};
use stiction::commands::shell::{cycle_option, free_folder, quoted_path, text as path_text};
use stiction::commands::{FileError, Looks, looks, refuse_as_log};
use stiction::{Axis, Error, Log, ModelFile, Study};

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
        (Takes::Model, Looks::Log) => in_turn(
            &identified(),
            &export(
                &dir.join("model.toml"),
                Log::open(file).ok().map(|log| log.rate_hz()),
            ),
        ),
        (Takes::Study, Looks::Log) => in_turn(
            &identified(),
            &format!(
                "stiction simulate {} --out {}",
                inside("study.toml"),
                inside("study")
            ),
        ),
        (Takes::Axis, Looks::Log) => {
            let axis = quoted_path(&file.with_extension("axis.toml"));
            format!(
                "next: stiction check {path} --init {axis}\nwith what the axis may do under [limits] of it (docs/plan.md),\n\
                 then: stiction plan {axis} --log {path} --out {}",
                beside("plan")
            )
        }
        (Takes::Table, Looks::Log) => followed(&path, &file.with_file_name("batch")),
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
            match listed {
                true => format!("next: stiction check --axis {path}"),
                false => after(
                    &format!("with the path of the log in place of {A_LOG}:"),
                    &format!("stiction check {A_LOG} --axis {path}"),
                ),
            }
        }
        (Takes::Table, Looks::Result) => {
            let logs = logs_of(file).join(" ");
            if logs.is_empty() {
                return crate::next::shown(file.parent()?);
            }
            // Not in the folder of the result, which holds that of one log.
            let out = file.parent()?.with_file_name("batch");
            followed(&logs, &out)
        }
        (Takes::Study, Looks::Model) => {
            let study = beside("study.toml");
            in_turn(
                &format!("stiction simulate --init {study} --model {path}"),
                &format!("stiction simulate {study} --out {}", beside("study")),
            )
        }
        _ => return None,
    })
}

/// What leads on from a folder where one of its files is wanted: that file, what a result in it is good for, or one of its logs.
pub fn inside(takes: Takes, folder: &Path) -> Option<String> {
    let entries = std::fs::read_dir(folder).ok()?.take(MOST_NAMES).flatten();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    files.retain(|file| file.is_file());
    files.sort();
    let of = |wanted: Looks| files.iter().find(|file| looks(file) == Some(wanted));
    let wanted = match takes {
        Takes::Study => of(Looks::Study),
        Takes::Axis => of(Looks::Axis),
        Takes::Model => of(Looks::Model),
        Takes::Logs | Takes::Table => None,
    };
    if let Some(file) = wanted {
        return Some(format!("next: {}", crate::next::in_place_of(folder, file)));
    }
    let result = match takes {
        Takes::Table => of(Looks::Result),
        _ => of(Looks::Model),
    };
    result
        .or_else(|| of(Looks::Log).filter(|_| takes != Takes::Logs))
        .and_then(|file| next(takes, file))
        .or_else(|| crate::next::shown(folder))
}

/// Most names of a folder that are looked at.
const MOST_NAMES: usize = 10_000;

/// The logs that a result was made of and that are still there, as a shell takes them.
fn logs_of(result: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(result).unwrap_or_default();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    let inputs = json["inputs"].as_array().cloned().unwrap_or_default();
    let paths = inputs.iter().filter_map(|input| input["path"].as_str());
    let paths = paths.map(Path::new).filter(|path| path.is_file());
    paths.map(quoted_path).collect()
}

/// What a log that was not named is called in commands.
const A_LOG: &str = "log.csv";

/// The batch that makes a table of logs, and what follows it.
fn followed(logs: &str, out: &Path) -> String {
    let [table, out] = [&out.join("results.parquet"), out].map(quoted_path);
    let batch = format!("stiction batch {logs} --law lugre --out {out}");
    let drift = format!("stiction drift {table}");
    format!(
        "with every log that is to be followed:\n{}",
        in_turn(&batch, &drift)
    )
}

fn exported(model: &Path) -> String {
    let read = ModelFile::read(model).ok();
    let rate = read.and_then(|model| model.source.rate_hz);
    format!("next: {}", export(model, rate))
}

/// The command that writes a model as C, for a call at each sample of logs of this rate.
fn export(model: &Path, rate_hz: Option<f64>) -> String {
    let out = free_folder(&model.with_file_name("c"));
    let (model, cycle, out) = (quoted_path(model), cycle_option(rate_hz), quoted_path(&out));
    format!("stiction export {model} --target c{cycle} --out {out}")
}

/// What is wrong with the file of a command whose other arguments are missing, and what leads on from it.
pub fn refused(takes: Takes, file: &Path) -> Option<(Error, String)> {
    let error: Error = match takes {
        // A folder of logs is one of the inputs of a batch.
        Takes::Logs if file.is_dir() => return None,
        Takes::Logs
            if !path_text(file).contains(['*', '?', '[']) && file.symlink_metadata().is_err() =>
        {
            let error = Error::Usage {
                found: format!("{} is not there", path_text(file)).into(),
                allowed: "the path of a recording is wanted".into(),
            };
            return Some((error, crate::next::not_there(file)?));
        }
        Takes::Logs => refuse_as_log(file).err()?.into(),
        Takes::Model => ModelFile::read(file).err()?.into(),
        Takes::Axis => Axis::read(file).err()?.into(),
        Takes::Study => Study::read(file).err()?.into(),
        Takes::Table => return None,
    };
    let next = match &error {
        Error::File(FileError::OtherForm {
            instead: Some(instead),
            ..
        }) => {
            let out = match takes {
                Takes::Study => instead.with_file_name("study"),
                Takes::Axis => instead.with_file_name("plan"),
                _ => instead.with_extension(""),
            };
            let command = crate::next::in_place_of(file, instead);
            Some(format!("next: {command} --out {}", quoted_path(&out)))
        }
        _ if file.is_dir() => inside(takes, file),
        Error::File(FileError::OtherForm { .. }) => next(takes, file),
        _ => crate::next::missing(&error),
    };
    Some((error, next?))
}

/// What the command that was typed takes, and what stands behind it without an option before it.
pub fn typed() -> Option<(Takes, Vec<PathBuf>)> {
    let typed = Typed::new()?;
    Some((Takes::of(&typed.command)?, typed.files()))
}
