//! `lm`: least squares from many starts, in lockstep.

use crate::error::{Error, require};
use crate::lockstep::{Waiting, ask_all, descents, status_of, tell_all};
use crate::points::Points;
use crate::random::sobol;
use crate::search::{Answers, Request, Search};
use crate::status::Status;
use serde::{Deserialize, Serialize};

/// Settings of the multi-start Levenberg-Marquardt method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Points of a scrambled Sobol sequence whose costs are asked first; the best of them are the
    /// starts. 0 takes the first points of the sequence as they come. Default 64.
    pub scan: usize,
    /// Descents, 1 to 100 000. Default 8.
    pub starts: usize,
    /// Most steps of a descent. Default 100.
    pub steps: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            scan: 64,
            starts: 8,
            steps: 100,
        }
    }
}

/// The descents of all starts go on together: each request holds one point for each that has not
/// ended, so that a kernel can evaluate them side by side.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Levenberg {
    settings: Settings,
    scanned: Option<Points>,
    descents: Vec<Waiting>,
}

impl Levenberg {
    /// Starts the search in the unit cube.
    pub fn new(settings: Settings, dimensions: usize, seed: u64) -> Result<Self, Error> {
        check(&settings)?;
        let many = settings.scan.max(settings.starts);
        let mut points = Points::new(dimensions);
        for i in 0..many {
            points.push(&sobol(i, dimensions, seed));
        }
        let mut search = Self {
            settings,
            scanned: None,
            descents: Vec::new(),
        };
        if search.settings.scan > search.settings.starts {
            search.scanned = Some(points);
        } else {
            search.descents = descents(points.rows(), search.settings.steps);
        }
        Ok(search)
    }
}

/// Checks the settings.
pub(crate) fn check(settings: &Settings) -> Result<(), Error> {
    let allowed = "1 to 100000";
    let starts = settings.starts;
    let within = (1..=100_000).contains(&starts);
    require(within, "lm", "starts", starts as f64, allowed)?;
    let scan = settings.scan;
    require(scan <= 1_000_000, "lm", "scan", scan as f64, "0 to 1000000")?;
    let steps = settings.steps;
    require(
        (1..=100_000).contains(&steps),
        "lm",
        "steps",
        steps as f64,
        allowed,
    )
}

impl Search for Levenberg {
    fn ask(&mut self) -> Option<Request> {
        match &self.scanned {
            Some(points) => Some(Request::costs(points.clone())),
            None => ask_all(&self.descents).map(Request::derivatives),
        }
    }

    fn tell(&mut self, answers: &Answers) {
        match answers {
            Answers::Derivatives(all) => tell_all(&mut self.descents, all),
            Answers::Costs(costs) => {
                let Some(points) = self.scanned.take() else {
                    return;
                };
                let mut order: Vec<usize> = (0..points.len()).collect();
                order.sort_by(|&a, &b| costs[a].total_cmp(&costs[b]));
                let best = order.iter().take(self.settings.starts);
                self.descents = descents(best.map(|&i| points.row(i)), self.settings.steps);
            }
        }
    }

    fn status(&self) -> Option<Status> {
        match self.scanned {
            Some(_) => None,
            None => status_of(&self.descents),
        }
    }
}
