//! `pso`: particle swarm with constriction on a ring.
//!
//! Velocities by Clerc and Kennedy 2002 (doi 10.1109/4235.985692), `phi = 4.1`; each particle knows
//! itself and its two neighbours on a ring, as Bratton and Kennedy 2007
//! (doi 10.1109/SIS.2007.368035) recommend.

use crate::bits;
use crate::error::{Error, require};
use crate::points::Points;
use crate::random::Dice;
use crate::search::{Answers, Request, Search};
use crate::status::Status;
use serde::{Deserialize, Serialize};

/// Constriction `2/|2 - phi - sqrt(phi^2 - 4 phi)|` for `phi = 4.1`.
const CONSTRICTION: f64 = 0.729_843_788_127_783_6;
/// Each half of `phi`: the attraction of a particle by its own best and by that of its neighbours (Clerc and
/// Kennedy 2002).
const ATTRACTION: f64 = 2.05;

/// Settings of the particle swarm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Particles, 3 to 100 000. Default 50.
    pub particles: usize,
    /// Generations, 1 to 1 000 000. Default 1000.
    pub generations: usize,
    /// Converged when all bests lie within this part of the box, >= 0. Default 1e-8.
    pub spread: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            particles: 50,
            generations: 1000,
            spread: 1e-8,
        }
    }
}

/// A swarm: places, velocities, and where each particle has been best.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParticleSwarm {
    settings: Settings,
    dice: Dice,
    places: Points,
    velocities: Points,
    bests: Points,
    #[serde(with = "bits")]
    costs: Vec<f64>,
    generation: usize,
    status: Option<Status>,
}

impl ParticleSwarm {
    /// Starts the search in the unit cube.
    pub fn new(settings: Settings, dimensions: usize, seed: u64) -> Result<Self, Error> {
        let (n, g) = (settings.particles, settings.generations);
        let size = |name, v: usize, ok: bool, allowed| require(ok, "pso", name, v as f64, allowed);
        size("particles", n, (3..=100_000).contains(&n), "3 to 100000")?;
        let within = (1..=1_000_000).contains(&g);
        size("generations", g, within, "1 to 1000000")?;
        let spread = settings.spread;
        require(spread >= 0.0, "pso", "spread", spread, "0 or more")?;
        let mut dice = Dice::new(seed);
        let (mut places, mut velocities) = (Points::new(dimensions), Points::new(dimensions));
        for _ in 0..n {
            let (x, y) = (dice.point(dimensions), dice.point(dimensions));
            let half: Vec<f64> = x.iter().zip(&y).map(|(x, y)| 0.5 * (y - x)).collect();
            places.push(&x);
            velocities.push(&half);
        }
        Ok(Self {
            settings,
            dice,
            bests: places.clone(),
            costs: vec![f64::INFINITY; n],
            places,
            velocities,
            generation: 0,
            status: None,
        })
    }

    /// The best of a particle and its neighbours.
    fn neighbour(&self, i: usize) -> usize {
        let n = self.costs.len();
        let mut best = i;
        for k in [(i + n - 1) % n, (i + 1) % n] {
            if self.costs[k] < self.costs[best] {
                best = k;
            }
        }
        best
    }

    fn fly(&mut self) {
        for i in 0..self.costs.len() {
            let leader = self.neighbour(i);
            for j in 0..self.places.dimensions() {
                let x = self.places.row(i)[j];
                let own = ATTRACTION * self.dice.unit() * (self.bests.row(i)[j] - x);
                let social = ATTRACTION * self.dice.unit() * (self.bests.row(leader)[j] - x);
                let mut v = CONSTRICTION * (self.velocities.row(i)[j] + own + social);
                let mut to = x + v;
                if !(0.0..=1.0).contains(&to) {
                    // Stays at the wall.
                    to = to.clamp(0.0, 1.0);
                    v = 0.0;
                }
                self.places.row_mut(i)[j] = to;
                self.velocities.row_mut(i)[j] = v;
            }
        }
    }

    fn converged(&self) -> bool {
        (0..self.bests.dimensions()).all(|j| {
            let (low, high) = self
                .bests
                .rows()
                .fold((1.0f64, 0.0f64), |(l, h), x| (l.min(x[j]), h.max(x[j])));
            high - low <= self.settings.spread
        })
    }
}

impl Search for ParticleSwarm {
    fn ask(&mut self) -> Option<Request> {
        if self.status.is_some() {
            return None;
        }
        if self.generation > 0 {
            self.fly();
        }
        Some(Request::costs(self.places.clone()))
    }

    fn tell(&mut self, answers: &Answers) {
        for i in 0..answers.len() {
            if answers.cost(i) < self.costs[i] {
                self.costs[i] = answers.cost(i);
                self.bests.row_mut(i).copy_from_slice(self.places.row(i));
            }
        }
        self.generation += 1;
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
        let over = self.generation.checked_sub(1)?;
        Some((over, self.costs.clone()))
    }
}
