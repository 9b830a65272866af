//! A search before least squares.

use crate::Error;
use std::fmt;
use std::path::PathBuf;
use stiction_workflows::identify::{self as workflow, CostKind, Options, Searching};

/// A method of searching in a box; docs/searches.md compares them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SearchMethod {
    /// Plain genetic algorithm.
    Genetic,
    /// The same with adaptive rates.
    AdaptiveGenetic,
    /// Annealing genetic algorithm of Zhang et al. 2025.
    AnnealingGenetic,
    /// Niched annealing genetic algorithm with descents.
    NichedGenetic,
    /// Differential evolution.
    DifferentialEvolution,
    /// Covariance matrix adaptation.
    CmaEs,
    /// Particle swarm.
    ParticleSwarm,
    /// Simulated annealing.
    Annealing,
    /// Simplex method.
    NelderMead,
    /// Least squares from many starts.
    LevenbergMarquardt,
}

impl SearchMethod {
    /// All of them, in the order of the command line.
    pub const ALL: [SearchMethod; 10] = [
        SearchMethod::Genetic,
        SearchMethod::AdaptiveGenetic,
        SearchMethod::AnnealingGenetic,
        SearchMethod::NichedGenetic,
        SearchMethod::DifferentialEvolution,
        SearchMethod::CmaEs,
        SearchMethod::ParticleSwarm,
        SearchMethod::Annealing,
        SearchMethod::NelderMead,
        SearchMethod::LevenbergMarquardt,
    ];

    /// Name as typed on the command line.
    pub fn name(self) -> &'static str {
        workflow::Method::SEARCHES[self as usize]
    }
}

impl fmt::Display for SearchMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl std::str::FromStr for SearchMethod {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self, Error> {
        let mut all = Self::ALL.into_iter();
        all.find(|own| own.name() == name)
            .ok_or_else(|| Error::unknown("search", name, &workflow::Method::SEARCHES))
    }
}

/// What a search evaluates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SearchCost {
    /// The six parameters of the symmetric LuGre law, as Zhang et al. 2025.
    Six,
    /// The nonlinear unknowns of the law, everything linear solved.
    Separable,
}

/// A search, how far it goes, and where it keeps its state.
///
/// ```
/// use stiction::{Search, SearchMethod};
/// let method: SearchMethod = "cma-es".parse()?;
/// assert_eq!(method, SearchMethod::CmaEs);
/// let search = Search::new(method).evaluations(5000).checkpoint("search.json");
/// # let _ = search;
/// # Ok::<(), stiction::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Search {
    method: SearchMethod,
    searching: Searching,
}

impl Search {
    /// A search followed by least squares, with at most 20 000 evaluations of the full record.
    pub fn new(method: SearchMethod) -> Self {
        Self {
            method,
            searching: Searching::default(),
        }
    }

    /// What it evaluates. Default: six parameters for the genetic algorithms of the publication where the law allows it, separable for
    /// all else.
    #[must_use]
    pub fn cost(mut self, cost: SearchCost) -> Self {
        self.searching.cost = Some(match cost {
            SearchCost::Six => CostKind::Six,
            SearchCost::Separable => CostKind::Separable,
        });
        self
    }

    /// Most evaluations of the full record.
    #[must_use]
    pub fn evaluations(mut self, most: u64) -> Self {
        self.searching.evaluations = Some(most);
        self
    }

    /// Stops at this cost, the square of the relative error.
    #[must_use]
    pub fn target(mut self, cost: f64) -> Self {
        self.searching.target = Some(cost);
        self
    }

    /// Stops after this time, s: what is found then depends on the machine.
    #[must_use]
    pub fn time(mut self, seconds: f64) -> Self {
        self.searching.time = Some(seconds);
        self
    }

    /// The file that its state is kept in now and then, and at the end.
    #[must_use]
    pub fn checkpoint(mut self, file: impl Into<PathBuf>) -> Self {
        self.searching.checkpoint = Some(file.into());
        self
    }

    /// Goes on from such a file.
    #[must_use]
    pub fn resume(mut self, file: impl Into<PathBuf>) -> Self {
        self.searching.resume = Some(file.into());
        self
    }

    /// Leaves out the least squares after it: parameters are what the search found, without intervals.
    #[must_use]
    pub fn without_least_squares(mut self) -> Self {
        self.searching.no_finish = true;
        self
    }

    pub(crate) fn into_options(self, options: &mut Options) {
        options.searching = self.searching;
        let method = &mut options.procedures.method;
        match method {
            workflow::Method::Separable => {
                *method = workflow::Method::Searched(self.method.name());
            }
            // A search for each step; other methods refuse it.
            _ => options.searching.search = Some(self.method.name()),
        }
    }
}
