//! What a search found by itself, and the least squares after it.

use serde::{Deserialize, Serialize};

/// A search as it goes into `result.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SearchedEntry {
    /// Name of the search.
    #[serde(default)]
    pub method: String,
    /// `six` or `separable` for whole records; `curve` for the steady curve and `dynamic` for σ₀ and σ₁ beside it.
    pub cost: String,
    /// `converged`, `exhausted`, `stalled`, `target`, `budget`, `time` or `interrupted`.
    pub status: String,
    /// Names of the unknowns, whose natural logarithms are searched.
    pub unknowns: Vec<String>,
    /// Ends of the box for each, in the unit of the unknown.
    pub bounds: Vec<[f64; 2]>,
    /// Evaluations in all.
    pub evaluations: Evaluations,
    /// The best of the search itself; `null` where it evaluated nothing.
    pub own: Option<SearchedPoint>,
    /// The best after its least squares, where it has any; else the same.
    pub after_least_squares: Option<SearchedPoint>,
    /// Evaluations of the full record, and the best cost until then.
    pub history: Vec<(f64, f64)>,
    /// After some generations: evaluations, then least cost, quartiles and greatest cost of the
    /// population; `null` for a cost that is not finite.
    pub generations: Vec<(f64, Vec<Option<f64>>)>,
}

/// How near an end of its range, as a part of it, an unknown counts as at the end: a search without least squares stops short
/// of it.
const AT_AN_END: f64 = 0.02;

/// The end of a range, whose logarithm is searched, that a value stands at: 0 the lower, 1 the upper one; `None` inside.
pub fn end_of([low, high]: [f64; 2], value: f64) -> Option<usize> {
    let part = (value / low).ln() / (high / low).ln();
    match (part <= AT_AN_END, part >= 1.0 - AT_AN_END) {
        (true, _) => Some(0),
        (_, true) => Some(1),
        _ => None,
    }
}

impl SearchedEntry {
    /// Whether the search itself left this parameter at an end of its range, or beyond: then the range gave its value.
    pub fn is_at_an_end(&self, name: &str, value: f64) -> bool {
        let mut ranges = self.unknowns.iter().zip(&self.bounds);
        ranges.any(|(unknown, range)| unknown == name && end_of(*range, value).is_some())
    }
}

/// Evaluations by kind.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Evaluations {
    /// Costs on the full record.
    pub costs: u64,
    /// Costs with derivatives on the full record.
    pub derivatives: u64,
    /// Costs on the coarse record.
    pub coarse_costs: u64,
    /// Costs with derivatives on the coarse record.
    pub coarse_derivatives: u64,
    /// All of them in evaluations of the full record.
    pub full_records: f64,
}

/// A point that a search found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SearchedPoint {
    /// Sum of squares of the residual over that of the force; of the steady curve twice the robust loss of its least squares
    /// over the sum of squares of force by deviation.
    pub cost: f64,
    /// Evaluations of the full record until it was found.
    pub evaluations: f64,
    /// Its parameters.
    pub parameters: Vec<SearchedParameter>,
}

/// A parameter of such a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SearchedParameter {
    /// Name, such as `sigma0`.
    pub name: String,
    /// SI.
    pub value: f64,
}
