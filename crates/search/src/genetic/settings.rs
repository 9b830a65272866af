//! Settings of the genetic algorithms.

use super::{Annealing, Crossover, Rates, Ratio, Selection};
use crate::error::{Error, require};
use serde::{Deserialize, Serialize};

/// Settings of the genetic algorithms. [`Settings::default`] is the annealing GA.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Individuals, 4 to 100 000. Default 50.
    pub population: usize,
    /// Generations of a round, 1 to 1 000 000. Default 100.
    pub generations: usize,
    /// Rounds, 1 to 1000. Default 5.
    pub rounds: usize,
    /// Best individuals that stay as they are, 1 to below `population`. Default 5.
    pub elite: usize,
    /// How parents are chosen. Default by rank, pressure 1.5.
    pub selection: Selection,
    /// How they make children. Default blend.
    pub crossover: Crossover,
    /// With which ratio. Default uniform, per gene.
    pub ratio: Ratio,
    /// Probability that a pair is crossed; the fitter parent's fitness decides. Default .6 to .9.
    pub crossover_rate: Rates,
    /// Probability that one gene of an individual is drawn anew. Default .01 to .10.
    pub mutation_rate: Rates,
    /// Annealed survival; `None` lets every child live. Default start 7, factor .96.
    pub annealing: Option<Annealing>,
    /// Precision module: factor, above 0 to 1, of the box around the best from round to round;
    /// `None` draws every round in the whole box. Default .5.
    pub precision: Option<f64>,
    /// Adaptive evolution module (L23; the threshold is ours): where mean fitness over best fitness
    /// is at least this, 0 to 1, the population is concentrated and mutates before it crosses, else
    /// after. Default `None`: always after.
    pub adaptive_evolution: Option<f64>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            population: 50,
            generations: 100,
            rounds: 5,
            elite: 5,
            selection: Selection::Rank { pressure: 1.5 },
            crossover: Crossover::Blend,
            ratio: Ratio::Uniform,
            crossover_rate: Rates {
                low: 0.6,
                high: 0.9,
            },
            mutation_rate: Rates {
                low: 0.01,
                high: 0.10,
            },
            annealing: Some(Annealing {
                start: 7.0,
                factor: 0.96,
            }),
            precision: Some(0.5),
            adaptive_evolution: None,
        }
    }
}

impl Settings {
    /// The plain GA: roulette, blend, fixed rates .9 and .10, one elite individual, one round of 500
    /// generations.
    pub fn plain() -> Self {
        Self {
            generations: 500,
            rounds: 1,
            elite: 1,
            selection: Selection::Roulette,
            crossover_rate: Rates::fixed(0.9),
            mutation_rate: Rates::fixed(0.10),
            annealing: None,
            precision: None,
            ..Self::default()
        }
    }

    /// The plain GA with adaptive rates.
    pub fn adaptive() -> Self {
        let Self {
            crossover_rate,
            mutation_rate,
            ..
        } = Self::default();
        Self {
            crossover_rate,
            mutation_rate,
            ..Self::plain()
        }
    }

    pub(crate) fn check(&self, method: &'static str) -> Result<(), Error> {
        let size = |name, v: usize, low: usize, high: usize, allowed| {
            require((low..=high).contains(&v), method, name, v as f64, allowed)
        };
        size("population", self.population, 4, 100_000, "4 to 100000")?;
        size(
            "generations",
            self.generations,
            1,
            1_000_000,
            "1 to 1000000",
        )?;
        size("rounds", self.rounds, 1, 1000, "1 to 1000")?;
        let most = self.population - 1;
        size("elite", self.elite, 1, most, "1 to below the population")?;
        let unit = |name, v: f64| require((0.0..=1.0).contains(&v), method, name, v, "0 to 1");
        for (name, rates) in [
            ("crossover_rate", self.crossover_rate),
            ("mutation_rate", self.mutation_rate),
        ] {
            unit(name, rates.high)?;
            let within = (0.0..=rates.high).contains(&rates.low);
            require(within, method, name, rates.low, "0 to the upper rate")?;
        }
        if let Selection::Rank { pressure } = self.selection {
            let within = (1.0..=2.0).contains(&pressure);
            require(within, method, "pressure", pressure, "1 to 2")?;
        }
        if let Ratio::Constant(ratio) = self.ratio {
            unit("ratio", ratio)?;
        }
        if let Some(annealing) = self.annealing {
            annealing.check(method)?;
        }
        if let Some(factor) = self.precision {
            let within = factor > 0.0 && factor <= 1.0;
            require(within, method, "precision", factor, "above 0 to 1")?;
        }
        match self.adaptive_evolution {
            Some(threshold) => unit("adaptive_evolution", threshold),
            None => Ok(()),
        }
    }
}
