//! The interface of every search: ask for points, tell what they cost.

use crate::points::Points;
use crate::problem::{Derivatives, Fidelity, Kind};
use crate::status::Status;
use serde::{Deserialize, Serialize};

/// Points that a search wants to know about, in the unit cube.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Request {
    /// What is asked of them.
    pub kind: Kind,
    /// The record on which it is asked.
    pub fidelity: Fidelity,
    /// The points.
    pub points: Points,
}

impl Request {
    /// Costs on the whole record.
    pub fn costs(points: Points) -> Self {
        Self {
            kind: Kind::Costs,
            fidelity: Fidelity::Full,
            points,
        }
    }

    /// Costs with derivatives on the whole record.
    pub fn derivatives(points: Points) -> Self {
        Self {
            kind: Kind::Derivatives,
            fidelity: Fidelity::Full,
            points,
        }
    }
}

/// What they cost, in the order asked. Every cost is finite or positive infinity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Answers {
    /// Answers to [`Kind::Costs`].
    Costs(#[serde(with = "crate::bits")] Vec<f64>),
    /// Answers to [`Kind::Derivatives`], in the coordinates of the unit cube.
    Derivatives(Vec<Derivatives>),
}

impl Answers {
    /// The kind of request that these answer.
    pub fn kind(&self) -> Kind {
        match self {
            Answers::Costs(_) => Kind::Costs,
            Answers::Derivatives(_) => Kind::Derivatives,
        }
    }

    pub(crate) fn none(kind: Kind) -> Self {
        match kind {
            Kind::Costs => Answers::Costs(Vec::new()),
            Kind::Derivatives => Answers::Derivatives(Vec::new()),
        }
    }

    /// How many.
    pub fn len(&self) -> usize {
        match self {
            Answers::Costs(costs) => costs.len(),
            Answers::Derivatives(all) => all.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The cost of one point.
    pub fn cost(&self, i: usize) -> f64 {
        match self {
            Answers::Costs(costs) => costs[i],
            Answers::Derivatives(all) => all[i].cost,
        }
    }
}

/// Which part of a search the evaluations belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// The method itself.
    Search,
    /// The least squares after it.
    Finish,
}

/// A search as a state machine over the unit cube: its state is all that there is, so a saved state
/// goes on exactly where it was.
pub trait Search {
    /// The points to evaluate next; `None` once it has ended. Asks and tells alternate.
    fn ask(&mut self) -> Option<Request>;

    /// Takes the answers to the last request, all of them.
    fn tell(&mut self, answers: &Answers);

    /// How it ended; `None` while it goes on.
    fn status(&self) -> Option<Status>;

    /// The part that the last request belongs to.
    fn phase(&self) -> Phase {
        Phase::Search
    }

    /// Generation and costs of the population after the last answers, if they completed one.
    fn population(&self) -> Option<(usize, Vec<f64>)> {
        None
    }

    /// The budget for evaluations of the last request's kind is used up: `answered` holds the
    /// answers to the first points of that request, and there will be no more. True if the search
    /// can go on with another kind; otherwise the search is not changed.
    fn exhausted(&mut self, answered: &Answers) -> bool {
        let _ = answered;
        false
    }
}
