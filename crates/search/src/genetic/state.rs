//! The genetic algorithm as a state machine.

use super::{Individual, Settings, costs_of, cross, fitness, least};
use crate::bits;
use crate::error::Error;
use crate::points::Points;
use crate::random::Dice;
use crate::search::{Answers, Request, Search};
use crate::status::Status;
use serde::{Deserialize, Serialize};

/// What the outstanding answers are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum Stage {
    /// A round begins.
    Draw,
    /// Children of the population.
    Vary,
    Ended,
}

/// What became of one individual by crossover and mutation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Child {
    individual: Individual,
    /// Whether it differs from its parent, and so has to be evaluated.
    changed: bool,
}

/// A genetic algorithm; which one is a matter of its [`Settings`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Genetic {
    settings: Settings,
    dice: Dice,
    /// The box of the round.
    #[serde(with = "bits")]
    low: Vec<f64>,
    #[serde(with = "bits")]
    high: Vec<f64>,
    round: usize,
    /// Generations of this round that are over.
    generation: usize,
    stage: Stage,
    population: Vec<Individual>,
    children: Vec<Child>,
    best: Option<Individual>,
    /// Generations of all rounds, draws included.
    over: usize,
}

impl Genetic {
    /// Starts the search in the unit cube; `method` is named in errors.
    pub fn new(
        settings: Settings,
        method: &'static str,
        dimensions: usize,
        seed: u64,
    ) -> Result<Self, Error> {
        settings.check(method)?;
        Ok(Self {
            settings,
            dice: Dice::new(seed),
            low: vec![0.0; dimensions],
            high: vec![1.0; dimensions],
            round: 0,
            generation: 0,
            stage: Stage::Draw,
            population: Vec::new(),
            children: Vec::new(),
            best: None,
            over: 0,
        })
    }

    /// Individuals drawn in the box of the round, without parents.
    fn draw(&mut self) -> Points {
        self.population.clear();
        self.children.clear();
        if let Some(best) = &self.best {
            self.population.push(best.clone());
        }
        let mut points = Points::new(self.low.len());
        for _ in self.population.len()..self.settings.population {
            let point: Vec<f64> = (0..self.low.len())
                .map(|j| self.dice.between(self.low[j], self.high[j]))
                .collect();
            points.push(&point);
            self.children.push(Child {
                individual: Individual {
                    point,
                    cost: f64::INFINITY,
                },
                changed: true,
            });
        }
        points
    }

    /// Children of the whole population, pair by pair; those that have to be evaluated are returned.
    fn vary(&mut self) -> Points {
        let fit: Vec<f64> = self.population.iter().map(|x| fitness(x.cost)).collect();
        let max = fit.iter().copied().fold(0.0, f64::max);
        let mean = fit.iter().sum::<f64>() / fit.len() as f64;
        let concentrated = (self.settings.adaptive_evolution).is_some_and(|t| mean >= t * max);
        self.children = self
            .population
            .iter()
            .map(|individual| Child {
                individual: individual.clone(),
                changed: false,
            })
            .collect();
        let order = self.dice.order(fit.len());
        if concentrated {
            self.mutate(&fit, mean, max);
            self.cross_pairs(&order, &fit, mean, max);
        } else {
            self.cross_pairs(&order, &fit, mean, max);
            self.mutate(&fit, mean, max);
        }
        let mut points = Points::new(self.low.len());
        for child in self.children.iter().filter(|c| c.changed) {
            points.push(&child.individual.point);
        }
        points
    }

    /// Z25 eqs. (16), (18), (19).
    fn cross_pairs(&mut self, order: &[usize], fit: &[f64], mean: f64, max: f64) {
        for pair in order.chunks_exact(2) {
            let (a, b) = if fit[pair[1]] > fit[pair[0]] {
                (pair[1], pair[0])
            } else {
                (pair[0], pair[1])
            };
            let rate = self.settings.crossover_rate.at(fit[a], mean, max);
            if !self.dice.chance(rate) {
                continue;
            }
            let parents = [a, b].map(|i| self.children[i].individual.point.as_slice());
            let (kind, ratio) = (self.settings.crossover, self.settings.ratio);
            let pair = cross(
                kind,
                ratio,
                parents,
                [&self.low, &self.high],
                &mut self.dice,
            );
            for (i, point) in [a, b].into_iter().zip(pair) {
                self.children[i].individual.point = point;
                self.children[i].changed = true;
            }
        }
    }

