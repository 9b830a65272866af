//! How a long search tells of itself and is stopped.

/// What a search is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Cut-offs tried on replicas.
    Tuning,
    /// Another search than the separable method.
    Search,
    /// Low-discrepancy scan of the box.
    Scan,
    /// Least squares on a thinned record, from the best points of the scan.
    Coarse,
    /// Least squares on the full record.
    Fine,
    /// The bias measured on replicas.
    Calibration,
    /// Law comparison on held-out blocks.
    CrossValidation,
}

/// Evaluations of the model, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Cost only.
    pub cost: usize,
    /// Cost with sensitivities.
    pub sensitivities: usize,
    /// Of both, how many on a thinned record.
    pub thinned: usize,
}

impl Counts {
    /// All evaluations, whatever their kind.
    pub fn total(&self) -> usize {
        self.cost + self.sensitivities
    }

    pub(crate) fn add(&mut self, more: &Counts) {
        self.cost += more.cost;
        self.sensitivities += more.sensitivities;
        self.thinned += more.thinned;
    }
}

/// A look at a running search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What is being done.
    pub stage: Stage,
    /// Part of the stage that is done, 0 to 1.
    pub fraction: f64,
    /// Evaluations so far.
    pub counts: Counts,
    /// Best cost so far as rms(residual)/rms(measured); infinite before the first evaluation.
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

/// Sees the progress of a search and may stop it. It is called from one thread at a time, which need
/// not be the one that started the work.
pub trait Observer: Send {
    /// Called after every few evaluations.
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
