//! Individuals and their fitness.

use crate::bits;
use serde::{Deserialize, Serialize};

/// A point of the unit cube and its cost.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Individual {
    #[serde(with = "bits")]
    pub point: Vec<f64>,
    #[serde(with = "bits")]
    pub cost: f64,
}

/// Added to a cost before its inverse is taken, so that a perfect fit has a finite fitness: below any cost of
/// a fit in numbers of 16 digits (1e-32 of the energy).
const FITNESS_COST_FLOOR: f64 = 1e-30;

/// Fitness 1/(J + eps) of a cost J, Z25 eq. (22); 0 for the worst.
pub(crate) fn fitness(cost: f64) -> f64 {
    1.0 / (cost.max(0.0) + FITNESS_COST_FLOOR)
}

pub(crate) fn costs_of(population: &[Individual]) -> Vec<f64> {
    population.iter().map(|x| x.cost).collect()
}

/// The indices of the `many` best, best first; among equals the first.
pub(crate) fn least(costs: &[f64], many: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..costs.len()).collect();
    order.sort_by(|&a, &b| costs[a].total_cmp(&costs[b]));
    order.truncate(many);
    order
}
