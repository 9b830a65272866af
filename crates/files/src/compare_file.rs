//! `compare.json`: methods beside each other. Schema `stiction.compare/1`, only ever extended.

use crate::result::Evaluations;
use serde::{Deserialize, Serialize};

/// Name of the schema.
pub const SCHEMA: &str = "stiction.compare/1";

/// Lower quartile, median and upper quartile; `null` where there is nothing to take them of.
pub type Quartiles = Option<[f64; 3]>;

/// The whole file; described key by key in `docs/compare.md`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CompareFile {
    /// `stiction.compare/1`.
    pub schema: String,
    /// Version of stiction.
    pub version: String,
    /// `done`, or `interrupted`: then the runs that were complete are there.
    pub status: String,
    /// Name of the problem, or the logs.
    pub problem: String,
    /// What it is, and where it comes from.
    pub source: String,
    /// How it moves; for a log, how it was conditioned.
    pub motion: String,
    /// Samples that count.
    pub samples: usize,
    /// Sample rate, Hz; 0 for a steady curve.
    pub rate_hz: f64,
    /// Standard deviation of the noise divided by the largest force (or position), dimensionless; `null` for a log.
    pub noise: Option<f64>,
    /// Decades of the box to each side; `null` for the box of `identify`.
    pub box_decades: Option<f64>,
    /// Ends of the box for each unknown.
    pub bounds: Vec<[f64; 2]>,
    /// `six`, `separable`, `position` or `curve`.
    pub cost: String,
    /// `explin`, `euler` or `rk4`.
    pub integrator: String,
    /// Whether least squares follow each search.
    pub least_squares: bool,
    /// Cost of an evaluation on the coarse record, as a part of one on the full record, dimensionless.
    pub coarse_share: f64,
    /// Known parameters; empty for a log.
    pub truth: Vec<(String, f64)>,
    /// Seeds of each method, from 0 on.
    pub seeds: u64,
    /// Most evaluations of a run, and as many with derivatives.
    pub evaluations: u64,
    /// What counts as a success, in words.
    pub success: String,
    /// The optimum that the costs are measured by.
    pub reference: Reference,
    /// The methods.
    pub methods: Vec<MethodEntry>,
    /// Time of the whole comparison, s.
    pub wall_s: f64,
}

/// An optimum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    /// Its cost: sum of squares of the residual over that of the signal.
    #[serde(with = "maybe")]
    pub cost: f64,
    /// What found it.
    pub by: String,
    /// Whether a method of the comparison found a lower cost than the reference search, and so became
    /// the reference.
    pub beaten: bool,
    /// The cost of the reference search, where it was beaten.
    pub before: Option<f64>,
}

/// One method over all seeds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MethodEntry {
    /// Name.
    pub name: String,
    /// The search by itself.
    pub own: Stage,
    /// With the least squares after it; the same where there are none.
    pub after_least_squares: Stage,
    /// Evaluations of the full record of a run.
    pub evaluations: Quartiles,
    /// Time of a run, s.
    pub seconds: Quartiles,
    /// Evaluations until a run that succeeds is near the optimum.
    pub evaluations_to_success: Quartiles,
    /// Time until then, s.
    pub seconds_to_success: Quartiles,
    /// Best cost against evaluations.
    pub by_evaluations: Course,
    /// Best cost against time in s.
    pub by_time: Course,
    /// Of the first seed, after some generations: evaluations, then least cost, quartiles and greatest
    /// cost of the population; `null` for a cost that is not finite.
    pub generations: Vec<(f64, Vec<Option<f64>>)>,
    /// Run by run.
    pub runs: Vec<RunEntry>,
}

/// What a method reached.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stage {
    /// Runs that succeeded.
    pub successes: usize,
    /// Cost at the end.
    pub cost: Quartiles,
    /// Cost at the end divided by that of the optimum, minus 1, dimensionless.
    pub excess: Quartiles,
    /// Error of each known parameter.
    pub errors: Vec<ParameterError>,
}

/// Error of a parameter over the runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParameterError {
    /// Name.
    pub name: String,
    /// Magnitude of (found value / true value - 1), dimensionless; `null` where the true value is zero.
    pub relative: Quartiles,
}

/// Best cost so far over all runs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Course {
    /// Where: evaluations of the full record, or seconds.
    pub at: Vec<f64>,
    /// Lower quartile.
    pub low: Vec<f64>,
    /// Median.
    pub median: Vec<f64>,
    /// Upper quartile.
    pub high: Vec<f64>,
}

/// One run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunEntry {
    /// Its seed.
    pub seed: u64,
    /// How it ended: `converged`, `exhausted`, `stalled` or `budget`.
    pub status: String,
    /// Evaluations by kind.
    pub evaluations: Evaluations,
    /// Time, s.
    pub seconds: f64,
    /// Least cost of the search by itself.
    pub cost_own: Option<f64>,
    /// Evaluations until it was found.
    pub evaluations_own: Option<f64>,
    /// Least cost in the end.
    pub cost: Option<f64>,
    /// Parameters there.
    pub parameters: Vec<(String, f64)>,
    /// Whether the search by itself succeeded.
    pub success_own: bool,
    /// Whether it succeeded in the end.
    pub success: bool,
    /// Evaluations until it was near the optimum; `null` without success.
    pub evaluations_to_success: Option<f64>,
    /// Time until then, s.
    pub seconds_to_success: Option<f64>,
}

/// A number that may be infinite: `null` then.
mod maybe {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer>(x: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        Some(*x).filter(|x| x.is_finite()).serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        Ok(Option::<f64>::deserialize(deserializer)?.unwrap_or(f64::INFINITY))
    }
}
