//! Work that the page asks for, as a command of the command line: the same words, the same engine, the same files.

mod check;
mod export;
mod identify;
mod plan;
mod simulate;

use crate::refused::Refused;
use crate::workspace::Workspace;
use serde::Deserialize;
use std::path::Path;
use stiction::commands::Bundle;
use stiction::commands::shell::quoted;
use stiction::{Error, Observer, Verdict, bundle};

/// A piece of work.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Asked {
    Check(check::Check),
    Identify(identify::Identify),
    Simulate(simulate::Simulate),
    Plan(plan::Plan),
    Export(export::Export),
}

/// What became of it.
#[derive(Clone, Debug)]
pub struct Done {
    pub verdict: Verdict,
    /// What the command line prints.
    pub text: String,
    /// The folder that the files are in; another one than was asked for where work was stopped and a complete result was there.
    pub folder: Option<String>,
    pub written: Vec<String>,
    /// The outcome as `--json` gives it, where no file has it.
    pub json: Option<serde_json::Value>,
}

/// What a piece of work is done with.
pub struct Run<'a> {
    pub workspace: &'a Workspace,
    pub observer: &'a mut dyn Observer,
    /// Whether somebody has stopped it.
    pub stopped: &'a dyn Fn() -> bool,
}

/// A kind of work.
trait Work {
    /// What it is called.
    fn kind(&self) -> &'static str;

    /// The file that it is about.
    fn about(&self) -> String;

    /// The folder that it writes into.
    fn out(&self) -> Option<&str>;

    /// Arguments and options of the command line, but for the folder.
    fn words(&self, words: &mut Words);

    /// Does it.
    fn run(&self, run: Run<'_>) -> Result<Done, Refused>;
}

impl Asked {
    fn work(&self) -> &dyn Work {
        match self {
            Asked::Check(work) => work,
            Asked::Identify(work) => work,
            Asked::Simulate(work) => work,
            Asked::Plan(work) => work,
            Asked::Export(work) => work,
        }
    }

    /// What it is called.
    pub fn kind(&self) -> &'static str {
        self.work().kind()
    }

    /// The file that it is about.
    pub fn about(&self) -> String {
        self.work().about()
    }

    /// The folder that it writes into.
    pub fn out(&self) -> Option<&str> {
        self.work().out()
    }

    /// The command line that does the same in the folder of the page.
    pub fn command(&self) -> String {
        let mut words = Words::of(self.kind());
        self.work().words(&mut words);
        words.option("--out", self.out());
        words.line()
    }

    /// Does it.
    pub fn run(&self, run: Run<'_>) -> Result<Done, Refused> {
        self.work().run(run)
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
        let (folder, written) = put(self.bundle, self.out, self.schema, self.stopped)?;
        Ok(Done {
            verdict: match self.stopped {
                true => Verdict::Interrupted,
                false => self.verdict,
            },
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
    bundle: &Bundle,
    (dir, name): (&Path, &str),
    schema: &str,
    stopped: bool,
) -> Result<(String, Vec<String>), Error> {
    let beside = bundle::beside_complete(bundle, dir, schema, stopped);
    let out = beside.as_deref().unwrap_or(dir);
    let written = bundle.write(out)?;
    let name = match (beside.as_ref(), name.rsplit_once('/')) {
        (None, _) => name.to_string(),
        // Beside a folder it is named after that, within it `interrupted`.
        (Some(other), before) => {
            let last = other.file_name().unwrap_or_default().to_string_lossy();
            match (other.starts_with(dir), before) {
                (true, _) => format!("{name}/{last}"),
                (false, Some((before, _))) => format!("{before}/{last}"),
                (false, None) => last.into_owned(),
            }
        }
    };
    let names = written.iter().filter_map(|path| path.file_name());
    let names = names.map(|name| name.to_string_lossy().into_owned());
    Ok((name, names.collect()))
}
