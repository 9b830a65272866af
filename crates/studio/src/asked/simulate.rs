//! `stiction simulate`: a study.

use super::{Done, Found, Run, What, Words, Work};
use crate::named::read_study;
use crate::refused::Refused;
use serde::Deserialize;
use std::path::PathBuf;
use stiction_files::{check_folder_of, check_inputs, study};
use stiction_pages::bundle;
use stiction_pages::text;

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Simulate {
    study: String,
    out: String,
}

impl Work for Simulate {
    fn what(&self) -> What<'_> {
        What {
            kind: "simulate",
            about: self.study.clone(),
            out: Some(&self.out),
        }
    }

    fn words(&self, words: &mut Words) {
        words.word(&self.study);
    }

    fn run(&self, run: Run<'_>) -> Result<Done, Refused> {
        let dir = run.workspace.place(&self.out)?;
        let schema = study::result::SCHEMA;
        check_folder_of(&dir, schema, false)?;
        let read = read_study(run.workspace, &self.study)?;
        let inputs: Vec<PathBuf> = read.inputs().map(PathBuf::from).collect();
        check_inputs(&dir, &inputs)?;
        let outcome = stiction_workflows::study::simulate(&read, run.observer);
        let found = Found {
            workspace: run.workspace,
            bundle: &bundle::study(&outcome),
            out: (&dir, &self.out),
            schema,
            verdict: outcome.verdict(),
            stopped: (run.stopped)(),
        };
        found.done(|_| text::study(&outcome))
    }
}
