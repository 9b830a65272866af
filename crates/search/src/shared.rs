//! One observer for work that goes on in several threads.

use crate::observe::{Control, Observer, Progress, Stage};
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// An observer, how many pieces of the work are done, and whether it is to stop. Once the observer has asked
/// to stop it is not asked again.
pub struct Shared<'o> {
    observer: Mutex<&'o mut dyn Observer>,
    all: usize,
    done: AtomicUsize,
    /// Work of all pieces, and of those that are done.
    size: u64,
    worked: AtomicU64,
    stopped: AtomicBool,
    /// The stage in which so many of so many pieces are done.
    stage: fn(usize, usize) -> Stage,
}

impl<'o> Shared<'o> {
    /// For work of `all` pieces of the same size, none of which is done.
    pub fn new(observer: &'o mut dyn Observer, all: usize) -> Self {
        Self::sized(observer, all, all as u64)
    }

    /// For work of `all` pieces, none of which is done, whose sizes add up to `size`.
    pub fn sized(observer: &'o mut dyn Observer, all: usize, size: u64) -> Self {
        Self {
            observer: Mutex::new(observer),
            all,
            done: AtomicUsize::new(0),
            size,
            worked: AtomicU64::new(0),
            stopped: AtomicBool::new(false),
            stage: |done, all| Stage::Experiments { done, all },
        }
    }

    /// For so many logs of the same size, none of which is done.
    pub fn of_logs(observer: &'o mut dyn Observer, all: usize) -> Self {
        Self {
            stage: |done, all| Stage::Logs { done, all },
            ..Self::new(observer, all)
        }
    }

    /// One more piece is done.
    pub fn one_more(&self) {
        self.one_more_of(1);
    }

    /// One more piece is done, of that size.
    pub fn one_more_of(&self, size: u64) {
        self.done.fetch_add(1, Ordering::SeqCst);
        self.worked.fetch_add(size, Ordering::SeqCst);
    }

    /// Whether the observer has asked to stop.
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::SeqCst)
    }

    /// Tells the observer how many pieces are done; false if the work is to stop.
    pub fn go_on(&self) -> bool {
        let told =
            |done: usize, fraction: f64| Progress::of((self.stage)(done, self.all), fraction);
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

    fn tell(&self, progress: impl FnOnce(usize, f64) -> Progress) -> Control {
        // A lock poisoned by a panic of the observer in another thread is used nevertheless.
        let mut observer = self.observer.lock().unwrap_or_else(PoisonError::into_inner);
        if self.is_stopped() {
            return Control::Stop;
        }
        let done = self.done.load(Ordering::SeqCst);
        let worked = self.worked.load(Ordering::SeqCst);
        let fraction = worked as f64 / self.size.max(1) as f64;
        let control = observer.progress(&progress(done, fraction));
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
        self.shared.tell(|_, fraction| Progress {
            stage: self.stage,
            fraction,
            ..*progress
        })
    }
}
