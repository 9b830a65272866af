//! How far the work is, and the user's wish to stop.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use stiction_identify::Control;

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
    pub fn add(&self) {
        self.done.fetch_add(1, Ordering::SeqCst);
    }
}
