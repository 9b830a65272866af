//! `stiction check`: what a log can determine; of two, what changed from one to the other.

use super::{Done, Run, What, Words, Work};
use crate::named::read_axis;
use crate::refused::Refused;
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use stiction_pages::text;
use stiction_workflows::check::{LogCheck, TrackingChange};

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Check {
    log: String,
    /// A later log, compared with it.
    after: Option<String>,
    axis: Option<String>,
}

impl Check {
    fn logs(&self) -> impl Iterator<Item = &str> {
        [Some(self.log.as_str()), self.after.as_deref()]
            .into_iter()
            .flatten()
    }
}

impl Work for Check {
    fn what(&self) -> What<'_> {
        What {
            kind: "check",
            about: self.logs().collect::<Vec<_>>().join(", "),
            out: None,
        }
    }

    fn words(&self, words: &mut Words) {
        self.logs().for_each(|log| words.word(log));
        words.option("--axis", self.axis.as_deref());
    }

    fn run(&self, run: Run<'_>) -> Result<Done, Refused> {
        let logs = self.logs().map(|log| run.workspace.file(log));
        let logs = logs.collect::<Result<Vec<_>, _>>()?;
        if let Some(axis) = &self.axis {
            let logs: Vec<&Path> = logs.iter().map(PathBuf::as_path).collect();
            read_axis(run.workspace, axis, &logs)?;
        }
        let axis = self.axis.as_ref().map(|axis| run.workspace.file(axis));
        let axis = axis.transpose()?;
        let found = stiction_workflows::check::check(&logs, axis.as_deref(), run.observer)?;
        Ok(Done {
            verdict: Some(found.verdict()),
            json: Some(json!({
                "logs": found.logs.iter().map(|log| one(log, axis.as_deref())).collect::<Value>(),
                "change": found.tracking.first().map(|change| changed(change, &found.logs[0].kind)),
            })),
            ..Done::default()
        })
    }
}

/// What the page shows of a change.
fn changed(change: &TrackingChange, kind: &str) -> Value {
    let unit = if kind == "rotary" { "rad" } else { "m" };
    let told = text::changed(change, kind);
    let row = |row: &text::ChangedRow| {
        json!({
            "name": row.name,
            "before": row.before,
            "after": row.after,
            "change_percent": row.change_percent,
        })
    };
    json!({
        "verdict": told.verdict,
        "good": told.good,
        "unit": unit,
        "rows": told.rows.iter().map(row).collect::<Value>(),
        "notes": told.notes,
        "peaks": [&change.before.peaks, &change.after.peaks],
    })
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
        "not_tracked": log.not_tracked,
        "rows": told.rows.iter().map(row).collect::<Value>(),
        "findings": log.findings,
        "conditioning": log.conditioning,
        "next": told.next,
        "command": told.command,
    })
}
