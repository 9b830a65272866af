//! The niched GA as a state machine.

use super::settings::Settings;
use crate::bits;
use crate::error::Error;
use crate::genetic::{Individual, Selection, costs_of, least};
use crate::lockstep::{Waiting, ask_all, descents, status_of, tell_all};
use crate::niches::Niches;
use crate::points::Points;
use crate::problem::{Fidelity, Kind};
use crate::random::{Dice, sobol};
use crate::search::{Answers, Phase, Request, Search};
use crate::status::Status;
use serde::{Deserialize, Serialize};

/// Expected number of draws of the best individual as first parent, in linear ranking (1 to 2). A chosen
/// value, a little above the middle of that range.
const RANK_PRESSURE: f64 = 1.7;
/// Part of the line through two parents that lies beyond either end (line crossover, Mühlenbein and
/// Schlierkamp-Voosen 1993: 0.25).
const LINE_BEYOND_PARENTS: f64 = 0.25;
/// Standard deviation of the step along the difference of two other individuals, in lengths of that
/// difference. A chosen value; the benefit of generations in general is measured in decision 0019.
const JUMP_DEVIATION: f64 = 0.5;
/// Difference of two costs, as a part of the least, within which two descents have reached the same minimum.
/// Chosen between the 1e-9 at which descents end and the differences of minima.
const SAME_MINIMUM_COST: f64 = 1e-6;
/// The same for perfect fits, whose costs are rounding: as a part of the best cost that was drawn first.
const SAME_EXACT_COST: f64 = 1e-12;
/// Minima that descend on the full record (decision 0019: the best one or two).
const LAST_MINIMA: usize = 2;
/// Their least distance, greatest over the dimensions, in widths of the box: nearer ones are one minimum.
const LAST_APART: f64 = 0.01;

/// A minimum whose cost on the coarse record is above the least by more than this part of it is not followed
/// (decision 0019): this limits the descents on the full record.
const FOLLOWED_COST_EXCESS: f64 = 0.5;

/// What the outstanding answers are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum Stage {
    Draw,
    Vary,
    /// The best individual on the full record: it shows what the GA alone achieves.
    Show,
    Coarse,
    Full,
}

/// A population, and the descents from its niches.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NichedGa {
    settings: Settings,
    dice: Dice,
    seed: u64,
    dimensions: usize,
    stage: Stage,
    round: usize,
    /// Generations of this round that are over, and populations of all.
    generation: usize,
    over: usize,
    asked: Points,
    population: Vec<Individual>,
    descents: Vec<Waiting>,
    /// Where the descents of all rounds on the coarse record have ended.
    minima: Vec<Individual>,
    /// Best cost of the first draw.
    #[serde(with = "bits")]
    scale: f64,
    status: Option<Status>,
}

impl NichedGa {
    /// Starts the search in the unit cube.
    pub fn new(settings: Settings, dimensions: usize, seed: u64) -> Result<Self, Error> {
        settings.check()?;
        Ok(Self {
            settings,
            dice: Dice::new(seed),
            seed,
            dimensions,
            stage: Stage::Draw,
            round: 0,
            generation: 0,
            over: 0,
            asked: Points::new(dimensions),
            population: Vec::new(),
            descents: Vec::new(),
            minima: Vec::new(),
            scale: f64::INFINITY,
            status: None,
        })
    }

    fn draw(&self) -> Points {
        let mut points = Points::new(self.dimensions);
        for i in 0..self.settings.draw {
            let index = self.round * self.settings.draw + i;
            points.push(&sobol(index, self.dimensions, self.seed));
        }
        points
    }

    /// As many children as there are individuals.
    fn vary(&mut self) -> Points {
        let n = self.population.len();
        let rank = Selection::Rank {
            pressure: RANK_PRESSURE,
        };
        let parents = rank.draw(&costs_of(&self.population), n, &mut self.dice);
        let mut points = Points::new(self.dimensions);
        for a in parents {
            let b = self.dice.other(n, &[a]);
            let c = self.dice.other(n, &[a, b]);
            let d = self.dice.other(n, &[a, b, c]);
            let along = self
                .dice
                .between(-LINE_BEYOND_PARENTS, 1.0 + LINE_BEYOND_PARENTS);
            let jump = JUMP_DEVIATION * self.dice.normal();
            let [a, b, c, d] = [a, b, c, d].map(|i| &self.population[i].point);
            let mut child = a.clone();
            for (j, x) in child.iter_mut().enumerate() {
                *x += along * (b[j] - a[j]) + jump * (c[j] - d[j]);
                if !(0.0..=1.0).contains(x) {
                    *x = self.dice.unit();
                }
            }
            points.push(&child);
        }
        points
    }

    /// Each child against the individual nearest to it; the best gives way to a better one only.
    fn compete(&mut self, answers: &Answers) {
        let best = least(&costs_of(&self.population), 1)[0];
        for (i, child) in self.asked.rows().enumerate() {
            let apart = |x: &Individual| -> f64 {
                let by = x.point.iter().zip(child);
                by.map(|(a, b)| (a - b) * (a - b)).sum()
            };
            let distances: Vec<f64> = self.population.iter().map(apart).collect();
            let near = least(&distances, 1)[0];
            let (cost, rival) = (answers.cost(i), self.population[near].cost);
            let annealing = &self.settings.annealing;
            let chance = annealing.survival(cost, rival, self.generation);
            // Always drawn: whether it is needed may depend on the last bit of a cost.
            let lives = self.dice.chance(chance);
            if lives && (near != best || cost <= rival) {
                self.population[near] = Individual {
                    point: child.to_vec(),
                    cost,
                };
            }
        }
    }

