//! What to identify, and how.

use super::method::Method;
use crate::error::Error;
use crate::wording::{Setting, TOGETHER_WITH};
use std::path::PathBuf;
use stiction_identify::LawKind;

/// The files of an identification.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Files {
    /// Logs to fit together; all of one axis.
    pub logs: Vec<PathBuf>,
    /// Axis file; `None` leaves all to detection.
    pub axis: Option<PathBuf>,
    /// Logs to validate on.
    pub validate: Vec<PathBuf>,
}

/// What to identify, and how; change what differs from the default, which is that of the command line:
///
/// ```
/// use stiction_identify::LawKind;
/// use stiction_workflows::identify::Options;
///
/// let mut options = Options::default();
/// assert_eq!(options.law, None); // the data choose
/// options.law = Some(LawKind::LuGre);
/// options.split = Some(0.7); // fit the first 70 % of the samples, validate on the rest
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Family of the law; `None` (`auto` in messages) lets the data choose among those that can be exported, symmetric
    /// and asymmetric. Methods that do not choose take LuGre then.
    pub law: Option<LawKind>,
    /// Whether each direction has parameters of its own.
    pub asymmetric: bool,
    /// Whether the data choose among laws alone that have the same parameters in both directions.
    pub symmetric: bool,
    /// Fit the first part of the samples (0 to 1) and validate on the rest.
    pub split: Option<f64>,
    /// Seed of the search; the same seed gives the same bits.
    pub seed: u64,
    /// Whether simpler laws are fitted beside a law that is named, and compared on held-out samples: about doubles the
    /// time.
    pub compare_laws: bool,
    /// The method, separable least squares by default, and the files that it takes beside the logs.
    pub procedures: Procedures,
    /// How far a search goes, and where it keeps its state.
    pub searching: Searching,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            law: None,
            asymmetric: false,
            symmetric: false,
            split: None,
            seed: 0,
            compare_laws: true,
            procedures: Procedures::default(),
            searching: Searching::default(),
        }
    }
}

/// The method, and what it takes beside the logs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Procedures {
    /// How the parameters are found.
    pub method: Method,
    /// Logs of constant velocities for the static parameters; empty takes the logs themselves.
    pub statics: Vec<PathBuf>,
    /// Model file of an earlier identification, for what is not identified here.
    pub model: Option<PathBuf>,
    /// Logs of force ramps, one break-away each.
    pub break_away: Vec<PathBuf>,
    /// The `plan.toml` that a log was recorded by: what ran of it, and what was expected, stand beside the result.
    pub plan: Option<PathBuf>,
}

/// What a search evaluates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CostKind {
    /// The six parameters of the symmetric LuGre law, as Zhang et al. 2025.
    Six,
    /// The nonlinear unknowns of the law, everything linear solved.
    Separable,
}

impl CostKind {
    /// Name as typed and as written to files.
    pub fn name(self) -> &'static str {
        match self {
            CostKind::Six => "six",
            CostKind::Separable => "separable",
        }
    }
}

/// How far a search goes, and where it keeps its state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Searching {
    /// For the methods `static` and `static-then-dynamic`: the search that finds the parameters of each step, before
    /// least squares; `None` takes least squares alone. One of [`stiction_search::Method::NAMES`].
    pub search: Option<&'static str>,
    /// Whether the least squares after it are left out: parameters are what the search found, without intervals.
    pub no_finish: bool,
    /// What it evaluates; `None` takes six for the genetic algorithms of the publication where the law
    /// allows it, separable for all else.
    pub cost: Option<CostKind>,
    /// Most evaluations of the full record; `None` takes 20 000.
    pub evaluations: Option<u64>,
    /// Stop at this cost: the square of the relative error.
    pub target: Option<f64>,
    /// Stop after this time, s.
    pub time: Option<f64>,
    /// Where the state is kept now and then, and at the end.
    pub checkpoint: Option<PathBuf>,
    /// A checkpoint to go on from.
    pub resume: Option<PathBuf>,
}

impl Options {
    /// The law of a method that does not choose among laws.
    pub(super) fn one_law(&self) -> LawKind {
        self.law.unwrap_or(LawKind::LuGre)
    }

    /// Refuses a law that the method is not for.
    pub(super) fn require(&self, laws: &[LawKind], allowed: &'static str) -> Result<(), Error> {
        let law = self.one_law();
        if laws.contains(&law) {
            return Ok(());
        }
        let method = self.procedures.method.name();
        let found = [
            Setting::Law.is(law.name()),
            TOGETHER_WITH.into(),
            Setting::Method.is(method),
        ];
        Err(Error::usage(found, allowed))
    }
}
