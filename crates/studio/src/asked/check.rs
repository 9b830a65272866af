//! `stiction check`: what a log can determine.

use super::{Done, Run, What, Words, Work};
use crate::named::read_axis;
use crate::refused::Refused;
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::Path;
use stiction::commands::check::LogCheck;
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
            json: Some(json!({ "logs": logs_of(&found.logs, axis.as_deref()) })),
            ..Done::default()
        })
    }
}

fn logs_of(logs: &[LogCheck], axis: Option<&Path>) -> Value {
    logs.iter().map(|log| one(log, axis)).collect()
}

/// What the page shows of a log.
fn one(log: &LogCheck, axis: Option<&Path>) -> Value {
    let told = text::told(log, axis);
    let row = |row: &text::Row| {
        json!({
            "name": row.name,
            "symbol": row.symbol,
            "verdict": row.verdict,
            "value": row.value,
            "unit": row.unit,
            "remark": row.remark,
        })
    };
    json!({
        "refused": log.refused,
        "rows": told.rows.iter().map(row).collect::<Value>(),
        "findings": log.findings,
        "conditioning": log.conditioning,
        "next": told.next,
        "command": told.command,
    })
}
