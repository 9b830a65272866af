//! Any of the controllers, chosen at run time.

use crate::cascade::{Cascade, CascadeState};
use crate::fuzzy::FuzzyPid;
use crate::path::Reference;
use crate::pid::{Pid, PidState};
use stiction_friction::ParamError;

/// A controller with its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Controller {
    /// P in position around PI in speed.
    Cascade(Cascade),
    /// PID in position.
    Pid(Pid),
    /// PID with gains scheduled by fuzzy rules.
    Fuzzy(FuzzyPid),
}

/// Its state; only the part of the controller in use changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ControllerState {
    cascade: CascadeState,
    pid: PidState,
}

impl Controller {
    /// Refuses settings out of range.
    pub fn validate(&self) -> Result<(), ParamError> {
        match self {
            Controller::Cascade(cascade) => cascade.validate(),
            Controller::Pid(pid) => pid.validate(),
            Controller::Fuzzy(fuzzy) => fuzzy.validate(),
        }
    }

    /// Largest force either way, N (N m).
    pub fn force_limit(&self) -> f64 {
        match self {
            Controller::Cascade(cascade) => cascade.force_limit,
            Controller::Pid(pid) => pid.force_limit,
            Controller::Fuzzy(fuzzy) => fuzzy.base.force_limit,
        }
    }

    /// Acceleration feedforward, kg (kg m^2).
    pub fn mass_feedforward(&self) -> f64 {
        match self {
            Controller::Cascade(cascade) => cascade.mass_feedforward,
            Controller::Pid(pid) => pid.mass_feedforward,
            Controller::Fuzzy(fuzzy) => fuzzy.base.mass_feedforward,
        }
    }

    /// The same controller with another acceleration feedforward, kg (kg m^2).
    pub fn with_mass_feedforward(mut self, mass: f64) -> Self {
        match &mut self {
            Controller::Cascade(cascade) => cascade.mass_feedforward = mass,
            Controller::Pid(pid) => pid.mass_feedforward = mass,
            Controller::Fuzzy(fuzzy) => fuzzy.base.mass_feedforward = mass,
        }
        self
    }

    /// The force, N (N m), to hold for the next `h` seconds, from the reference and the measured position (m, rad) at
    /// this instant and a further force (N, N m) that is fed forward. A cascade is given the reference velocity of half
    /// a period `h` ago, since that is the age of the speed that it measures.
    #[inline]
    pub fn force(
        &self,
        state: &mut ControllerState,
        h: f64,
        reference: Reference,
        position: f64,
        feedforward: f64,
    ) -> f64 {
        match self {
            Controller::Cascade(cascade) => {
                // The measured speed is the mean over the last period, so half a period old: the reference is taken at the
                // same instant.
                let velocity = reference.velocity - 0.5 * h * reference.acceleration;
                let reference = Reference {
                    velocity,
                    ..reference
                };
                cascade.force_with(&mut state.cascade, h, reference, position, feedforward)
            }
            Controller::Pid(pid) => pid.force(&mut state.pid, h, reference, position, feedforward),
            Controller::Fuzzy(fuzzy) => {
                fuzzy.force(&mut state.pid, h, reference, position, feedforward)
            }
        }
    }
}
