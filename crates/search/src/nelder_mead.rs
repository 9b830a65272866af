//! `nelder-mead`: the simplex method with coefficients that follow the dimension, restarted.
//!
//! Steps as Lagarias et al. 1998 (doi 10.1137/S1052623496303470), sec. 2, state them; coefficients of
//! Gao and Han 2012 (doi 10.1007/s10589-010-9329-3): reflection 1, expansion `1 + 2/n`, contraction
//! `3/4 - 1/(2n)`, shrinkage `1 - 1/n` (for one dimension those of two). Points outside the box are
//! moved to its bound.

use crate::bits;
use crate::error::{Error, require};
use crate::points::Points;
use crate::random::sobol;
use crate::search::{Answers, Request, Search};
use crate::status::Status;
use serde::{Deserialize, Serialize};

/// Width of a simplex, relative to [`Settings::width`], below which it has collapsed whatever its costs:
/// further moves do not change them any more.
const COLLAPSED_WIDTH: f64 = 1e-6;

/// Settings of the simplex method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Number of simplices, one after the other, 1 to 100 000. They start in turn at a point of a
    /// Sobol sequence, which differs from seed to seed, and at the best point so far. Default 20.
    pub simplices: usize,
    /// Edge of a new simplex in widths of the box, above 0 to 0.5. Default 0.2.
    pub edge: f64,
    /// A simplex is done when it is no wider than this, above 0. Default 1e-8.
    pub width: f64,
    /// And its costs differ by no more than this, relative to the least, 0 or more. Default 1e-9.
    pub spread: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            simplices: 20,
            edge: 0.2,
            width: 1e-8,
            spread: 1e-9,
        }
    }
}

/// What the outstanding answer is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum Step {
    New,
    Reflect,
    Expand,
    ContractOutside,
    ContractInside,
    Shrink,
}

/// A simplex of `n + 1` points, best first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NelderMead {
    settings: Settings,
    seed: u64,
    simplex: Points,
    #[serde(with = "bits")]
    costs: Vec<f64>,
    step: Step,
    asked: Points,
    #[serde(with = "bits")]
    reflected: Vec<f64>,
    #[serde(with = "bits")]
    reflected_cost: f64,
    #[serde(with = "bits")]
    best: Vec<f64>,
    #[serde(with = "bits")]
    best_cost: f64,
    begun: usize,
    status: Option<Status>,
}

impl NelderMead {
    /// Starts the search in the unit cube.
    pub fn new(settings: Settings, dimensions: usize, seed: u64) -> Result<Self, Error> {
        let (m, edge) = (settings.simplices, settings.edge);
        let name = "nelder-mead";
        let within = (1..=100_000).contains(&m);
        require(within, name, "simplices", m as f64, "1 to 100000")?;
        let within = edge > 0.0 && edge <= 0.5;
        require(within, name, "edge", edge, "above 0 to 0.5")?;
        let (width, spread) = (settings.width, settings.spread);
        require(width > 0.0, name, "width", width, "above 0")?;
        require(spread >= 0.0, name, "spread", spread, "0 or more")?;
        let mut search = Self {
            settings,
            seed,
            simplex: Points::new(dimensions),
            costs: Vec::new(),
            step: Step::New,
            asked: Points::new(dimensions),
            reflected: Vec::new(),
            reflected_cost: f64::INFINITY,
            best: vec![0.5; dimensions],
            best_cost: f64::INFINITY,
            begun: 0,
            status: None,
        };
        search.begin();
        Ok(search)
    }

    fn dimensions(&self) -> usize {
        self.simplex.dimensions()
    }

    /// A new right-angled simplex, its edges pointing to the middle of the box.
    fn begin(&mut self) {
        let n = self.dimensions();
        let corner = if self.begun.is_multiple_of(2) {
            sobol(self.begun / 2, n, self.seed)
        } else {
            self.best.clone()
        };
        self.begun += 1;
        self.asked = Points::new(n);
        self.asked.push(&corner);
        for j in 0..n {
            let mut point = corner.clone();
            let edge = self.settings.edge;
            point[j] += if point[j] > 0.5 { -edge } else { edge };
            self.asked.push(&point);
        }
        self.step = Step::New;
    }

    /// The centre of all points but the worst, plus `t` times the way from the worst to it.
    fn along(&self, t: f64) -> Vec<f64> {
        let n = self.dimensions();
        let worst = self.simplex.row(n);
        (0..n)
            .map(|j| {
                let centre = (0..n).map(|i| self.simplex.row(i)[j]).sum::<f64>() / n as f64;
                ((1.0 + t) * centre - t * worst[j]).clamp(0.0, 1.0)
            })
            .collect()
    }

