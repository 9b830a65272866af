//! `batch.json`: what a batch was, and how it ended. Schema `stiction.batch/1`, only ever extended.

use super::apart::Apart;
use crate::shell::{quoted, quoted_path};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;
use stiction_codes::Code;

/// Name of the schema.
pub const SCHEMA: &str = "stiction.batch/1";

/// The whole file; described key by key in `docs/fleet.md`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BatchFile {
    /// `stiction.batch/1`.
    pub schema: String,
    /// Version of stiction.
    pub version: String,
    /// `running` (or ended by force), `interrupted` or `complete`.
    pub status: String,
    /// What the logs were identified with.
    pub options: BTreeMap<String, String>,
    /// Folders, logs, patterns and lists that it was made of, as they were given.
    #[serde(default)]
    pub inputs: Vec<String>,
    /// Logs of the batch.
    pub logs: usize,
    /// Of these, identified.
    pub identified: usize,
    /// Of the identified, trustworthy.
    pub trustworthy: usize,
    /// Of all, taken from an earlier call.
    pub taken: usize,
    /// Of the others, how many failed with which code, most first.
    pub failed: Vec<Failure>,
    /// Parameters that logs with one axis file have more than a hundred times apart: a unit of one of them is probably wrong.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub apart: Vec<Apart>,
}

impl BatchFile {
    /// The command that goes on with it in its folder, from the folder in which it was called.
    pub fn command(&self, dir: &Path) -> String {
        self.command_with(dir, None)
    }

    /// The same with another log; none where a folder or a pattern of the inputs takes it by itself.
    pub fn command_with(&self, dir: &Path, another: Option<&str>) -> String {
        let mut command = String::from("stiction batch");
        for input in self.inputs.iter().map(String::as_str).chain(another) {
            command += &format!(" {}", quoted(input));
        }
        for (name, value) in &self.options {
            match (name.as_str(), value.as_str()) {
                ("law", "auto") | ("method", "separable") | ("seed", "0") | (_, "false") => {}
                (_, "true") => command += &format!(" --{name}"),
                _ => command += &format!(" --{name} {}", quoted(value)),
            }
        }
        format!("{command} --out {} --resume", quoted_path(dir))
    }
}

/// Logs that failed in one way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// The code of their errors.
    pub code: Code,
    /// How many.
    pub logs: usize,
    /// Path of the first of them.
    pub path: String,
    /// What was said of it.
    pub first: String,
}
