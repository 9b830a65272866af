//! Why an experiment has no result.

use crate::reproduce::watch::Watch;

/// Why an experiment has no result.
#[derive(Debug, thiserror::Error)]
pub(super) enum Fault {
    /// The user stopped it.
    #[error("stopped")]
    Stopped,
    /// The simulation refused a setting.
    #[error("{0}")]
    Simulation(#[from] stiction_friction::ParamError),
    /// The identified parameters are not valid for a law.
    #[error("{0}")]
    Law(#[from] stiction_parameters::LawError),
    /// The identification refused a record.
    #[error("{0}")]
    Identification(#[from] stiction_identify::Error),
    /// The search refused a setting.
    #[error("{0}")]
    Search(#[from] stiction_search::Error),
}

impl Watch<'_> {
    /// Counts one more step as done; a fault if the work is to stop.
    pub(super) fn done(&self) -> Result<(), Fault> {
        self.add();
        match self.stopped() {
            false => Ok(()),
            true => Err(Fault::Stopped),
        }
    }
}