    /// Expansion, contraction and shrinkage.
    fn coefficients(&self) -> [f64; 3] {
        let n = self.dimensions().max(2) as f64;
        [1.0 + 2.0 / n, 0.75 - 0.5 / n, 1.0 - 1.0 / n]
    }

    fn try_at(&mut self, step: Step, t: f64) {
        let point = self.along(t);
        self.step = step;
        self.asked = Points::new(point.len());
        self.asked.push(&point);
    }

    /// Puts a point in the place of the worst.
    fn replace(&mut self, point: &[f64], cost: f64) {
        let n = self.dimensions();
        self.simplex.row_mut(n).copy_from_slice(point);
        self.costs[n] = cost;
        self.go_on();
    }

    fn shrink(&mut self) {
        let [_, _, shrinkage] = self.coefficients();
        let mut points = Points::new(self.dimensions());
        let best = self.simplex.row(0).to_vec();
        for x in self.simplex.rows().skip(1) {
            let moved = best.iter().zip(x).map(|(b, x)| b + shrinkage * (x - b));
            points.push(&moved.collect::<Vec<_>>());
        }
        self.asked = points;
        self.step = Step::Shrink;
    }

    /// Orders the simplex, and reflects or begins anew.
    fn go_on(&mut self) {
        let order = crate::genetic::least(&self.costs, self.costs.len());
        let mut simplex = Points::new(self.dimensions());
        for &i in &order {
            simplex.push(self.simplex.row(i));
        }
        self.costs = order.iter().map(|&i| self.costs[i]).collect();
        self.simplex = simplex;
        if self.costs[0] < self.best_cost {
            self.best_cost = self.costs[0];
            self.best = self.simplex.row(0).to_vec();
        }
        if !self.done() {
            self.try_at(Step::Reflect, 1.0);
        } else if self.begun == self.settings.simplices {
            self.status = Some(if self.best_cost.is_finite() {
                Status::Converged
            } else {
                Status::Stalled
            });
        } else {
            self.begin();
        }
    }

    fn done(&self) -> bool {
        let first = self.simplex.row(0);
        let width = (self.simplex.rows().skip(1))
            .flat_map(|x| x.iter().zip(first).map(|(a, b)| (a - b).abs()))
            .fold(0.0, f64::max);
        let last = self.costs[self.costs.len() - 1];
        let rise = last - self.costs[0];
        // A simplex with only infinite costs has no direction to move in.
        self.costs[0].is_infinite()
            || (width <= self.settings.width && rise <= self.settings.spread * self.costs[0].abs())
            || width <= COLLAPSED_WIDTH * self.settings.width
    }
}

impl Search for NelderMead {
    fn ask(&mut self) -> Option<Request> {
        match self.status {
            None => Some(Request::costs(self.asked.clone())),
            Some(_) => None,
        }
    }

    fn tell(&mut self, answers: &Answers) {
        let n = self.dimensions();
        let [expansion, contraction, _] = self.coefficients();
        let cost = answers.cost(0);
        let asked = self.asked.row(0).to_vec();
        match self.step {
            Step::New => {
                self.simplex = self.asked.clone();
                self.costs = (0..=n).map(|i| answers.cost(i)).collect();
                self.go_on();
            }
            Step::Reflect => {
                (self.reflected, self.reflected_cost) = (asked, cost);
                if cost < self.costs[0] {
                    self.try_at(Step::Expand, expansion);
                } else if cost < self.costs[n - 1] {
                    let point = self.reflected.clone();
                    self.replace(&point, cost);
                } else if cost < self.costs[n] {
                    self.try_at(Step::ContractOutside, contraction);
                } else {
                    self.try_at(Step::ContractInside, -contraction);
                }
            }
            Step::Expand if cost < self.reflected_cost => self.replace(&asked, cost),
            Step::Expand => {
                let point = self.reflected.clone();
                self.replace(&point, self.reflected_cost);
            }
            Step::ContractOutside if cost <= self.reflected_cost => self.replace(&asked, cost),
            Step::ContractInside if cost < self.costs[n] => self.replace(&asked, cost),
            Step::ContractOutside | Step::ContractInside => self.shrink(),
            Step::Shrink => {
                for i in 0..n {
                    self.simplex
                        .row_mut(i + 1)
                        .copy_from_slice(self.asked.row(i));
                    self.costs[i + 1] = answers.cost(i);
                }
                self.go_on();
            }
        }
    }

    fn status(&self) -> Option<Status> {
        self.status
    }
}
