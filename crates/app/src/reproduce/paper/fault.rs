//! Why an experiment has no result, and the user's wish to stop.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use stiction_identify::Control;

/// Why an experiment has no result.
#[derive(Debug, thiserror::Error)]
pub(super) enum Fault {
    /// The user stopped it.
    #[error("stopped")]
    Stopped,
    /// The simulation refused a setting.
    #[error("{0}")]
    Simulation(#[from] stiction_friction::ParamError),
    /// The identification refused a record.
    #[error("{0}")]
    Identification(#[from] stiction_identify::Error),
    /// The search refused a setting.
    #[error("{0}")]
    Search(#[from] stiction_search::Error),
}

/// Told how far the work is.
type Told<'a> = dyn FnMut(usize, usize) -> Control + Send + 'a;

/// Counts what is done, and knows whether to stop.
pub(super) struct Watch<'a> {
    all: usize,
    done: AtomicUsize,
    told: Mutex<&'a mut Told<'a>>,
}

impl<'a> Watch<'a> {
    pub fn new(all: usize, told: &'a mut Told<'a>) -> Self {
        Watch {
            all,
            done: AtomicUsize::new(0),
            told: Mutex::new(told),
        }
    }

    /// Whether the user wants it to stop.
    pub fn stopped(&self) -> bool {
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        told(self.done.load(Ordering::SeqCst), self.all) == Control::Stop
    }

    /// One more is done.
    pub fn done(&self) -> Result<(), Fault> {
        self.done.fetch_add(1, Ordering::SeqCst);
        match self.stopped() {
            false => Ok(()),
            true => Err(Fault::Stopped),
        }
    }
}
