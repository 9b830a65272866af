//! What to identify, and how.

use super::method::Method;
use crate::error::Error;
use std::path::PathBuf;
use stiction_identify::LawKind;

/// An identification as it is asked for.
#[derive(Clone, Debug)]
pub struct Options {
    /// Logs to fit together; all of one axis.
    pub logs: Vec<PathBuf>,
    /// Axis file; `None` leaves all to detection.
    pub axis: Option<PathBuf>,
    /// Family of the law; `None` lets the data choose it, and whether it is asymmetric.
    pub law: Option<LawKind>,
    /// Whether each direction has parameters of its own.
    pub asymmetric: bool,
    /// Logs to validate on.
    pub validate: Vec<PathBuf>,
    /// Fit the first part of the samples (0 to 1) and validate on the rest.
    pub split: Option<f64>,
    /// Seed of the search.
    pub seed: u64,
    /// Whether simpler laws are fitted beside it and compared on held-out samples.
    pub compare_laws: bool,
    /// The method, and the logs and models that it takes beside the logs.
    pub procedures: Procedures,
    /// How far a search goes, and where it keeps its state.
    pub searching: Searching,
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
    /// Refuses a law that the method is not for.
    pub(super) fn require(&self, laws: &[LawKind], allowed: &str) -> Result<(), Error> {
        if self.law.is_some_and(|law| laws.contains(&law)) {
            return Ok(());
        }
        let law = self.law.map_or("auto", LawKind::name);
        let method = self.procedures.method.name();
        let found = format!("--law {law} together with --method {method}");
        Err(Error::usage(found, allowed))
    }
}
