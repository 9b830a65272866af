//! The loop around a search: evaluates what it asks for, keeps count, the best and the course.

use crate::bits;
use crate::bounds::Bounds;
use crate::error::Error;
use crate::history::History;
use crate::observe::{Control, Counts, Limits, Observer, Progress};
use crate::points::Points;
use crate::problem::{Derivatives, Fidelity, Kind, Problem};
use crate::search::{Answers, Phase, Request, Search};
use crate::status::Status;
use serde::{Deserialize, Serialize};

/// A point on the full record and what it costs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Best {
    /// In the coordinates of the problem's box.
    #[serde(with = "bits")]
    pub point: Vec<f64>,
    /// Its cost, finite.
    #[serde(with = "bits")]
    pub cost: f64,
    /// Evaluations until it was found, itself included.
    pub counts: Counts,
}

/// Part of an evaluation that is rounding: shares of coarse evaluations add up to whole ones with an error.
const EVALUATION_ROUNDING: f64 = 1e-9;

/// A running search. All of its state is here and can be saved: a run that was interrupted, written
/// out and read back goes on with the same bits as one that never stopped. Only what a run wrote may
/// be read back; a caller that stores it in a file has to check that the file is intact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run<S> {
    search: S,
    bounds: Bounds,
    pending: Option<Pending>,
    counts: Counts,
    best: Option<Best>,
    own: Option<Own>,
    history: History,
}

/// A request and the answers there are so far.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Pending {
    request: Request,
    answers: Answers,
}

/// How far the method itself came, when the least squares after it first began.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Own {
    best: Option<Best>,
    counts: Counts,
}

impl<S: Search> Run<S> {
    /// A run that has not begun. The search must have been started with the problem's dimensions.
    pub fn new(search: S, problem: &impl Problem) -> Self {
        Self {
            search,
            bounds: problem.bounds().clone(),
            pending: None,
            counts: Counts::default(),
            best: None,
            own: None,
            history: History::default(),
        }
    }

    /// Goes on until the search ends or a limit is reached. A budget is spent to the last evaluation
    /// and never exceeded; with a larger one the run may be taken up again.
    pub fn advance(
        &mut self,
        problem: &impl Problem,
        limits: &Limits,
        observer: &mut dyn Observer,
    ) -> Result<Status, Error> {
        if *problem.bounds() != self.bounds {
            return Err(Error::OtherBox);
        }
        let share = problem.coarse_share();
        loop {
            if let (Some(best), Some(target)) = (&self.best, limits.target)
                && best.cost <= target
            {
                return Ok(Status::Target);
            }
            let Some(pending) = self.pending.take().or_else(|| self.next()) else {
                let status = self.search.status().unwrap_or(Status::Stalled);
                return Ok(status);
            };
            let Pending { request, answers } = pending;
            if request.points.dimensions() != self.bounds.dimensions() {
                return Err(Error::OtherBox);
            }
            let left = request.points.len() - answers.len();
            let many = left
                .min(limits.batch.max(1))
                .min(self.affordable(&request, limits, share));
            if many == 0 {
                if self.search.exhausted(&answers) {
                    continue;
                }
                self.pending = Some(Pending { request, answers });
                return Ok(Status::Budget);
            }
            self.evaluate(problem, request, answers, many)?;
            let progress = Progress {
                stage: self.search.phase().into(),
                fraction: limits.fraction(&self.counts, share),
                counts: self.counts,
                best: self.best.as_ref().map_or(f64::INFINITY, |b| b.cost),
            };
            if observer.progress(&progress) == Control::Stop {
                return Ok(Status::Interrupted);
            }
        }
    }

    /// The next request that asks for anything.
    fn next(&mut self) -> Option<Pending> {
        let request = self.search.ask()?;
        if self.own.is_none() && self.search.phase() == Phase::Finish {
            self.own = Some(Own {
                best: self.best.clone(),
                counts: self.counts,
            });
        }
        let answers = Answers::none(request.kind);
        Some(Pending { request, answers })
    }

