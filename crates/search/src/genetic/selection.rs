//! Who breeds.

use super::fitness;
use crate::random::Dice;
use serde::{Deserialize, Serialize};

/// How the next generation is drawn, with replacement.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Selection {
    /// In proportion to the fitness 1/(J + eps).
    Roulette,
    /// In proportion to the rank: from `pressure` for the best to `2 - pressure` for the worst, in
    /// draws expected (Baker 1985); 1 to 2.
    Rank {
        /// Draws expected for the best.
        pressure: f64,
    },
}

impl Selection {
    /// `many` indices, drawn by their costs.
    pub(crate) fn draw(self, costs: &[f64], many: usize, dice: &mut Dice) -> Vec<usize> {
        let n = costs.len();
        let mut weights = vec![0.0; n];
        match self {
            Selection::Roulette => {
                for (w, &cost) in weights.iter_mut().zip(costs) {
                    *w = fitness(cost);
                }
            }
            Selection::Rank { pressure } => {
                let best_first = super::least(costs, n);
                for (rank, i) in best_first.into_iter().enumerate() {
                    let down = rank as f64 / (n - 1).max(1) as f64;
                    weights[i] = pressure + (2.0 - 2.0 * pressure) * down;
                }
            }
        }
        let mut sum = 0.0;
        let sums: Vec<f64> = weights
            .iter()
            .map(|w| {
                sum += w;
                sum
            })
            .collect();
        (0..many)
            .map(|_| {
                if !(sum > 0.0 && sum.is_finite()) {
                    return dice.below(n);
                }
                let at = dice.unit() * sum;
                sums.partition_point(|&s| s <= at).min(n - 1)
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frequencies(selection: Selection, costs: &[f64]) -> Vec<f64> {
        let many = 100_000;
        let mut counts = vec![0.0; costs.len()];
        for i in selection.draw(costs, many, &mut Dice::new(5)) {
            counts[i] += 1.0 / many as f64;
        }
        counts
    }

    #[test]
    fn ranks_are_drawn_in_a_line() {
        let costs = [3.0, f64::INFINITY, 1.0, 2.0];
        let found = frequencies(Selection::Rank { pressure: 1.6 }, &costs);
        for (found, expected) in found.iter().zip([0.8, 0.4, 1.6, 1.2]) {
            assert!((4.0 * found - expected).abs() < 0.02, "{found} {expected}");
        }
    }

    #[test]
    fn roulette_draws_by_fitness_and_never_the_worst() {
        let found = frequencies(Selection::Roulette, &[1.0, f64::INFINITY, 3.0]);
        assert!((found[0] - 0.75).abs() < 0.005);
        assert_eq!(found[1], 0.0);
    }
}
