//! The state of a search in a file: the first line says what logs and settings it belongs to, the second holds it.

use crate::error::Error;
use crate::wording::{Setting, Wording};
use serde::{Deserialize, Serialize};
use std::io::Read;
use std::path::Path;
use stiction_files::sha256_of;
use stiction_files::{check_writable, write_atomic};
use stiction_formats::regular;
use stiction_search::{Finished, Run, Searcher};

/// Name of the schema.
const SCHEMA: &str = "stiction.checkpoint/1";
/// Largest checkpoint file that is read, bytes; a state is a few thousand points.
const LARGEST_CHECKPOINT: u64 = 1 << 28;

/// What the course of a search depends on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Settings {
    pub version: String,
    pub method: String,
    pub cost: String,
    pub seed: u64,
    pub evaluations: u64,
    /// SHA-256 of each log.
    pub inputs: Vec<String>,
    /// SHA-256 of the law, its terms, the box and the conditioning.
    pub axis: String,
    pub samples: usize,
}

#[derive(Serialize, Deserialize)]
struct Head {
    schema: String,
    settings: Settings,
    /// SHA-256 of the settings and the second line.
    sha256: String,
}

/// SHA-256 of all that a checkpoint says.
fn seal(settings: &Settings, state: &str) -> String {
    let settings = serde_json::to_string(settings).expect("plain data");
    sha256_of(format!("{settings}\n{state}").as_bytes())
}

/// Where the state goes, and what it belongs to.
pub(super) struct Checkpoint<'a> {
    pub settings: Settings,
    pub file: Option<&'a Path>,
}

type State = Run<Finished<Searcher>>;

impl Checkpoint<'_> {
    /// Keeps the state, if it is to be kept.
    pub fn write(&self, run: &State) -> Result<(), Error> {
        let Some(file) = self.file else {
            return Ok(());
        };
        let state = serde_json::to_string(run).expect("plain data");
        let head = Head {
            schema: SCHEMA.into(),
            settings: self.settings.clone(),
            sha256: seal(&self.settings, &state),
        };
        let head = serde_json::to_string(&head).expect("plain data");
        Ok(write_atomic(file, format!("{head}\n{state}\n").as_bytes())?)
    }

    /// Takes a state up again.
    pub fn read(&self, file: &Path) -> Result<State, Error> {
        let refused = |found: String, allowed: Wording| Error::Checkpoint {
            file: file.to_path_buf(),
            found,
            allowed,
        };
        let whole = || {
            Wording::from([
                "a file that ".into(),
                Setting::Checkpoint.into(),
                " wrote, unchanged".into(),
            ])
        };
        let damaged = |what: &str| refused(what.into(), whole());
        let text = text(file).map_err(|e| refused(e, whole()))?;
        let mut lines = text.lines();
        let head: Head = lines
            .next()
            .and_then(|line| serde_json::from_str(line).ok())
            .ok_or_else(|| damaged("no checkpoint"))?;
        if head.schema != SCHEMA {
            return Err(refused(format!("schema {}", head.schema), SCHEMA.into()));
        }
        let state = lines.next().unwrap_or_default();
        if seal(&head.settings, state) != head.sha256 {
            return Err(damaged("its settings or its state are damaged"));
        }
        if let Some((what, theirs, ours)) = differs(&head.settings, &self.settings) {
            return Err(refused(
                format!("belongs to a search with {what} {theirs}, this one has {ours}"),
                [
                    "the same logs and options, but for ".into(),
                    Setting::Time.into(),
                    ", ".into(),
                    Setting::Target.into(),
                    ", the threads and the files written".into(),
                ]
                .into(),
            ));
        }
        serde_json::from_str(state).map_err(|_| damaged("the state cannot be read"))
    }
}

/// Refuses a place where a checkpoint cannot be written, or would replace something else: better said before
/// a long search than after it.
pub(super) fn check_place(file: &Path) -> Result<(), Error> {
    let refused = |found: &str| {
        Err(Error::Checkpoint {
            file: file.to_path_buf(),
            found: found.into(),
            allowed: [
                Setting::Checkpoint.into(),
                " takes a new file, or one that ".into(),
                Setting::Checkpoint.into(),
                " wrote".into(),
            ]
            .into(),
        })
    };
    if let Ok(there) = file.symlink_metadata() {
        if !there.is_file() {
            return refused("is not a file and would be replaced");
        }
        if !is_checkpoint(file) {
            return refused("is something else and would be replaced");
        }
    }
    Ok(check_writable(file)?)
}

fn is_checkpoint(file: &Path) -> bool {
    /// What the first line begins with, whatever the settings of its version.
    #[derive(Deserialize)]
    struct Begin {
        schema: String,
    }
    let Ok(text) = text(file) else { return false };
    let head = text.lines().next().unwrap_or_default();
    serde_json::from_str::<Begin>(head)
        .is_ok_and(|head| head.schema.starts_with("stiction.checkpoint/"))
}

fn text(file: &Path) -> Result<String, String> {
    let describe = |e: std::io::Error| format!("cannot be read ({e})");
    regular(file).map_err(|e| e.to_string())?;
    let mut text = String::new();
    let file = std::fs::File::open(file).map_err(describe)?;
    let many = file.take(LARGEST_CHECKPOINT + 1).read_to_string(&mut text);
    match many.map_err(describe)? {
        n if n as u64 > LARGEST_CHECKPOINT => Err("too long".into()),
        _ => Ok(text),
    }
}

/// The first setting that differs, theirs and ours.
fn differs(a: &Settings, b: &Settings) -> Option<(&'static str, String, String)> {
    let short = |inputs: &[String]| {
        let each: Vec<&str> = inputs.iter().map(|s| s.get(..12).unwrap_or(s)).collect();
        each.join(", ")
    };
    let all = [
        ("version", a.version.clone(), b.version.clone()),
        ("method", a.method.clone(), b.method.clone()),
        ("cost", a.cost.clone(), b.cost.clone()),
        ("seed", a.seed.to_string(), b.seed.to_string()),
        (
            "evaluations",
            a.evaluations.to_string(),
            b.evaluations.to_string(),
        ),
        ("logs of SHA-256", short(&a.inputs), short(&b.inputs)),
        ("samples", a.samples.to_string(), b.samples.to_string()),
        (
            "law, axis or box of SHA-256",
            short(std::slice::from_ref(&a.axis)),
            short(std::slice::from_ref(&b.axis)),
        ),
    ];
    all.into_iter().find(|(_, a, b)| a != b)
}
