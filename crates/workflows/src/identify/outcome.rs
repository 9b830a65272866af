//! Everything that came out of an identification, in memory.

use crate::source::Source;
use stiction_files::result::ResultFile;
use stiction_identify::{Conditioning, Estimate, FittedLaw, Series, SimulationFit, Unseen};
use stiction_log::Motion;

/// Everything that came out, in memory.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What goes into `result.json`.
    pub result: ResultFile,
    /// What was fitted.
    pub found: Found,
    /// Signals of each validation, with its name.
    pub validation: Vec<(String, Series)>,
    /// The logs.
    pub sources: Vec<Source>,
    /// Linear or rotary.
    pub motion: Motion,
    /// Unit of the force.
    pub force_unit: String,
    /// Unit of the normal load, where the logs have one.
    pub load_unit: String,
    /// Known values to compare with, by parameter name; empty unless the axis is simulated.
    pub truth: Vec<(String, f64)>,
}

/// What was fitted, by what it was fitted to.
#[derive(Clone, Debug)]
pub enum Found {
    /// The force of a record, sample by sample: it can predict the force of another one.
    Force(Box<ForceFit>),
    /// The position of a simulated axis.
    Position(Box<Simulated>),
    /// Points of the steady curve, or force steps.
    Procedure(Box<FittedLaw>),
}

/// A law fitted to the force of a record.
#[derive(Clone, Debug)]
pub struct ForceFit {
    /// The law.
    pub estimate: Estimate,
    /// How the logs became the record.
    pub conditioning: Conditioning,
}

/// A simulated axis, and its simulations of unseen logs with their names.
#[derive(Clone, Debug)]
pub struct Simulated {
    /// The fit.
    pub fit: SimulationFit,
    /// Simulations of logs that were not fitted.
    pub unseen: Vec<(String, Unseen)>,
}

impl Outcome {
    /// Of logs of one axis, at least one.
    pub(super) fn new(
        result: ResultFile,
        found: Found,
        validation: Vec<(String, Series)>,
        sources: Vec<Source>,
    ) -> Self {
        Outcome {
            result,
            found,
            validation,
            motion: sources[0].log.motion,
            force_unit: sources[0].log.force_unit.clone(),
            load_unit: sources[0].log.load_unit.clone(),
            sources,
            truth: Vec::new(),
        }
    }

    /// The fitted law with its signals.
    pub fn law(&self) -> &FittedLaw {
        match &self.found {
            Found::Force(fit) => &fit.estimate,
            Found::Position(simulated) => &simulated.fit.fitted,
            Found::Procedure(law) => law,
        }
    }

    /// The simulated axis, where the method simulates one.
    pub fn simulation(&self) -> Option<&Simulated> {
        match &self.found {
            Found::Position(simulated) => Some(simulated),
            _ => None,
        }
    }
}