    /// How many points of a request the budget has left.
    fn affordable(&self, request: &Request, limits: &Limits, share: f64) -> usize {
        let most = match request.kind {
            Kind::Costs => limits.costs,
            Kind::Derivatives => limits.derivatives,
        };
        let each = match request.fidelity {
            Fidelity::Full => 1.0,
            Fidelity::Coarse => share,
        };
        let left = most as f64 - self.counts.of(request.kind, share);
        (left / each + EVALUATION_ROUNDING).max(0.0) as usize
    }

    /// Evaluates the next `many` points, and tells the search once all are there.
    fn evaluate(
        &mut self,
        problem: &impl Problem,
        request: Request,
        mut answers: Answers,
        many: usize,
    ) -> Result<(), Error> {
        let share = problem.coarse_share();
        let from = answers.len();
        let mut points = Points::new(self.bounds.dimensions());
        for row in request.points.rows().skip(from).take(many) {
            points.push(&self.bounds.at(row));
        }
        match &mut answers {
            Answers::Costs(all) => {
                let mut costs = vec![f64::INFINITY; many];
                problem.costs(&points, request.fidelity, &mut costs);
                all.extend(costs.into_iter().map(finite_or_worst));
            }
            Answers::Derivatives(all) => {
                let mut found = vec![Derivatives::zeros(self.bounds.dimensions()); many];
                problem
                    .derivatives(&points, request.fidelity, &mut found)
                    .map_err(|_| Error::NoDerivatives)?;
                all.extend(found.into_iter().map(|d| self.in_the_cube(d)));
            }
        }
        // Without a coarse record there is only the full one.
        let fidelity = match request.fidelity {
            Fidelity::Coarse if share < 1.0 => Fidelity::Coarse,
            _ => Fidelity::Full,
        };
        for (i, point) in points.rows().enumerate() {
            self.counts.count(request.kind, fidelity, 1);
            if fidelity == Fidelity::Full {
                self.note(point, answers.cost(from + i), share);
            }
        }
        if answers.len() < request.points.len() {
            self.pending = Some(Pending { request, answers });
            return Ok(());
        }
        self.search.tell(&answers);
        if let Some((generation, costs)) = self.search.population() {
            let so_far = self.counts.full_records(share);
            self.history.generation(generation, so_far, costs);
        }
        Ok(())
    }

    fn note(&mut self, point: &[f64], cost: f64, share: f64) {
        let least = self.best.as_ref().map_or(f64::INFINITY, |b| b.cost);
        if cost < least {
            self.history.improve(self.counts.full_records(share), cost);
            self.best = Some(Best {
                point: point.to_vec(),
                cost,
                counts: self.counts,
            });
        }
    }

    /// Derivatives with respect to the coordinates of the unit cube.
    fn in_the_cube(&self, mut d: Derivatives) -> Derivatives {
        let n = self.bounds.dimensions();
        for i in 0..n {
            d.gradient[i] *= self.bounds.width(i);
            for j in 0..n {
                d.normal[i * n + j] *= self.bounds.width(i) * self.bounds.width(j);
            }
        }
        let finite = d.gradient.iter().chain(&d.normal).all(|x| x.is_finite());
        d.cost = finite_or_worst(if finite { d.cost } else { f64::INFINITY });
        d
    }

    /// The best point so far; `None` while no cost was finite.
    pub fn best(&self) -> Option<&Best> {
        self.best.as_ref()
    }

    /// The best of the method itself, without the least squares after it.
    pub fn own_best(&self) -> Option<&Best> {
        match &self.own {
            Some(own) => own.best.as_ref(),
            None => self.best(),
        }
    }

    /// Evaluations so far.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Evaluations of the method itself.
    pub fn own_counts(&self) -> Counts {
        self.own.as_ref().map_or(self.counts, |own| own.counts)
    }

    /// The course of the run.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// The search with its state.
    pub fn search(&self) -> &S {
        &self.search
    }
}

/// NaN cannot be compared; replaced by the worst cost it is never chosen.
fn finite_or_worst(cost: f64) -> f64 {
    if cost.is_finite() {
        cost
    } else {
        f64::INFINITY
    }
}
