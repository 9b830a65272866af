//! `annealing`: simulated annealing with step lengths that adapt to the valley.
//!
//! Corana, Marchesi, Martini, Ridella 1987 (doi 10.1145/29380.29864): coordinates are moved in turn,
//! the step of each is kept where about half the moves are accepted, the temperature falls by a
//! constant factor. Several chains run in lockstep, each on its own, so that kernels can evaluate
//! them side by side.

use crate::bits;
use crate::error::{Error, require};
use crate::points::Points;
use crate::random::Dice;
use crate::search::{Answers, Request, Search};
use crate::status::Status;
use serde::{Deserialize, Serialize};

/// Least step, in widths of the box: below it a move changes nothing but rounding.
const LEAST_STEP: f64 = 1e-12;
/// How strongly the steps adapt: Corana et al. 1987, c = 2.
const STEP_ADAPTATION: f64 = 2.0;

/// Settings of simulated annealing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Chains, 1 to 10 000. Default 2.
    pub chains: usize,
    /// First temperature in units of the median cost of [`Settings::sample`] random points, > 0.
    /// Default 1.
    pub start: f64,
    /// Random points that set the scale of the temperature and the first places, from `chains` to
    /// 100 000. Default 50.
    pub sample: usize,
    /// Factor of the temperature, 0 to 1 (both excluded). Default .5.
    pub factor: f64,
    /// Temperatures, 1 to 1 000 000. Default 40.
    pub temperatures: usize,
    /// Step adjustments at each temperature, 1 to 10 000. Default 2.
    pub adjustments: usize,
    /// Moves of each coordinate between adjustments, 1 to 10 000. Default 10.
    pub cycles: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            chains: 2,
            start: 1.0,
            sample: 50,
            factor: 0.5,
            temperatures: 40,
            adjustments: 2,
            cycles: 10,
        }
    }
}

/// One walk through the cube.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Chain {
    #[serde(with = "bits")]
    place: Vec<f64>,
    #[serde(with = "bits")]
    cost: f64,
    #[serde(with = "bits")]
    best: Vec<f64>,
    #[serde(with = "bits")]
    best_cost: f64,
    #[serde(with = "bits")]
    steps: Vec<f64>,
    accepted: Vec<usize>,
}

/// Chains at a common temperature.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Annealing {
    settings: Settings,
    dice: Dice,
    dimensions: usize,
    asked: Points,
    chains: Vec<Chain>,
    #[serde(with = "bits")]
    temperature: f64,
    coordinate: usize,
    cycle: usize,
    adjustment: usize,
    cooled: usize,
    status: Option<Status>,
}

impl Annealing {
    /// Starts the search in the unit cube.
    pub fn new(settings: Settings, dimensions: usize, seed: u64) -> Result<Self, Error> {
        let s = &settings;
        let size = |name, v: usize, low: usize, high: usize, allowed| {
            let within = (low..=high).contains(&v);
            require(within, "annealing", name, v as f64, allowed)
        };
        size("chains", s.chains, 1, 10_000, "1 to 10000")?;
        size(
            "sample",
            s.sample,
            s.chains,
            100_000,
            "the chains to 100000",
        )?;
        size("temperatures", s.temperatures, 1, 1_000_000, "1 to 1000000")?;
        size("adjustments", s.adjustments, 1, 10_000, "1 to 10000")?;
        size("cycles", s.cycles, 1, 10_000, "1 to 10000")?;
        let (start, factor) = (s.start, s.factor);
        let within = start > 0.0 && start.is_finite();
        require(within, "annealing", "start", start, "above 0, finite")?;
        let within = factor > 0.0 && factor < 1.0;
        require(within, "annealing", "factor", factor, "above 0, below 1")?;
        let mut dice = Dice::new(seed);
        let mut asked = Points::new(dimensions);
        for _ in 0..settings.sample {
            asked.push(&dice.point(dimensions));
        }
        Ok(Self {
            settings,
            dice,
            dimensions,
            asked,
            chains: Vec::new(),
            temperature: 0.0,
            coordinate: 0,
            cycle: 0,
            adjustment: 0,
            cooled: 0,
            status: None,
        })
    }

