//! Work that the page asks for, as a command of the command line: the same words, the same engine, the same files.

mod check;
mod drift;
mod export;
mod identify;
mod plan;
mod simulate;

use crate::refused::Refused;
use crate::workspace::Workspace;
use serde::{Deserialize, Serialize};
use std::path::Path;
use stiction_files::Bundle;
use stiction_files::shell::quoted;
use stiction_identify::Observer;
use stiction_pages::bundle;
use stiction_workflows::{Error, Verdict};

/// A piece of work.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Asked {
    Check(check::Check),
    Drift(drift::Drift),
    Identify(identify::Identify),
    Simulate(simulate::Simulate),
    Plan(plan::Plan),
    Export(export::Export),
}

/// What became of it.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Done {
    pub verdict: Option<Verdict>,
    /// What the command line prints, or why it failed.
    pub text: String,
    /// The folder that the files are in; another one than was asked for where work was stopped and a complete result was there.
    pub folder: Option<String>,
    pub written: Vec<String>,
    /// What the page shows of it, where no file has it.
    pub json: Option<serde_json::Value>,
}

/// What a piece of work is done with.
pub struct Run<'a> {
    pub workspace: &'a Workspace,
    pub observer: &'a mut dyn Observer,
    /// Whether somebody has stopped it.
    pub stopped: &'a dyn Fn() -> bool,
}

/// What a piece of work is.
pub struct What<'a> {
    /// The command.
    pub kind: &'static str,
    /// The log or file that it is about.
    pub about: String,
    /// The folder that it writes into.
    pub out: Option<&'a str>,
}

/// A kind of work.
pub trait Work {
    /// What it is.
    fn what(&self) -> What<'_>;

    /// Arguments and options of the command line, but for the folder.
    fn words(&self, words: &mut Words);

    /// Does it.
    fn run(&self, run: Run<'_>) -> Result<Done, Refused>;
}

impl Asked {
    /// The work itself.
    pub fn work(&self) -> &dyn Work {
        match self {
            Asked::Check(work) => work,
            Asked::Drift(work) => work,
            Asked::Identify(work) => work,
            Asked::Simulate(work) => work,
            Asked::Plan(work) => work,
            Asked::Export(work) => work,
        }
    }

    /// The command line that does the same in the folder of the page.
    pub fn command(&self) -> String {
        let work = self.work();
        let what = work.what();
        let mut words = Words::of(what.kind);
        work.words(&mut words);
        words.option("--out", what.out);
        words.line()
    }
}

/// A command line.
pub struct Words(Vec<String>);

impl Words {
    /// Of a command of `stiction`.
    pub fn of(command: &str) -> Self {
        Words(vec!["stiction".into(), command.into()])
    }

    /// A word as a shell takes it.
    pub fn word(&mut self, word: &str) {
        self.0.push(quoted(word));
    }

    /// An option without a value, where it is set.
    pub fn flag(&mut self, name: &str, set: bool) {
        if set {
            self.0.push(name.into());
        }
    }

    /// An option with a value, where there is one.
    pub fn option(&mut self, name: &str, value: Option<&str>) {
        if let Some(value) = value {
            // An option is no file, which would be told from one.
            self.0.push(name.into());
            self.word(value);
        }
    }

    /// The same with a number.
    pub fn number(&mut self, name: &str, value: Option<f64>) {
        let value = value.map(|value| value.to_string());
        self.option(name, value.as_deref());
    }

    /// All of it.
    pub fn line(&self) -> String {
        self.0.join(" ")
    }
}

/// What was found, to be written.
struct Found<'a> {
    workspace: &'a Workspace,
    bundle: &'a Bundle,
    /// The folder, and its name.
    out: (&'a Path, &'a str),
    schema: &'a str,
    verdict: Verdict,
    stopped: bool,
}

impl Found<'_> {
    /// Writes it; `text` is told the folder that took it.
    fn done(self, text: impl FnOnce(&Path) -> String) -> Result<Done, Refused> {
        let (folder, written) = put(
            self.workspace,
            self.bundle,
            self.out,
            self.schema,
            self.stopped,
        )?;
        Ok(Done {
            verdict: Some(match self.stopped {
                true => Verdict::Interrupted,
                false => self.verdict,
            }),
            text: text(Path::new(&folder)),
            folder: Some(folder),
            written,
            json: None,
        })
    }
}

/// Writes files into a folder, or beside it where they are of work that was stopped and a complete result is there; the name of
/// the folder, and of the files in it.
fn put(
    workspace: &Workspace,
    bundle: &Bundle,
    (dir, name): (&Path, &str),
    schema: &str,
    stopped: bool,
) -> Result<(String, Vec<String>), Error> {
    let beside = bundle::beside_complete(bundle, dir, schema, stopped);
    let out = beside.as_deref().unwrap_or(dir);
    let written = bundle.write(out)?;
    let name = workspace.name(out).unwrap_or_else(|| name.into());
    let names = written.iter().filter_map(|path| path.file_name());
    let names = names.map(|name| name.to_string_lossy().into_owned());
    Ok((name, names.collect()))
}
