//! `batch.json`: what a batch was, and how it ended. Schema `stiction.batch/1`, only ever extended.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
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
    /// Logs of the batch.
    pub logs: usize,
    /// Of these, identified.
    pub identified: usize,
    /// Of the identified, trustworthy.
    pub trustworthy: usize,
    /// Of all, taken from an earlier call.
    pub taken: usize,
    /// Of the others, how many failed with which code, most first.
    pub failed: Vec<Failure>,
}

/// Logs that failed in one way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// The code of their errors.
    pub code: Code,
    /// How many.
    pub logs: usize,
    /// Path of the first of them.
    pub path: String,
    /// What was said of it.
    pub first: String,
}
