//! Any search followed by least squares from its best points.

use crate::error::{Error, require};
use crate::lockstep::{Waiting, ask_all, descents, status_of, tell_all};
use crate::niches::Niches;
use crate::points::Points;
use crate::problem::{Fidelity, Kind};
use crate::search::{Answers, Phase, Request, Search};
use crate::status::Status;
use serde::{Deserialize, Serialize};

/// The least squares after a search.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finish {
    /// Descents, 1 to 1000, from the best points that are apart. Default 3.
    pub starts: usize,
    /// Least distance of two starts, greatest over the dimensions, in widths of the box, 0 to 1.
    /// Default 0.05.
    pub apart: f64,
    /// Most steps of a descent. Default 100.
    pub steps: usize,
}

impl Default for Finish {
    fn default() -> Self {
        Self {
            starts: 3,
            apart: 0.05,
            steps: 100,
        }
    }
}

impl Finish {
    pub(crate) fn check(&self) -> Result<(), Error> {
        let ok = |v: usize, most: usize| (1..=most).contains(&v);
        let (starts, steps) = (self.starts, self.steps);
        let within = ok(starts, 1000);
        require(within, "finish", "starts", starts as f64, "1 to 1000")?;
        let within = ok(steps, 100_000);
        require(within, "finish", "steps", steps as f64, "1 to 100000")?;
        let apart = self.apart;
        require(
            (0.0..=1.0).contains(&apart),
            "finish",
            "apart",
            apart,
            "0 to 1",
        )
    }
}

/// A search, and the descents after it. The finish begins when the search has ended, or when its
/// budget of costs is used up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finished<S> {
    search: S,
    finish: Option<Finish>,
    niches: Niches,
    asked: Option<(Fidelity, Points)>,
    descents: Option<Vec<Waiting>>,
}

impl<S: Search> Finished<S> {
    /// Puts a finish after a search over `dimensions` dimensions; `None` leaves the search as it is.
    pub fn new(search: S, finish: Option<Finish>, dimensions: usize) -> Result<Self, Error> {
        let settings = finish.clone().unwrap_or_default();
        settings.check()?;
        Ok(Self {
            search,
            finish,
            niches: Niches::new(settings.starts, settings.apart, dimensions),
            asked: None,
            descents: None,
        })
    }

    /// The search itself.
    pub fn search(&self) -> &S {
        &self.search
    }

    /// Keeps the best of what was asked.
    fn keep(&mut self, answers: &Answers) {
        if let Some((Fidelity::Full, points)) = self.asked.take() {
            for (i, point) in points.rows().take(answers.len()).enumerate() {
                self.niches.offer(point, answers.cost(i));
            }
        }
    }

    /// Begins the descents; false if there is nothing to finish, or nowhere to start.
    fn begin(&mut self) -> bool {
        let Some(finish) = &self.finish else {
            return false;
        };
        if self.descents.is_some() || self.niches.points().is_empty() {
            return false;
        }
        self.descents = Some(descents(self.niches.points().rows(), finish.steps));
        true
    }
}

impl<S: Search> Search for Finished<S> {
    fn ask(&mut self) -> Option<Request> {
        if self.descents.is_none() {
            if let Some(request) = self.search.ask() {
                if self.finish.is_some() {
                    self.asked = Some((request.fidelity, request.points.clone()));
                }
                return Some(request);
            }
            self.begin();
        }
        ask_all(self.descents.as_ref()?).map(Request::derivatives)
    }

    fn tell(&mut self, answers: &Answers) {
        if let Some(descents) = &mut self.descents {
            if let Answers::Derivatives(all) = answers {
                tell_all(descents, all);
            }
            return;
        }
        self.keep(answers);
        self.search.tell(answers);
    }

    fn status(&self) -> Option<Status> {
        match &self.descents {
            // If the generations or the budget of the search were used up, convergence of the least squares does
            // not count.
            Some(descents) => status_of(descents).map(|status| match self.search.status() {
                None | Some(Status::Exhausted) if status == Status::Converged => Status::Exhausted,
                _ => status,
            }),
            None if self.finish.is_some() && !self.niches.points().is_empty() => None,
            None => self.search.status(),
        }
    }

    fn phase(&self) -> Phase {
        match self.descents {
            Some(_) => Phase::Finish,
            None => self.search.phase(),
        }
    }

    fn population(&self) -> Option<(usize, Vec<f64>)> {
        match self.descents {
            Some(_) => None,
            None => self.search.population(),
        }
    }

    fn exhausted(&mut self, answered: &Answers) -> bool {
        if self.descents.is_some() {
            return false;
        }
        if self.search.exhausted(answered) {
            self.keep(answered);
            return true;
        }
        if self.finish.is_none() || answered.kind() != Kind::Costs {
            return false;
        }
        self.keep(answered);
        self.begin()
    }
}
