//! The methods by name, and a plan for a run.

use crate::annealing::{self, Annealing};
use crate::bounds::MOST_DIMENSIONS;
use crate::cma_es::{self, CmaEs};
use crate::differential_evolution::{self, DifferentialEvolution};
use crate::error::Error;
use crate::finish::{Finish, Finished};
use crate::genetic::{self, Genetic};
use crate::levenberg::{self, Levenberg};
use crate::nelder_mead::{self, NelderMead};
use crate::niched::{self, NichedGa};
use crate::particle_swarm::{self, ParticleSwarm};
use crate::search::{Answers, Phase, Request, Search};
use crate::status::Status;
use serde::{Deserialize, Serialize};

/// A method with its settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Plain genetic algorithm.
    Ga(genetic::Settings),
    /// The same with adaptive rates.
    AdaptiveGa(genetic::Settings),
    /// Annealing genetic algorithm of Zhang et al. 2025.
    AnnealingGa(genetic::Settings),
    /// Niched annealing genetic algorithm with descents.
    NichedGa(niched::Settings),
    /// Differential evolution.
    De(differential_evolution::Settings),
    /// Covariance matrix adaptation.
    CmaEs(cma_es::Settings),
    /// Particle swarm.
    Pso(particle_swarm::Settings),
    /// Simulated annealing.
    Annealing(annealing::Settings),
    /// Simplex method.
    NelderMead(nelder_mead::Settings),
    /// Least squares from many starts.
    Lm(levenberg::Settings),
}

impl Method {
    /// The names that [`Method::named`] knows.
    pub const NAMES: [&str; 10] = [
        "ga",
        "adaptive-ga",
        "annealing-ga",
        "niched-ga",
        "de",
        "cma-es",
        "pso",
        "annealing",
        "nelder-mead",
        "lm",
    ];

    /// A method with its default settings.
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "ga" => Method::Ga(genetic::Settings::plain()),
            "adaptive-ga" => Method::AdaptiveGa(genetic::Settings::adaptive()),
            "annealing-ga" => Method::AnnealingGa(genetic::Settings::default()),
            "niched-ga" => Method::NichedGa(niched::Settings::default()),
            "de" => Method::De(differential_evolution::Settings::default()),
            "cma-es" => Method::CmaEs(cma_es::Settings::default()),
            "pso" => Method::Pso(particle_swarm::Settings::default()),
            "annealing" => Method::Annealing(annealing::Settings::default()),
            "nelder-mead" => Method::NelderMead(nelder_mead::Settings::default()),
            "lm" => Method::Lm(levenberg::Settings::default()),
            _ => return None,
        })
    }

    /// Its name.
    pub fn name(&self) -> &'static str {
        match self {
            Method::Ga(_) => "ga",
            Method::AdaptiveGa(_) => "adaptive-ga",
            Method::AnnealingGa(_) => "annealing-ga",
            Method::NichedGa(_) => "niched-ga",
            Method::De(_) => "de",
            Method::CmaEs(_) => "cma-es",
            Method::Pso(_) => "pso",
            Method::Annealing(_) => "annealing",
            Method::NelderMead(_) => "nelder-mead",
            Method::Lm(_) => "lm",
        }
    }

    /// Whether its settings are within what it allows.
    ///
    /// # Errors
    /// For a setting outside its range.
    pub fn check(&self) -> Result<(), Error> {
        self.start(1, 0).map(|_| ())
    }

    /// The search in a box of `dimensions` dimensions.
    pub fn start(&self, dimensions: usize, seed: u64) -> Result<Searcher, Error> {
        let (n, name) = (dimensions, self.name());
        if !(1..=MOST_DIMENSIONS).contains(&n) {
            return Err(Error::Dimensions {
                low: n,
                high: n,
                most: MOST_DIMENSIONS,
            });
        }
        Ok(match self.clone() {
            Method::Ga(s) | Method::AdaptiveGa(s) | Method::AnnealingGa(s) => {
                Searcher::Genetic(Genetic::new(s, name, n, seed)?)
            }
            Method::NichedGa(s) => Searcher::Niched(NichedGa::new(s, n, seed)?),
            Method::De(s) => Searcher::De(DifferentialEvolution::new(s, n, seed)?),
            Method::CmaEs(s) => Searcher::CmaEs(CmaEs::new(s, n, seed)?),
            Method::Pso(s) => Searcher::Pso(ParticleSwarm::new(s, n, seed)?),
            Method::Annealing(s) => Searcher::Annealing(Annealing::new(s, n, seed)?),
            Method::NelderMead(s) => Searcher::NelderMead(NelderMead::new(s, n, seed)?),
            Method::Lm(s) => Searcher::Lm(Levenberg::new(s, n, seed)?),
        })
    }
}

/// A method, and whether least squares follow it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// The method.
    pub method: Method,
    /// The least squares after it; `None` for none.
    pub finish: Option<Finish>,
}

impl Plan {
    /// A method with default settings; the annealing GA, whose precision module includes them, is
    /// followed by least squares.
    pub fn named(name: &str) -> Option<Self> {
        let method = Method::named(name)?;
        let finish = matches!(method, Method::AnnealingGa(_)).then(Finish::default);
        Some(Self { method, finish })
    }

    /// The same with least squares after it.
    pub fn finished(self, finish: Finish) -> Self {
        Self {
            finish: Some(finish),
            ..self
        }
    }

    /// The search that a [`Run`](crate::Run) takes, in a box of `dimensions` dimensions.
    pub fn start(&self, dimensions: usize, seed: u64) -> Result<Finished<Searcher>, Error> {
        let search = self.method.start(dimensions, seed)?;
        Finished::new(search, self.finish.clone(), dimensions)
    }
}

/// Any of the searches.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub enum Searcher {
    Genetic(Genetic),
    Niched(NichedGa),
    De(DifferentialEvolution),
    CmaEs(CmaEs),
    Pso(ParticleSwarm),
    Annealing(Annealing),
    NelderMead(NelderMead),
    Lm(Levenberg),
}

macro_rules! each {
    ($self:ident, $search:ident => $call:expr) => {
        match $self {
            Searcher::Genetic($search) => $call,
            Searcher::Niched($search) => $call,
            Searcher::De($search) => $call,
            Searcher::CmaEs($search) => $call,
            Searcher::Pso($search) => $call,
            Searcher::Annealing($search) => $call,
            Searcher::NelderMead($search) => $call,
            Searcher::Lm($search) => $call,
        }
    };
}

impl Search for Searcher {
    fn ask(&mut self) -> Option<Request> {
        each!(self, search => search.ask())
    }

    fn tell(&mut self, answers: &Answers) {
        each!(self, search => search.tell(answers))
    }

    fn status(&self) -> Option<Status> {
        each!(self, search => search.status())
    }

    fn phase(&self) -> Phase {
        each!(self, search => search.phase())
    }

    fn population(&self) -> Option<(usize, Vec<f64>)> {
        each!(self, search => search.population())
    }

    fn exhausted(&mut self, answered: &Answers) -> bool {
        each!(self, search => search.exhausted(answered))
    }
}