    /// Starts the chains at the best points of the sample.
    fn set_out(&mut self, answers: &Answers) {
        let costs: Vec<f64> = (0..answers.len()).map(|i| answers.cost(i)).collect();
        let order = crate::genetic::least(&costs, costs.len());
        let finite = costs.iter().filter(|c| c.is_finite()).count();
        if finite == 0 {
            self.status = Some(Status::Stalled);
            return;
        }
        self.temperature = self.settings.start * costs[order[finite / 2]];
        for &i in order.iter().take(self.settings.chains) {
            let place = self.asked.row(i).to_vec();
            self.chains.push(Chain {
                best: place.clone(),
                best_cost: costs[i],
                place,
                cost: costs[i],
                steps: vec![0.5; self.dimensions],
                accepted: vec![0; self.dimensions],
            });
        }
    }

    fn move_on(&mut self) {
        self.coordinate += 1;
        if self.coordinate < self.dimensions {
            return;
        }
        self.coordinate = 0;
        self.cycle += 1;
        if self.cycle < self.settings.cycles {
            return;
        }
        self.cycle = 0;
        for chain in &mut self.chains {
            chain.adapt(self.settings.cycles);
        }
        self.adjustment += 1;
        if self.adjustment < self.settings.adjustments {
            return;
        }
        self.adjustment = 0;
        self.temperature *= self.settings.factor;
        for chain in &mut self.chains {
            chain.place.clone_from(&chain.best);
            chain.cost = chain.best_cost;
        }
        self.cooled += 1;
        if self.cooled == self.settings.temperatures {
            self.status = Some(Status::Exhausted);
        }
    }
}

impl Chain {
    /// Longer steps where most moves were accepted, shorter where few.
    fn adapt(&mut self, moves: usize) {
        for (step, accepted) in self.steps.iter_mut().zip(&mut self.accepted) {
            let rate = *accepted as f64 / moves as f64;
            if rate > 0.6 {
                *step *= 1.0 + STEP_ADAPTATION * (rate - 0.6) / 0.4;
            } else if rate < 0.4 {
                *step /= 1.0 + STEP_ADAPTATION * (0.4 - rate) / 0.4;
            }
            *step = step.clamp(LEAST_STEP, 1.0);
            *accepted = 0;
        }
    }
}

impl Search for Annealing {
    fn ask(&mut self) -> Option<Request> {
        if self.status.is_some() {
            return None;
        }
        if !self.chains.is_empty() {
            let j = self.coordinate;
            let mut asked = Points::new(self.dimensions);
            for chain in &self.chains {
                let mut to = chain.place.clone();
                to[j] += self.dice.between(-1.0, 1.0) * chain.steps[j];
                if !(0.0..=1.0).contains(&to[j]) {
                    to[j] = self.dice.unit();
                }
                asked.push(&to);
            }
            self.asked = asked;
        }
        Some(Request::costs(self.asked.clone()))
    }

    fn tell(&mut self, answers: &Answers) {
        if self.chains.is_empty() {
            return self.set_out(answers);
        }
        for (i, chain) in self.chains.iter_mut().enumerate() {
            let cost = answers.cost(i);
            // Drawn whether needed or not: the sequence of random numbers then does not depend on rounding.
            let chance = self.dice.unit();
            let rise = (cost - chain.cost) / self.temperature;
            if cost <= chain.cost || chance < libm::exp(-rise) {
                chain.place.copy_from_slice(self.asked.row(i));
                chain.cost = cost;
                chain.accepted[self.coordinate] += 1;
                if cost < chain.best_cost {
                    chain.best.clone_from(&chain.place);
                    chain.best_cost = cost;
                }
            }
        }
        self.move_on();
    }

    fn status(&self) -> Option<Status> {
        self.status
    }
}
