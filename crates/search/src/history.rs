//! The course of a run, for plots; of bounded size however long the run.

use crate::bits;
use serde::{Deserialize, Serialize};

/// Entries of one curve at which every second is dropped.
const MOST_ENTRIES: usize = 1024;

/// A new best.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Improvement {
    /// Evaluations until then, in equivalents of evaluations on the full record.
    #[serde(with = "bits")]
    pub evaluations: f64,
    /// The cost.
    #[serde(with = "bits")]
    pub cost: f64,
}

/// The costs of a population after one generation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Generation {
    /// Which generation, counted from 0 over all rounds.
    pub generation: usize,
    /// Evaluations until then, in equivalents of evaluations on the full record.
    #[serde(with = "bits")]
    pub evaluations: f64,
    /// Least cost, lower quartile, median, upper quartile, greatest cost.
    #[serde(with = "bits")]
    pub quartiles: Vec<f64>,
}

/// Best cost against evaluations, and the spread of each generation.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct History {
    improvements: Vec<Improvement>,
    generations: Vec<Generation>,
    /// Every how many generations one is kept.
    every: usize,
}

impl History {
    /// New bests, in order; the first and the last are always there.
    pub fn improvements(&self) -> &[Improvement] {
        &self.improvements
    }

    /// Generations, evenly thinned.
    pub fn generations(&self) -> &[Generation] {
        &self.generations
    }

    pub(crate) fn improve(&mut self, evaluations: f64, cost: f64) {
        if self.improvements.len() == MOST_ENTRIES {
            let mut i = 0;
            self.improvements.retain(|_| {
                i += 1;
                i % 2 == 1
            });
        }
        self.improvements.push(Improvement { evaluations, cost });
    }

    pub(crate) fn generation(&mut self, generation: usize, evaluations: f64, mut costs: Vec<f64>) {
        self.every = self.every.max(1);
        if costs.is_empty() || !generation.is_multiple_of(self.every) {
            return;
        }
        if self.generations.len() == MOST_ENTRIES {
            self.every *= 2;
            let every = self.every;
            self.generations
                .retain(|g| g.generation.is_multiple_of(every));
            if !generation.is_multiple_of(every) {
                return;
            }
        }
        costs.sort_by(f64::total_cmp);
        let last = costs.len() - 1;
        let quartiles = (0..5).map(|q| costs[(q * last + 2) / 4]).collect();
        self.generations.push(Generation {
            generation,
            evaluations,
            quartiles,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stays_bounded_and_keeps_its_ends() {
        let mut history = History::default();
        for i in 0..10_000 {
            history.improve(f64::from(i), 1.0 / f64::from(i + 1));
            history.generation(i as usize, f64::from(i), vec![3.0, 1.0, 2.0, 5.0, 4.0]);
        }
        let (bests, generations) = (history.improvements(), history.generations());
        assert!(bests.len() <= MOST_ENTRIES && generations.len() <= MOST_ENTRIES);
        assert_eq!(bests[0].evaluations, 0.0);
        assert_eq!(bests[bests.len() - 1].evaluations, 9999.0);
        assert!(
            generations
                .windows(2)
                .all(|w| w[1].generation - w[0].generation == 16)
        );
        assert_eq!(generations[0].quartiles, [1.0, 2.0, 3.0, 4.0, 5.0]);
    }
}
