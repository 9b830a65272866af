//! `cma-es`: covariance matrix adaptation, restarted with growing populations.
//!
//! The distribution and its update are those of Hansen 2016, "The CMA Evolution Strategy: A Tutorial"
//! (arXiv 1604.00772), appendix A with negative weights; restarts double the population (Auger and
//! Hansen 2005, doi 10.1109/CEC.2005.1554902). The distribution lives in the whole space: a point
//! outside the unit cube is evaluated where reflection at its walls leads to.

mod distribution;
mod weights;

use crate::bits;
use crate::error::{Error, require};
use crate::genetic::least;
use crate::points::Points;
use crate::random::Dice;
use crate::search::{Answers, Request, Search};
use crate::status::Status;
use distribution::Distribution;
use serde::{Deserialize, Serialize};

/// Settings of CMA-ES.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Points of a generation, 4 to 10 000; `None` takes `4 + floor(3 ln n)`.
    pub population: Option<usize>,
    /// First deviation in widths of the box, above 0 to 1. Default .3.
    pub deviation: f64,
    /// Restarts, each with twice the population, 0 to 100; at most 10 000 points a generation.
    /// Default 9.
    pub restarts: usize,
    /// A run has converged when the costs of its last generations differ by no more than this,
    /// relative to the least; 0 or more. Default 1e-12.
    pub spread: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            population: None,
            deviation: 0.3,
            restarts: 9,
            spread: 1e-12,
        }
    }
}

/// Most points of a generation.
const MOST_POINTS: usize = 10_000;

/// A distribution and the generation drawn from it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CmaEs {
    settings: Settings,
    dice: Dice,
    size: usize,
    distribution: Distribution,
    drawn: Points,
    #[serde(with = "bits")]
    costs: Vec<f64>,
    /// The least cost of each of the last generations.
    #[serde(with = "bits")]
    recent: Vec<f64>,
    run: usize,
    of_run: usize,
    generation: usize,
    status: Option<Status>,
}

impl CmaEs {
    /// Starts the search in the middle of the unit cube.
    pub fn new(settings: Settings, dimensions: usize, seed: u64) -> Result<Self, Error> {
        let name = "cma-es";
        let usual = 4 + libm::floor(3.0 * libm::log(dimensions as f64)) as usize;
        let size = settings.population.unwrap_or(usual);
        let within = (4..=MOST_POINTS).contains(&size);
        require(within, name, "population", size as f64, "4 to 10000")?;
        let deviation = settings.deviation;
        let within = deviation > 0.0 && deviation <= 1.0;
        require(within, name, "deviation", deviation, "above 0 to 1")?;
        let restarts = settings.restarts;
        let within = restarts <= 100;
        require(within, name, "restarts", restarts as f64, "0 to 100")?;
        let spread = settings.spread;
        require(spread >= 0.0, name, "spread", spread, "0 or more")?;
        Ok(Self {
            dice: Dice::new(seed),
            size,
            distribution: Distribution::new(vec![0.5; dimensions], deviation, size),
            drawn: Points::new(dimensions),
            costs: Vec::new(),
            recent: Vec::new(),
            run: 0,
            of_run: 0,
            generation: 0,
            status: None,
            settings,
        })
    }

    /// Generations that the least costs are remembered for.
    fn window(&self) -> usize {
        10 + (30 * self.drawn.dimensions()).div_ceil(self.size)
    }

    /// How this run has ended, if it has.
    fn ended(&self) -> Option<Status> {
        let n = self.drawn.dimensions() as f64;
        let most = 100.0 + 150.0 * (n + 3.0) * (n + 3.0) / (self.size as f64).sqrt();
        let all = self.recent.iter().chain(&self.costs);
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &c| {
            (l.min(c), h.max(c))
        });
        if self.recent.len() == self.window() {
            if low.is_infinite() {
                return Some(Status::Stalled);
            }
            if high - low <= self.settings.spread * low.abs() {
                return Some(Status::Converged);
            }
        }
        if self.distribution.is_degenerate() {
            return Some(Status::Converged);
        }
        (self.of_run as f64 >= most).then_some(Status::Exhausted)
    }

    /// A new run from a random point, with twice the population.
    fn restart(&mut self) {
        self.run += 1;
        self.of_run = 0;
        self.size = (2 * self.size).min(MOST_POINTS);
        self.recent.clear();
        let mean = self.dice.point(self.drawn.dimensions());
        self.distribution = Distribution::new(mean, self.settings.deviation, self.size);
    }
}

/// The place in 0..1 that reflection at both ends leads to.
fn mirrored(x: f64) -> f64 {
    let t = x - 2.0 * libm::floor(0.5 * x);
    if t > 1.0 { 2.0 - t } else { t }
}

impl Search for CmaEs {
    fn ask(&mut self) -> Option<Request> {
        if self.status.is_some() {
            return None;
        }
        self.drawn = self.distribution.draw(self.size, &mut self.dice);
        let mut points = Points::new(self.drawn.dimensions());
        for row in self.drawn.rows() {
            let inside: Vec<f64> = row.iter().map(|&x| mirrored(x)).collect();
            points.push(&inside);
        }
        Some(Request::costs(points))
    }

    fn tell(&mut self, answers: &Answers) {
        self.costs = (0..answers.len()).map(|i| answers.cost(i)).collect();
        let order = least(&self.costs, self.costs.len());
        self.distribution.update(&self.drawn, &order);
        self.generation += 1;
        self.of_run += 1;
        if self.recent.len() == self.window() {
            self.recent.remove(0);
        }
        self.recent.push(self.costs[order[0]]);
        if let Some(status) = self.ended() {
            if self.run == self.settings.restarts {
                self.status = Some(status);
            } else {
                self.restart();
            }
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

#[cfg(test)]
mod tests {
    use super::mirrored;

    #[test]
    fn walls_reflect() {
        for (x, to) in [
            (0.25, 0.25),
            (1.25, 0.75),
            (-0.25, 0.25),
            (2.25, 0.25),
            (-1.5, 0.5),
        ] {
            assert_eq!(mirrored(x), to);
        }
        assert!((0.0..=1.0).contains(&mirrored(1e300)));
    }
}
