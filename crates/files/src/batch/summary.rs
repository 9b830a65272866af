//! `batch.json`: what a batch was, and how it ended. Schema `stiction.batch/1`, only ever extended.

use super::apart::Apart;
use crate::shell::{free_folder, quoted, quoted_path};
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
    /// First of the identified that is not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub doubted: Option<Named>,
    /// Of all, taken from an earlier call.
    pub taken: usize,
    /// Of all, copies of another of them: the same bytes with the same axis file.
    #[serde(default)]
    pub copies: usize,
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
        let settings = self.settings(|_| true);
        format!("{command}{settings} --out {} --resume", quoted_path(dir))
    }

    /// The command that identifies one of the logs by itself, as it was here, into a folder that is free.
    pub fn single(&self, log: &Named) -> String {
        let settings = self.settings(|name| !["axis", "reports"].contains(&name));
        let out = quoted_path(&free_folder(Path::new("result")));
        format!(
            "stiction identify {}{settings} --out {out}",
            log.arguments()
        )
    }

    /// The options that are not the defaults, as they are typed.
    fn settings(&self, wanted: impl Fn(&str) -> bool) -> String {
        // The file may be anyone's: no other word of it becomes part of a command.
        let wanted =
            |(name, _): &(&String, &String)| OPTIONS.contains(&name.as_str()) && wanted(name);
        let typed = |(name, value): (&String, &String)| match (name.as_str(), value.as_str()) {
            ("law", "auto") | ("method", "separable") | ("seed", "0") | (_, "false") => {
                String::new()
            }
            (_, "true") => format!(" --{name}"),
            _ => format!(" --{name} {}", quoted(value)),
        };
        self.options.iter().filter(wanted).map(typed).collect()
    }
}

/// Options of a batch that its command is given again with.
const OPTIONS: [&str; 7] = [
    "asymmetric",
    "axis",
    "law",
    "method",
    "reports",
    "seed",
    "split",
];

/// One log of a batch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Named {
    /// Its path.
    pub path: String,
    /// Its axis file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<String>,
}

impl Named {
    /// Log and axis file as arguments of a command.
    pub fn arguments(&self) -> String {
        let axis = self.axis.as_ref();
        let axis = axis.map_or(String::new(), |axis| format!(" --axis {}", quoted(axis)));
        format!("{}{axis}", quoted(&self.path))
    }
}

/// Logs that failed in one way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// The code of their errors.
    pub code: Code,
    /// How many.
    pub logs: usize,
    /// The first of them.
    #[serde(flatten)]
    pub log: Named,
    /// What was said of it.
    pub first: String,
}
