//! One observer for work that goes on in several threads.

use crate::observe::{Control, Observer, Progress, Stage};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// An observer, how many pieces of the work are done, and whether it is to stop. Once the observer has asked
/// to stop it is not asked again.
pub struct Shared<'o> {
    observer: Mutex<&'o mut dyn Observer>,
    all: usize,
    done: AtomicUsize,
    stopped: AtomicBool,
}

impl<'o> Shared<'o> {
    /// For work of `all` pieces, none of which is done.
    pub fn new(observer: &'o mut dyn Observer, all: usize) -> Self {
        Self {
            observer: Mutex::new(observer),
            all,
            done: AtomicUsize::new(0),
            stopped: AtomicBool::new(false),
        }
    }

    /// One more piece is done.
    pub fn one_more(&self) {
        self.done.fetch_add(1, Ordering::SeqCst);
    }

    /// Whether the observer has asked to stop.
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::SeqCst)
    }

    /// Tells the observer how many pieces are done; false if the work is to stop.
    pub fn go_on(&self) -> bool {
        let told = |done: usize, all: usize| {
            let fraction = done as f64 / all.max(1) as f64;
            Progress::of(Stage::Experiments { done, all }, fraction)
        };
        self.tell(told) == Control::Continue
    }

    /// An observer for one of several pieces that run at the same time. The progress reported to it is
    /// passed on as that of the stage `stage`, with the number of pieces that are done.
    pub fn relay(&self, stage: Stage) -> Relay<'_, 'o> {
        Relay {
            shared: self,
            stage,
        }
    }

    fn tell(&self, progress: impl FnOnce(usize, usize) -> Progress) -> Control {
        // A lock poisoned by a panic of the observer in another thread is used nevertheless.
        let mut observer = self.observer.lock().unwrap_or_else(PoisonError::into_inner);
        if self.is_stopped() {
            return Control::Stop;
        }
        let control = observer.progress(&progress(self.done.load(Ordering::SeqCst), self.all));
        if control == Control::Stop {
            self.stopped.store(true, Ordering::SeqCst);
        }
        control
    }
}

/// One of several observers that report to a [`Shared`] one.
pub struct Relay<'a, 'o> {
    shared: &'a Shared<'o>,
    stage: Stage,
}

impl Observer for Relay<'_, '_> {
    fn progress(&mut self, progress: &Progress) -> Control {
        self.shared.tell(|done, all| Progress {
            stage: self.stage,
            fraction: done as f64 / all.max(1) as f64,
            ..*progress
        })
    }
}
