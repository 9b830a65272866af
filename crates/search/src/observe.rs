//! How long work reports its progress, how it is stopped, and how many evaluations it has used.

use crate::problem::{Fidelity, Kind};
use crate::search::Phase;
use serde::{Deserialize, Serialize};

/// Evaluations by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Costs on the full record.
    pub costs: u64,
    /// Costs with derivatives on the full record.
    pub derivatives: u64,
    /// Costs on the coarse record.
    pub coarse_costs: u64,
    /// Costs with derivatives on the coarse record.
    pub coarse_derivatives: u64,
}

impl Counts {
    /// Counts `n` evaluations.
    pub fn count(&mut self, kind: Kind, fidelity: Fidelity, n: usize) {
        let slot = match (kind, fidelity) {
            (Kind::Costs, Fidelity::Full) => &mut self.costs,
            (Kind::Derivatives, Fidelity::Full) => &mut self.derivatives,
            (Kind::Costs, Fidelity::Coarse) => &mut self.coarse_costs,
            (Kind::Derivatives, Fidelity::Coarse) => &mut self.coarse_derivatives,
        };
        *slot += n as u64;
    }

    /// Adds those of another piece of work.
    pub fn add(&mut self, more: &Counts) {
        self.costs += more.costs;
        self.derivatives += more.derivatives;
        self.coarse_costs += more.coarse_costs;
        self.coarse_derivatives += more.coarse_derivatives;
    }

    /// All evaluations, whatever their kind and on whatever record.
    pub fn total(&self) -> usize {
        self.without_derivatives() + self.with_derivatives()
    }

    /// Those of the cost alone, on whatever record.
    pub fn without_derivatives(&self) -> usize {
        (self.costs + self.coarse_costs) as usize
    }

    /// Those with derivatives, on whatever record.
    pub fn with_derivatives(&self) -> usize {
        (self.derivatives + self.coarse_derivatives) as usize
    }

    /// Those on a coarse record, of whatever kind.
    pub fn coarse(&self) -> usize {
        (self.coarse_costs + self.coarse_derivatives) as usize
    }

    /// Evaluations of one kind, in equivalents of evaluations on the full record; a coarse one counts as `share`.
    pub fn of(&self, kind: Kind, share: f64) -> f64 {
        let (full, coarse) = match kind {
            Kind::Costs => (self.costs, self.coarse_costs),
            Kind::Derivatives => (self.derivatives, self.coarse_derivatives),
        };
        full as f64 + share * coarse as f64
    }

    /// All evaluations, in equivalents of evaluations on the full record.
    pub fn full_records(&self, share: f64) -> f64 {
        self.of(Kind::Costs, share) + self.of(Kind::Derivatives, share)
    }
}

/// Where a run stops. Times are the caller's: an [`Observer`] may stop a run whenever it likes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Most costs, in equivalents of evaluations on the full record. Default: no limit.
    pub costs: u64,
    /// Most costs with derivatives, likewise. Default: no limit.
    pub derivatives: u64,
    /// Stop as soon as a cost is not above this. Default: none.
    pub target: Option<f64>,
    /// Most points given to the problem at once, at least 1; the result does not depend on it.
    /// Default 1024.
    pub batch: usize,
}

impl Limits {
    /// The part of the evaluations that is used up, 0 to 1; 0 without a limit.
    pub(crate) fn fraction(&self, counts: &Counts, share: f64) -> f64 {
        let part = |kind, most: u64| counts.of(kind, share) / most as f64;
        let costs = part(Kind::Costs, self.costs);
        costs
            .max(part(Kind::Derivatives, self.derivatives))
            .min(1.0)
    }
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            costs: u64::MAX,
            derivatives: u64::MAX,
            target: None,
            batch: 1024,
        }
    }
}

/// What is being done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stage {
    /// Cut-offs tried on replicas.
    Tuning,
    /// A search method.
    Search,
    /// The least squares after it.
    Finish,
    /// Low-discrepancy scan of the box.
    Scan,
    /// Least squares on a thinned record, from the best points of the scan.
    Coarse,
    /// Least squares on the full record.
    Fine,
    /// The bias measured on replicas.
    Calibration,
    /// The law looked for that makes the counts of an encoder most likely.
    Counts,
    /// Law comparison on held-out blocks.
    CrossValidation,
    /// Samples taken from a device.
    Recording,
    /// Logs, each identified by itself.
    Logs {
        /// How many are done.
        done: usize,
        /// Of how many.
        all: usize,
    },
    /// Simulations and other experiments.
    Experiments {
        /// How many are done.
        done: usize,
        /// Of how many.
        all: usize,
    },
}

impl Stage {
    /// In the words of the terminal.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Tuning => "choosing cut-offs",
            Stage::Calibration => "measuring the bias",
            Stage::Counts => "asking the encoder counts",
            Stage::Search => "searching",
            Stage::Scan => "scanning the box",
            Stage::Coarse => "first descents",
            Stage::Fine | Stage::Finish => "least squares",
            Stage::CrossValidation => "comparing laws",
            Stage::Recording => "recording",
            Stage::Logs { .. } => "identifying",
            Stage::Experiments { .. } => "simulating",
        }
    }
}

impl From<Phase> for Stage {
    fn from(phase: Phase) -> Self {
        match phase {
            Phase::Search => Stage::Search,
            Phase::Finish => Stage::Finish,
        }
    }
}

/// The present state of running work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What is being done.
    pub stage: Stage,
    /// Part of the stage that is done, 0 to 1; 0 where it is not known.
    pub fraction: f64,
    /// Evaluations so far.
    pub counts: Counts,
    /// Least so far of what is minimised: the cost of a [`Run`](crate::Run), and for an identification
    /// rms(residual)/rms(measured). Infinite before the first evaluation.
    pub best: f64,
}

impl Progress {
    /// Progress of a stage that counts no evaluations, with the part of it that is done.
    pub fn of(stage: Stage, fraction: f64) -> Self {
        Self {
            stage,
            fraction,
            counts: Counts::default(),
            best: f64::INFINITY,
        }
    }
}

/// Whether to go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// Go on.
    Continue,
    /// Stop, and keep the best found so far.
    Stop,
}

/// Sees the progress of long work and may stop it. It is called from one thread at a time, which need not be
/// the one that started the work.
pub trait Observer: Send {
    /// Called after every batch or every few evaluations.
    fn progress(&mut self, progress: &Progress) -> Control;
}

/// Watches nothing and never stops.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {
    fn progress(&mut self, _: &Progress) -> Control {
        Control::Continue
    }
}

impl<F: FnMut(&Progress) -> Control + Send> Observer for F {
    fn progress(&mut self, progress: &Progress) -> Control {
        self(progress)
    }
}