    /// The best of what was drawn is the population.
    fn settle(&mut self, answers: &Answers) {
        let costs: Vec<f64> = (0..answers.len()).map(|i| answers.cost(i)).collect();
        let best = least(&costs, self.settings.population);
        if self.round == 0 && !best.is_empty() {
            self.scale = costs[best[0]];
        }
        let individual = |i: usize| Individual {
            point: self.asked.row(i).to_vec(),
            cost: costs[i],
        };
        self.population = best.into_iter().map(individual).collect();
        self.generation = 0;
    }

    /// Descents from the niches of a population.
    fn descend(&mut self, from: &[Individual], most: usize, apart: f64, stage: Stage) {
        let mut niches = Niches::new(most, apart, self.dimensions);
        for x in from {
            niches.offer(&x.point, x.cost);
        }
        self.descents = descents(niches.points().rows(), self.settings.steps);
        self.stage = stage;
    }

    fn descend_coarse(&mut self) {
        let from = std::mem::take(&mut self.population);
        let Settings { niches, apart, .. } = self.settings;
        self.descend(&from, niches, apart, Stage::Coarse);
        self.population = from;
    }

    /// The minima whose cost is above the least by no more than a part of it.
    fn minima_within(&self, part: f64) -> Vec<Individual> {
        let costs = self.minima.iter().map(|x| x.cost);
        let best = costs.fold(f64::INFINITY, f64::min);
        let bound = best + part * best + SAME_EXACT_COST * self.scale;
        let within = self.minima.iter().filter(|x| x.cost <= bound);
        within.cloned().collect()
    }

    /// The round's descents have ended.
    fn next_round(&mut self) {
        for descent in self.descents.drain(..) {
            if descent.cost().is_finite() {
                self.minima.push(Individual {
                    point: descent.point().to_vec(),
                    cost: descent.cost(),
                });
            }
        }
        self.round += 1;
        let agreed = self.minima_within(SAME_MINIMUM_COST).len() >= 2;
        if !agreed && self.round < self.settings.rounds {
            self.stage = Stage::Draw;
        } else {
            let minima = self.minima_within(FOLLOWED_COST_EXCESS);
            self.descend(&minima, LAST_MINIMA, LAST_APART, Stage::Full);
        }
    }
}

impl Search for NichedGa {
    fn ask(&mut self) -> Option<Request> {
        if self.status.is_some() {
            return None;
        }
        // Without any finite cost a round has no descents.
        while self.stage == Stage::Coarse && self.descents.is_empty() {
            self.next_round();
        }
        let (kind, fidelity, points) = match self.stage {
            Stage::Draw => (Kind::Costs, Fidelity::Coarse, self.draw()),
            Stage::Vary => (Kind::Costs, Fidelity::Coarse, self.vary()),
            Stage::Show => {
                let best = least(&costs_of(&self.population), 1)[0];
                let mut points = Points::new(self.dimensions);
                points.push(&self.population[best].point);
                (Kind::Costs, Fidelity::Full, points)
            }
            Stage::Coarse => (
                Kind::Derivatives,
                Fidelity::Coarse,
                ask_all(&self.descents)?,
            ),
            Stage::Full => (Kind::Derivatives, Fidelity::Full, ask_all(&self.descents)?),
        };
        self.asked = points.clone();
        Some(Request {
            kind,
            fidelity,
            points,
        })
    }

    fn tell(&mut self, answers: &Answers) {
        match self.stage {
            Stage::Draw => self.settle(answers),
            Stage::Vary => {
                self.compete(answers);
                self.generation += 1;
            }
            Stage::Show => return self.descend_coarse(),
            Stage::Coarse | Stage::Full => {
                if let Answers::Derivatives(all) = answers {
                    tell_all(&mut self.descents, all);
                }
                match status_of(&self.descents) {
                    Some(_) if self.stage == Stage::Coarse => self.next_round(),
                    status => self.status = status,
                }
                return;
            }
        }
        self.over += 1;
        self.stage = if self.generation < self.settings.generations {
            Stage::Vary
        } else {
            Stage::Show
        };
    }

    fn status(&self) -> Option<Status> {
        self.status
    }

    fn phase(&self) -> Phase {
        match self.stage {
            Stage::Coarse | Stage::Full => Phase::Finish,
            Stage::Draw | Stage::Vary | Stage::Show => Phase::Search,
        }
    }

    fn population(&self) -> Option<(usize, Vec<f64>)> {
        match self.stage {
            Stage::Vary | Stage::Show => Some((self.over - 1, costs_of(&self.population))),
            Stage::Draw | Stage::Coarse | Stage::Full => None,
        }
    }

    /// With no further costs available this round is the last, and descends from the population that it has.
    fn exhausted(&mut self, answered: &Answers) -> bool {
        if answered.kind() == Kind::Derivatives {
            return false;
        }
        if self.stage == Stage::Draw {
            if answered.is_empty() && self.minima.is_empty() {
                return false;
            }
            self.settle(answered);
        }
        self.round = self.settings.rounds;
        self.descend_coarse();
        true
    }
}
