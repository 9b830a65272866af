//! How a run tells of itself, where it stops, and what it has used.

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
    pub(crate) fn add(&mut self, kind: Kind, fidelity: Fidelity, n: usize) {
        let slot = match (kind, fidelity) {
            (Kind::Costs, Fidelity::Full) => &mut self.costs,
            (Kind::Derivatives, Fidelity::Full) => &mut self.derivatives,
            (Kind::Costs, Fidelity::Coarse) => &mut self.coarse_costs,
            (Kind::Derivatives, Fidelity::Coarse) => &mut self.coarse_derivatives,
        };
        *slot += n as u64;
    }

    /// Evaluations of one kind, in those of the full record; a coarse one counts `share`.
    pub fn of(&self, kind: Kind, share: f64) -> f64 {
        let (full, coarse) = match kind {
            Kind::Costs => (self.costs, self.coarse_costs),
            Kind::Derivatives => (self.derivatives, self.coarse_derivatives),
        };
        full as f64 + share * coarse as f64
    }

    /// All evaluations, in those of the full record.
    pub fn full_records(&self, share: f64) -> f64 {
        self.of(Kind::Costs, share) + self.of(Kind::Derivatives, share)
    }
}

/// Where a run stops. Times are the caller's: an [`Observer`] may stop a run whenever it likes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Most costs, in evaluations of the full record. Default: no limit.
    pub costs: u64,
    /// Most costs with derivatives, likewise. Default: no limit.
    pub derivatives: u64,
    /// Stop as soon as a cost is not above this. Default: none.
    pub target: Option<f64>,
    /// Most points given to the problem at once, at least 1; the result does not depend on it.
    /// Default 1024.
    pub batch: usize,
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

/// A look at a running search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The method itself or the least squares after it.
    pub phase: Phase,
    /// Evaluations so far.
    pub counts: Counts,
    /// Best cost so far on the full record; infinite before the first finite one.
    pub best: f64,
}

/// Whether to go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// Go on.
    Continue,
    /// Stop, and keep the best found so far.
    Stop,
}

/// Sees the progress of a search and may stop it.
pub trait Observer {
    /// Called after every batch.
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

impl<F: FnMut(&Progress) -> Control> Observer for F {
    fn progress(&mut self, progress: &Progress) -> Control {
        self(progress)
    }
}
