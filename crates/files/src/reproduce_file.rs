//! `reproduce.json`: the numbers of published experiments beside their references. Schema `stiction.reproduce/1`.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Name of the schema.
pub const SCHEMA: &str = "stiction.reproduce/1";

/// What goes into `reproduce.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReproduceFile {
    /// `stiction.reproduce/1`.
    pub schema: String,
    /// Version of stiction.
    pub version: String,
    /// Which publication: `1995` or `paper`.
    pub name: String,
    /// `complete` or `interrupted`.
    #[serde(default = "complete")]
    pub status: String,
    /// Whether every number is within its tolerance.
    pub all_within: bool,
    /// Every number, in the order of the experiments.
    pub checks: Vec<CheckEntry>,
    /// Figures of ours beside claims of the publication, which are not of the same experiment.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub claims: Vec<ClaimEntry>,
    /// Every run of an experiment with its metrics: controllers and compensations beside each other.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub runs: Vec<RunEntry>,
    /// Every search of parameters with its seed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub searches: Vec<SearchEntry>,
    /// Experiments that could not be run on this axis, and why.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub not_run: Vec<String>,
    /// What was assumed where the publication gives no number.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub assumptions: Vec<String>,
}

fn complete() -> String {
    "complete".into()
}

/// One number beside its reference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheckEntry {
    /// Letter or name of the experiment.
    pub experiment: String,
    /// What it is.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// What it should be.
    pub reference: f64,
    /// What it is here.
    pub found: f64,
    /// How far off it may be, in `unit`.
    pub tolerance: f64,
    /// Whether the difference is within the tolerance.
    pub within: bool,
}

/// A metric of ours without and with compensation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClaimEntry {
    /// What it is.
    pub name: String,
    /// SI unit, or m/min for a feed.
    pub unit: String,
    /// The controller of both runs.
    #[serde(default)]
    pub controller: String,
    /// What compensates.
    pub compensation: String,
    /// Without compensation.
    pub without: f64,
    /// With it.
    pub with: f64,
    /// By how much it is less, percent.
    pub reduction_percent: f64,
    /// What the publication claims, in its words; may be empty.
    pub published: String,
}

/// A run of an experiment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunEntry {
    /// Name of the experiment.
    pub experiment: String,
    /// The controller.
    pub controller: String,
    /// What compensates friction.
    pub compensation: String,
    /// What came of it.
    pub metrics: Vec<MetricEntry>,
}

/// A metric of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MetricEntry {
    /// What it is.
    pub name: String,
    /// SI unit, or m/min for a feed.
    pub unit: String,
    /// Its value.
    pub value: f64,
}

/// A search of parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SearchEntry {
    /// Name of the experiment.
    pub experiment: String,
    /// Name of the method.
    pub method: String,
    /// Its seed.
    pub seed: u64,
    /// Least cost J of the method itself, dimensionless.
    pub cost: f64,
    /// Evaluations until J was at most 3e-3.
    #[serde(default)]
    pub evaluations_to_3e3: Option<f64>,
    /// Evaluations until J was at most 1e-3.
    pub evaluations_to_1e3: Option<f64>,
    /// What the method found by itself, SI.
    pub own: BTreeMap<String, f64>,
    /// What stands after least squares, where they follow, SI.
    pub found: BTreeMap<String, f64>,
}

impl ReproduceFile {
    /// A complete reproduction of a publication, in which nothing has been done yet.
    pub fn of(name: &str) -> Self {
        ReproduceFile {
            schema: SCHEMA.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            name: name.into(),
            status: complete(),
            all_within: true,
            checks: Vec::new(),
            claims: Vec::new(),
            runs: Vec::new(),
            searches: Vec::new(),
            not_run: Vec::new(),
            assumptions: Vec::new(),
        }
    }
}

impl CheckEntry {
    /// A number that may be off by the part `relative` of its reference.
    pub fn relative(
        experiment: &str,
        name: &str,
        unit: &str,
        reference: f64,
        found: f64,
        relative: f64,
    ) -> Self {
        let tolerance = relative * reference.abs();
        CheckEntry {
            experiment: experiment.into(),
            name: name.into(),
            unit: unit.into(),
            reference,
            found,
            tolerance,
            within: (found - reference).abs() <= tolerance,
        }
    }
}
