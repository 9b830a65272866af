//! `de`: differential evolution, best/1/bin with dithered scale and deferred updating.
//!
//! Storn and Price 1997 (doi 10.1023/A:1008202821328), with the defaults that SciPy's
//! `differential_evolution` made common.

use crate::bits;
use crate::error::{Error, require};
use crate::genetic::least;
use crate::points::Points;
use crate::random::Dice;
use crate::search::{Answers, Request, Search};
use crate::status::Status;
use serde::{Deserialize, Serialize};

/// Settings of differential evolution.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Individuals per dimension, 1 to 10 000; never fewer than 5 in all. Default 15.
    pub per_dimension: usize,
    /// Generations, 1 to 1 000 000. Default 1000.
    pub generations: usize,
    /// The scale F of a difference is drawn from this range for each generation; within 0 to 2.
    /// Default .5 to 1.
    pub scale: [f64; 2],
    /// Probability that a coordinate comes from the mutant, 0 to 1. Default .7.
    pub crossover: f64,
    /// Converged when the deviation of the costs over their mean is below this, >= 0. Default 1e-6.
    pub spread: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            per_dimension: 15,
            generations: 1000,
            scale: [0.5, 1.0],
            crossover: 0.7,
            spread: 1e-6,
        }
    }
}

/// A population and the trial vectors against it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DifferentialEvolution {
    settings: Settings,
    dice: Dice,
    population: Points,
    #[serde(with = "bits")]
    costs: Vec<f64>,
    trials: Points,
    generation: usize,
    status: Option<Status>,
}

impl DifferentialEvolution {
    /// Starts the search in the unit cube, from a Latin hypercube.
    pub fn new(settings: Settings, dimensions: usize, seed: u64) -> Result<Self, Error> {
        let (n, g) = (settings.per_dimension, settings.generations);
        let size = |name, v: usize, ok: bool, allowed| require(ok, "de", name, v as f64, allowed);
        size("per_dimension", n, (1..=10_000).contains(&n), "1 to 10000")?;
        let within = (1..=1_000_000).contains(&g);
        size("generations", g, within, "1 to 1000000")?;
        let [low, high] = settings.scale;
        let within = (0.0..=high).contains(&low);
        require(within, "de", "scale", low, "0 to its upper end")?;
        require(high <= 2.0, "de", "scale", high, "at most 2")?;
        let cross = settings.crossover;
        let within = (0.0..=1.0).contains(&cross);
        require(within, "de", "crossover", cross, "0 to 1")?;
        let spread = settings.spread;
        require(spread >= 0.0, "de", "spread", spread, "0 or more")?;
        let mut dice = Dice::new(seed);
        let many = (n * dimensions).max(5);
        let columns: Vec<Vec<f64>> = (0..dimensions)
            .map(|_| {
                let order = dice.order(many);
                let place = |stratum: usize| (stratum as f64 + dice.unit()) / many as f64;
                order.into_iter().map(place).collect()
            })
            .collect();
        let mut trials = Points::new(dimensions);
        for i in 0..many {
            let point: Vec<f64> = columns.iter().map(|c| c[i]).collect();
            trials.push(&point);
        }
        Ok(Self {
            settings,
            dice,
            population: Points::new(dimensions),
            costs: Vec::new(),
            trials,
            generation: 0,
            status: None,
        })
    }

    /// Trial vectors for the whole population: `x_best + F (x_r1 - x_r2)`, crossed with the target.
    fn vary(&mut self) {
        let n = self.population.dimensions();
        let best = least(&self.costs, 1)[0];
        let [low, high] = self.settings.scale;
        let scale = self.dice.between(low, high);
        let mut trials = Points::new(n);
        for i in 0..self.population.len() {
            let a = self.dice.other(self.population.len(), &[i]);
            let b = self.dice.other(self.population.len(), &[i, a]);
            let forced = self.dice.below(n);
            let mut trial = self.population.row(i).to_vec();
            for (j, x) in trial.iter_mut().enumerate() {
                if j != forced && !self.dice.chance(self.settings.crossover) {
                    continue;
                }
                let difference = self.population.row(a)[j] - self.population.row(b)[j];
                *x = self.population.row(best)[j] + scale * difference;
                if !(0.0..=1.0).contains(x) {
                    *x = self.dice.unit();
                }
            }
            trials.push(&trial);
        }
        self.trials = trials;
    }

    fn converged(&self) -> bool {
        let n = self.costs.len() as f64;
        let mean = self.costs.iter().sum::<f64>() / n;
        let squares: f64 = self.costs.iter().map(|c| (c - mean) * (c - mean)).sum();
        mean.is_finite() && (squares / n).sqrt() <= self.settings.spread * mean.abs()
    }
}

impl Search for DifferentialEvolution {
    fn ask(&mut self) -> Option<Request> {
        if self.status.is_some() {
            return None;
        }
        if !self.costs.is_empty() {
            self.vary();
        }
        Some(Request::costs(self.trials.clone()))
    }

    fn tell(&mut self, answers: &Answers) {
        if self.costs.is_empty() {
            self.population = self.trials.clone();
            self.costs = (0..answers.len()).map(|i| answers.cost(i)).collect();
        } else {
            for i in 0..answers.len() {
                if answers.cost(i) <= self.costs[i] {
                    self.costs[i] = answers.cost(i);
                    self.population
                        .row_mut(i)
                        .copy_from_slice(self.trials.row(i));
                }
            }
            self.generation += 1;
        }
        if self.converged() {
            self.status = Some(Status::Converged);
        } else if self.generation == self.settings.generations {
            self.status = Some(Status::Exhausted);
        }
    }

    fn status(&self) -> Option<Status> {
        self.status
    }

    fn population(&self) -> Option<(usize, Vec<f64>)> {
        Some((self.generation, self.costs.clone()))
    }
}
