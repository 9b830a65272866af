//! `stiction check`: what a log can determine.

use super::{Done, Run, Words, Work};
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
    fn kind(&self) -> &'static str {
        "check"
    }

    fn about(&self) -> String {
        self.log.clone()
    }

    fn out(&self) -> Option<&str> {
        None
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
            verdict: found.verdict(),
            text: text::check(&found),
            folder: None,
            written: Vec::new(),
            json: serde_json::to_value(&found).ok(),
        })
    }
}
