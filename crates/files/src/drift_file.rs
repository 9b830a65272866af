//! `drift.json`: what changed on which machine. Schema `stiction.drift/1`, only ever extended.

use crate::batch::Apart;
use serde::{Deserialize, Serialize};

/// Name of the schema.
pub const SCHEMA: &str = "stiction.drift/1";

/// The whole file; described key by key in `docs/fleet.md`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DriftFile {
    /// `stiction.drift/1`.
    pub schema: String,
    /// Version of stiction.
    pub version: String,
    /// The table.
    pub input: Table,
    /// Part of quiet machines that may be alarmed within the horizon.
    pub alarmed: f64,
    /// The horizon, days.
    pub horizon_days: f64,
    /// Logs from which the reference of a machine is taken.
    pub reference_logs: usize,
    /// Whether logs are in the order of their times; else they are in that of the table, a day from each to the next.
    pub timed: bool,
    /// Where logs without a time have one: `names`, dates in their names; `files`, when they were written.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub times: Vec<String>,
    /// Machines.
    pub machines: usize,
    /// Machines with too few logs for all of their parameters.
    pub too_short: usize,
    /// What each parameter does by itself.
    pub noise: Vec<NoiseEntry>,
    /// Parameters of which it cannot be told whether they changed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unclear: Vec<Unclear>,
    /// What changed, and what is beyond a limit; the largest over its limit first.
    pub alarms: Vec<Alarm>,
    /// Parameters that logs with one axis file have more than a hundred times apart: a unit of one of them is probably wrong.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub apart: Vec<Apart>,
}

/// The table that was read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// Path as given.
    pub path: String,
    /// SHA-256, hexadecimal.
    pub sha256: String,
    /// Its logs.
    pub logs: usize,
    /// Of these, left out since nothing was identified of them.
    pub failed: usize,
    /// Of the others, those that name no machine: they are taken for logs of one.
    #[serde(default)]
    pub unnamed: usize,
}

/// What a parameter does where nothing changes. Sizes are parts of it where changes are relative, else in its unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NoiseEntry {
    /// Name.
    pub parameter: String,
    /// Law that it is of.
    pub law: String,
    /// SI unit.
    pub unit: String,
    /// Whether changes are counted as parts of it.
    pub relative: bool,
    /// Machines that were followed, and their logs.
    pub machines: usize,
    /// Logs of them.
    pub logs: usize,
    /// Standard deviation of the scatter between logs beyond their intervals.
    pub scatter: f64,
    /// Standard deviation of the slow wandering.
    pub wandering: f64,
    /// Its memory, days.
    pub memory_days: f64,
    /// Change for each unit of temperature; none without temperatures.
    pub by_temperature: Option<f64>,
    /// Deviations of the medians of 5, 10 and 20 logs from which on it has changed.
    pub limits: Vec<f64>,
}

/// A parameter of which it cannot be told whether it changed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unclear {
    /// Name.
    pub parameter: String,
    /// Law that it is of.
    pub law: String,
    /// Most logs of a machine that determine it.
    pub logs: usize,
    /// Whether these are too few; else they scatter so much that a change to double or half would not be seen.
    pub too_few: bool,
}

/// A change, or a level beyond a limit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Alarm {
    /// Machine; empty where the table names none.
    pub machine: String,
    /// Parameter.
    pub parameter: String,
    /// Law that it is of.
    pub law: String,
    /// SI unit.
    pub unit: String,
    /// `step`, `creep` or `limit`.
    pub kind: String,
    /// Time of the first log after it, or where the creep began, s; of a limit that of the last log.
    pub since: f64,
    /// Time of the log with which it was found, s.
    pub found: f64,
    /// That log.
    pub log: String,
    /// Its axis file.
    pub axis: Option<String>,
    /// Level before it, in the unit; of a limit the reference.
    pub before: f64,
    /// Level of the last logs when it was found, in the unit.
    pub after: f64,
    /// By how much it changed: a part where `relative`, else in the unit.
    pub size: f64,
    /// 95 % interval of the size; none of a limit.
    pub ci95: Option<[f64; 2]>,
    /// Whether the size is a part.
    pub relative: bool,
    /// The deviation over its limit, 1 or more.
    pub over: f64,
    /// The limit as it was given; none of a change.
    pub limit: Option<String>,
}

impl DriftFile {
    /// Machines that are alarmed.
    pub fn alarmed_machines(&self) -> usize {
        let mut names: Vec<&str> = self.alarms.iter().map(|a| a.machine.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        names.len()
    }
}
