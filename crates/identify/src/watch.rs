//! Where progress is reported during a calculation, and whether it was asked to stop.

use crate::separable::objective::Objective;
use stiction_search::{Control, Counts, Fidelity, Kind, Observer, Progress, Stage};

/// An observer with the values that it is told.
pub(crate) struct Watch<'o> {
    pub observer: &'o mut dyn Observer,
    pub stage: Stage,
    /// Part of the stage that is done, 0 to 1.
    pub fraction: f64,
    pub counts: Counts,
    /// Least relative residual so far.
    pub best: f64,
    /// Whether the observer has asked to stop.
    pub stopped: bool,
}

impl<'o> Watch<'o> {
    /// At the beginning of a stage, nothing counted yet.
    pub fn new(observer: &'o mut dyn Observer, stage: Stage) -> Self {
        Self {
            observer,
            stage,
            fraction: 0.0,
            counts: Counts::default(),
            best: f64::INFINITY,
            stopped: false,
        }
    }

    /// Counts an evaluation of an objective.
    pub fn count(&mut self, objective: &Objective, sensitivities: bool) {
        let kind = match sensitivities {
            true => Kind::Derivatives,
            false => Kind::Costs,
        };
        let fidelity = match objective.record().is_thinned {
            true => Fidelity::Coarse,
            false => Fidelity::Full,
        };
        self.counts.count(kind, fidelity, 1);
    }

    /// Tells the observer of a relative residual.
    pub fn report(&mut self, relative: f64) -> Control {
        self.best = self.best.min(relative);
        let control = self.observer.progress(&Progress {
            stage: self.stage,
            fraction: self.fraction,
            counts: self.counts,
            best: self.best,
        });
        self.stopped |= control == Control::Stop;
        control
    }
}
