//! A log beside the plan that it was recorded by.

use serde::{Deserialize, Serialize};

/// What of a planned motion the logs show, and what was expected of them beside what was found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlannedEntry {
    /// The `plan.toml`, as given.
    pub path: String,
    /// Its SHA-256.
    pub sha256: String,
    /// The log that shows most of its pieces; absent where none shows any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub log: Option<String>,
    /// Pace at which it ran, 1 as planned; absent where no log shows it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pace: Option<f64>,
    /// Its pieces in their order; empty at another pace than 1.
    pub pieces: Vec<PieceEntry>,
    /// Expected and found for each parameter that was planned for and is in the result.
    pub parameters: Vec<PlannedParameter>,
}

/// A piece in the log.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PieceEntry {
    /// When it starts in the plan, s.
    pub planned_start: f64,
    /// When it starts in the log, s since its first sample; absent where it is missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<f64>,
    /// s
    pub duration: f64,
    /// `whole`, `cut-short` or `missing`.
    pub status: String,
    /// Part of its amplitude that is in the log; 0 of one that friction holds.
    pub followed: f64,
}

/// Half of a 95 % interval, percent of the value: expected, and found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlannedParameter {
    /// Name.
    pub name: String,
    /// Of a term beside the law: the parameter of which, at its most, it is given in percent; absent of others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// On half of the axes at most.
    pub expected_percent: f64,
    /// On nine of ten axes at most.
    pub expected90_percent: f64,
    /// Found; `null` without an interval.
    pub found_percent: Option<f64>,
    /// `as-expected`, `wider` than on nine of ten axes, or `open`: not identifiable.
    pub status: String,
}
