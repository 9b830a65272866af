//! Settings of the niched genetic algorithm.

use crate::error::{Error, require};
use crate::genetic::Annealing;
use serde::{Deserialize, Serialize};

/// Settings of the niched GA.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Points drawn at the start of a round, from `population` to 100 000. Default 128.
    pub draw: usize,
    /// Individuals, 4 to 10 000. Default 32.
    pub population: usize,
    /// Generations of a round, 0 to 100 000. Default 4.
    pub generations: usize,
    /// Most rounds, 1 to 1000. Default 4.
    pub rounds: usize,
    /// Annealed survival. Default start 5, factor .8.
    pub annealing: Annealing,
    /// Niches of a round that descend, 1 to 1000. Default 4.
    pub niches: usize,
    /// Least distance between two of them, greatest over the dimensions, in widths of the box, 0 to
    /// 1. Default .1.
    pub apart: f64,
    /// Most steps of a descent, 1 to 100 000. Default 40.
    pub steps: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            draw: 128,
            population: 32,
            generations: 4,
            rounds: 4,
            annealing: Annealing {
                start: 5.0,
                factor: 0.8,
            },
            niches: 4,
            apart: 0.1,
            steps: 40,
        }
    }
}

impl Settings {
    pub(super) fn check(&self) -> Result<(), Error> {
        let name = "niched-ga";
        let size = |field, v: usize, low: usize, high: usize, allowed| {
            require((low..=high).contains(&v), name, field, v as f64, allowed)
        };
        size("population", self.population, 4, 10_000, "4 to 10000")?;
        let allowed = "the population to 100000";
        size("draw", self.draw, self.population, 100_000, allowed)?;
        size("generations", self.generations, 0, 100_000, "0 to 100000")?;
        size("rounds", self.rounds, 1, 1000, "1 to 1000")?;
        size("niches", self.niches, 1, 1000, "1 to 1000")?;
        size("steps", self.steps, 1, 100_000, "1 to 100000")?;
        let apart = self.apart;
        require((0.0..=1.0).contains(&apart), name, "apart", apart, "0 to 1")?;
        self.annealing.check(name)
    }
}