    /// One gene of an individual, Z25 eqs. (17), (20).
    fn mutate(&mut self, fit: &[f64], mean: f64, max: f64) {
        for (child, &fit) in self.children.iter_mut().zip(fit) {
            let rate = self.settings.mutation_rate.at(fit, mean, max);
            if self.dice.chance(rate) {
                let j = self.dice.below(self.low.len());
                child.individual.point[j] = self.dice.between(self.low[j], self.high[j]);
                child.changed = true;
            }
        }
    }

    /// Filter, elite and selection: the children become the next generation.
    fn succeed(&mut self) {
        let children = std::mem::take(&mut self.children);
        let mut all = self.population.clone();
        all.extend(children.iter().map(|c| c.individual.clone()));
        let elite = least(&costs_of(&all), self.settings.elite);
        let last = all[elite[elite.len() - 1]].cost;
        let mut next: Vec<Individual> = elite.into_iter().map(|i| all[i].clone()).collect();
        for (slot, child) in self.population.iter_mut().zip(children) {
            let lives = !child.changed
                || self.settings.annealing.is_none_or(|annealing| {
                    let cost = child.individual.cost;
                    let chance = annealing.survival(cost, last, self.generation);
                    self.dice.chance(chance)
                });
            if lives {
                *slot = child.individual;
            }
        }
        let costs = costs_of(&self.population);
        let many = self.settings.population - next.len();
        let drawn = self.settings.selection.draw(&costs, many, &mut self.dice);
        next.extend(drawn.into_iter().map(|i| self.population[i].clone()));
        self.population = next;
        self.generation += 1;
        self.keep_best();
        if self.generation == self.settings.generations {
            self.next_round();
        }
    }

    fn keep_best(&mut self) {
        let least = least(&costs_of(&self.population), 1)[0];
        let least = &self.population[least];
        let before = self.best.as_ref().map_or(f64::INFINITY, |b| b.cost);
        if least.cost < before {
            self.best = Some(least.clone());
        }
    }

    /// The box of the next round, shrunk around the best and moved inside that of this one.
    fn next_round(&mut self) {
        self.round += 1;
        if self.round == self.settings.rounds {
            self.stage = Stage::Ended;
            return;
        }
        self.generation = 0;
        self.stage = Stage::Draw;
        let (Some(factor), Some(best)) = (self.settings.precision, &self.best) else {
            return;
        };
        for j in 0..self.low.len() {
            let width = factor * (self.high[j] - self.low[j]);
            let low = (best.point[j] - 0.5 * width)
                .min(self.high[j] - width)
                .max(self.low[j]);
            (self.low[j], self.high[j]) = (low, (low + width).min(self.high[j]));
        }
    }
}

impl Search for Genetic {
    fn ask(&mut self) -> Option<Request> {
        loop {
            match self.stage {
                Stage::Draw => return Some(Request::costs(self.draw())),
                Stage::Vary => {
                    let points = self.vary();
                    if !points.is_empty() {
                        return Some(Request::costs(points));
                    }
                    self.succeed();
                }
                Stage::Ended => return None,
            }
        }
    }

    fn tell(&mut self, answers: &Answers) {
        let changed = self.children.iter_mut().filter(|c| c.changed);
        for (i, child) in changed.enumerate() {
            child.individual.cost = answers.cost(i);
        }
        self.over += 1;
        if self.stage == Stage::Draw {
            let drawn = self.children.drain(..).map(|c| c.individual);
            self.population.extend(drawn);
            self.stage = Stage::Vary;
            self.keep_best();
        } else {
            self.succeed();
        }
    }

    fn status(&self) -> Option<Status> {
        match (self.stage, &self.best) {
            (Stage::Ended, Some(_)) => Some(Status::Exhausted),
            (Stage::Ended, None) => Some(Status::Stalled),
            _ => None,
        }
    }

    fn population(&self) -> Option<(usize, Vec<f64>)> {
        let over = self.over.checked_sub(1)?;
        Some((over, costs_of(&self.population)))
    }
}

#[cfg(test)]
mod tests;
