//! One observer for several searches that run at the same time.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use stiction_identify::{Control, Observer, Progress, Stage};

/// The observer and how much is done; each search has a [`Relay`] to it.
pub(super) struct Shared<'o> {
    observer: Mutex<&'o mut dyn Observer>,
    done: AtomicUsize,
    all: usize,
    stopped: AtomicBool,
}

impl<'o> Shared<'o> {
    pub fn new(observer: &'o mut dyn Observer, all: usize) -> Self {
        Self {
            observer: Mutex::new(observer),
            done: AtomicUsize::new(0),
            all,
            stopped: AtomicBool::new(false),
        }
    }

    pub fn relay(&self) -> Relay<'_, 'o> {
        Relay(self)
    }

    /// One search of all is finished.
    pub fn one_more(&self) {
        self.done.fetch_add(1, Ordering::SeqCst);
    }

    /// Whether the observer asked to stop.
    pub fn stopped(&self) -> bool {
        self.stopped.load(Ordering::SeqCst)
    }
}

/// Passes progress on as that of the comparison.
pub(super) struct Relay<'a, 'o>(&'a Shared<'o>);

impl Observer for Relay<'_, '_> {
    fn progress(&mut self, progress: &Progress) -> Control {
        let shared = self.0;
        // An observer that panicked in another search has nothing to say in this one but what it holds.
        let mut observer = shared
            .observer
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        // Once stopped, all searches stop, whatever the observer would say next.
        if shared.stopped() {
            return Control::Stop;
        }
        let done = shared.done.load(Ordering::SeqCst);
        let control = observer.progress(&Progress {
            stage: Stage::CrossValidation,
            fraction: done as f64 / shared.all.max(1) as f64,
            ..*progress
        });
        if control == Control::Stop {
            shared.stopped.store(true, Ordering::SeqCst);
        }
        control
    }
}
