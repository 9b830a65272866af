//! `niched-ga`: an annealing genetic algorithm that finds where to descend, and the descents.
//!
//! In the spirit of the annealing GA (Z25), made to reach the optimum with few evaluations:
//!
//! 1. A round draws a scrambled Sobol sequence on the *coarse* record and keeps the best.
//! 2. A few generations: each child lies on the line through two parents, the first chosen by rank, or
//!    a little beyond either end, with a step along the difference of two others. So scale and
//!    direction come from the population's own covariance.
//! 3. A child competes with the individual nearest to it (restricted tournament, Harik 1995) and
//!    lives by annealed chance on the relative cost, Z25 eq. (21); so separate valleys stay peopled.
//! 4. The best of the niches descend by least squares on the coarse record, side by side.
//! 5. Once the best minimum was reached from two niches it is trusted; else another round follows,
//!    from new points.
//! 6. The best minima descend on the full record.
//!
//! Without a coarse record all of it happens on the full one. What it is worth, and what was tried
//! instead: decision 0019.

mod state;

pub use state::NichedGa;

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
    fn check(&self) -> Result<(), Error> {
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
