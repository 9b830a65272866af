//! `stiction check`: what a log can determine.

use super::{Done, Run, What, Words, Work};
use crate::named::read_axis;
use crate::refused::Refused;
use serde::Deserialize;
use stiction::commands::text;

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Check {
    log: String,
    axis: Option<String>,
}

impl Work for Check {
    fn what(&self) -> What<'_> {
        What {
            kind: "check",
            about: self.log.clone(),
            out: None,
        }
    }

    fn words(&self, words: &mut Words) {
        words.word(&self.log);
        words.option("--axis", self.axis.as_deref());
    }

    fn run(&self, run: Run<'_>) -> Result<Done, Refused> {
        let logs = [run.workspace.file(&self.log)?];
        if let Some(axis) = &self.axis {
            read_axis(run.workspace, axis, &[&logs[0]])?;
        }
        let axis = self.axis.as_ref().map(|axis| run.workspace.file(axis));
        let axis = axis.transpose()?;
        let found = stiction::commands::check::check(&logs, axis.as_deref(), run.observer)?;
        Ok(Done {
            verdict: Some(found.verdict()),
            text: text::check(&found),
            json: serde_json::to_value(&found).ok(),
            ..Done::default()
        })
    }
}
