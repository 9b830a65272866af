//! `stiction identify`: friction from logs.

use super::{Done, Found, Run, What, Words, Work};
use crate::named::read_axis;
use crate::refused::Refused;
use crate::workspace::Workspace;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use stiction_files::result;
use stiction_files::{check_folder_of, check_inputs};
use stiction_pages::bundle;
use stiction_pages::text;
use stiction_parameters::LawKind;
use stiction_workflows::identify::Files;
use stiction_workflows::identify::{Method, Options, Procedures};

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Identify {
    logs: Vec<String>,
    axis: Option<String>,
    /// `None` lets the data choose.
    law: Option<String>,
    #[serde(default)]
    asymmetric: bool,
    method: Option<String>,
    /// What finds the parameters of each step before least squares; `None` takes least squares alone.
    search: Option<String>,
    /// Logs of constant velocities; empty takes the logs themselves.
    #[serde(default)]
    statics: Vec<String>,
    #[serde(default)]
    validate: Vec<String>,
    split: Option<f64>,
    out: String,
}

impl Work for Identify {
    fn what(&self) -> What<'_> {
        What {
            kind: "identify",
            about: match self.logs.as_slice() {
                [] => self.axis.clone().unwrap_or_default(),
                logs => logs.join(", "),
            },
            out: Some(&self.out),
        }
    }

    fn words(&self, words: &mut Words) {
        self.logs.iter().for_each(|log| words.word(log));
        words.option("--axis", self.axis.as_deref());
        words.option("--law", self.law.as_deref());
        words.flag("--asymmetric", self.asymmetric);
        words.option("--method", self.method.as_deref());
        words.option("--search", self.search.as_deref());
        for (name, logs) in [("--static", &self.statics), ("--validate", &self.validate)] {
            words.flag(name, !logs.is_empty());
            logs.iter().for_each(|log| words.word(log));
        }
        words.number("--split", self.split);
    }

    fn run(&self, run: Run<'_>) -> Result<Done, Refused> {
        let dir = run.workspace.place(&self.out)?;
        let schema = result::SCHEMA;
        check_folder_of(&dir, schema, false)?;
        let (files, statics) = self.files(run.workspace, &dir)?;
        let options = self.options(statics)?;
        let outcome = stiction_workflows::identify::identify(&files, &options, run.observer)?;
        let found = Found {
            workspace: run.workspace,
            bundle: &bundle::identification_in(&outcome, &dir),
            out: (&dir, &self.out),
            schema,
            verdict: outcome.verdict(),
            stopped: (run.stopped)(),
        };
        found.done(|_| text::outcome(&outcome))
    }
}

impl Identify {
    /// Logs, axis file and logs of constant velocities, all of the workspace and none of them in the folder for the result.
    fn files(&self, workspace: &Workspace, dir: &Path) -> Result<(Files, Vec<PathBuf>), Refused> {
        let all = |names: &[String]| -> Result<Vec<PathBuf>, Refused> {
            names.iter().map(|name| workspace.file(name)).collect()
        };
        let axis = self.axis.as_ref().map(|axis| workspace.file(axis));
        let files = Files {
            logs: all(&self.logs)?,
            validate: all(&self.validate)?,
            axis: axis.transpose()?,
        };
        let statics = all(&self.statics)?;
        let logs = || files.logs.iter().chain(&files.validate).chain(&statics);
        if let Some(axis) = &self.axis {
            let logs: Vec<&Path> = logs().map(PathBuf::as_path).collect();
            let read = read_axis(workspace, axis, &logs)?;
            check_inputs(dir, read.logs.iter().map(|log| &log.file))?;
        }
        check_inputs(dir, logs().chain(&files.axis))?;
        Ok((files, statics))
    }

    fn options(&self, statics: Vec<PathBuf>) -> Result<Options, Refused> {
        let unknown = |what: &str, name: &str| Refused::bad(format!("{name}: no such {what}"));
        let mut options = Options::default();
        options.law = match self.law.as_deref() {
            None | Some("auto") => None,
            Some(name) => Some(LawKind::from_name(name).ok_or_else(|| unknown("law", name))?),
        };
        options.asymmetric = self.asymmetric;
        options.split = self.split;
        options.procedures = Procedures {
            method: match self.method.as_deref() {
                None => Procedures::default().method,
                Some(name) => Method::from_name(name).ok_or_else(|| unknown("method", name))?,
            },
            statics,
            ..Procedures::default()
        };
        options.searching.search = match self.search.as_deref() {
            None => None,
            Some(name) => match Method::from_name(name) {
                Some(Method::Searched(name)) => Some(name),
                _ => return Err(unknown("search", name)),
            },
        };
        Ok(options)
    }
}
