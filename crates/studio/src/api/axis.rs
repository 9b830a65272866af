//! Which axis file a log is read with. Logs of one machine share `axis.toml`; a log of another machine has a file of its own,
//! named after it: `slide.csv` has `slide.axis.toml`.

use super::{Answer, App, blocking, read};
use crate::given::{Json, Query};
use crate::named::read_axis;
use crate::refused::Refused;
use crate::workspace::Workspace;
use axum::extract::State;
use serde::{Deserialize, Serialize};
use std::path::Path;
use stiction_files::Axis;
use stiction_files::{visible, write_atomic};
use stiction_workflows::check;
use stiction_workflows::source::table;

/// The axis file of a folder, unless a log has its own.
const USUAL: &str = "axis.toml";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Named {
    log: String,
}

/// The axis file of a log.
#[derive(Debug, Default, PartialEq, Serialize)]
pub struct Which {
    /// None where nothing is known of its axis.
    axis: Option<String>,
    /// An axis file that is there and is of another log, as its columns show.
    not: Option<String>,
}

/// Which axis file a log is read with: its own, one that lists it, or that of the folder where the log has the columns of it.
pub async fn which(State(shared): App, Query(asked): Query<Named>) -> Answer {
    read(shared, move |shared| {
        let (workspace, log) = (&shared.workspace, asked.log.as_str());
        let path = workspace.file(log)?;
        let there = |name: &str| workspace.file(name).is_ok();
        let own = own_of(log);
        if there(&own) {
            return Ok(Which::of(own));
        }
        if let Some(listing) = listing(workspace, &path) {
            return Ok(Which::of(listing));
        }
        if !there(USUAL) {
            return Ok(Which::default());
        }
        let understood = shared.logs.log(workspace, log, Some(USUAL));
        let understood = understood.is_ok_and(|found| found.about.refused.is_none());
        Ok(match understood || is_of(workspace, &path) {
            true => Which::of(USUAL.into()),
            false => Which {
                axis: None,
                not: Some(USUAL.into()),
            },
        })
    })
    .await
}

/// Begins an axis file for a log alone, as `stiction check --init` does, and says its name.
pub async fn begin(State(shared): App, Json(asked): Json<Named>) -> Answer {
    blocking(shared, move |shared| {
        let log = shared.workspace.file(&asked.log)?;
        let own = own_of(&asked.log);
        shared.alone(|| {
            let (file, text) = shared.workspace.axis(&own)?;
            if text.is_some() {
                return Err(Refused::conflict(format!(
                    "{own}: is there already; choose it beside the logs"
                )));
            }
            let text = check::init(&log, None)?.text;
            write_atomic(&file, visible::toml(text).as_bytes())?;
            Ok(own)
        })
    })
    .await
}

impl Which {
    fn of(axis: String) -> Self {
        Self {
            axis: Some(axis),
            not: None,
        }
    }
}

/// The name of the axis file that is of a log alone.
fn own_of(log: &str) -> String {
    let (folder, name) = match log.rsplit_once('/') {
        Some((folder, name)) => (format!("{folder}/"), name),
        None => (String::new(), log),
    };
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    format!("{folder}{stem}.axis.toml")
}

/// The first axis file of the folder that lists a log.
fn listing(workspace: &Workspace, log: &Path) -> Option<String> {
    let entries = workspace.list().into_iter();
    let axes = entries.filter(|entry| entry.kind == "axis");
    let mut lists = axes.filter(|entry| {
        let axis = workspace.file(&entry.name).ok().map(Axis::read);
        axis.is_some_and(|axis| axis.is_ok_and(|axis| axis.listed(log).is_some()))
    });
    lists.next().map(|entry| entry.name)
}

/// Whether a log has the columns that the axis file of the folder names; a file that cannot be read tells nothing of its logs.
fn is_of(workspace: &Workspace, log: &Path) -> bool {
    let Ok(axis) = read_axis(workspace, USUAL, &[log]) else {
        return true;
    };
    let found = table(log, &axis.of_whole(log));
    found.is_ok_and(|table| axis.mapping.is_of(&table))
}
