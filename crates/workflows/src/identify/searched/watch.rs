//! What stops a search: its own end, its limits, the clock, the user.

use std::time::{Duration, Instant};
use stiction_search::{Control, Kind, Limits, Observer, Progress, Stage, Status};

/// Time between two checkpoints: at most this much work is lost in a crash.
const CHECKPOINT_INTERVAL: Duration = Duration::from_secs(5);

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ended {
    /// By itself, or at a limit of its own.
    Itself(&'static str),
    /// At the time limit.
    Time,
    /// By the user.
    Interrupted,
}

impl Ended {
    /// Name as written to files.
    pub fn name(self) -> &'static str {
        match self {
            Ended::Itself(name) => name,
            Ended::Time => "time",
            Ended::Interrupted => "interrupted",
        }
    }
}

/// Passes progress on, and looks at the clock.
pub(super) struct Watch<'o> {
    observer: &'o mut dyn Observer,
    start: Instant,
    time: Option<f64>,
    keeps: bool,
    kept: Instant,
    most: f64,
    interrupted: bool,
    late: bool,
}

impl<'o> Watch<'o> {
    pub fn new(
        observer: &'o mut dyn Observer,
        start: Instant,
        time: Option<f64>,
        keeps: bool,
        limits: &Limits,
    ) -> Self {
        Self {
            observer,
            start,
            time,
            keeps,
            kept: Instant::now(),
            most: limits.costs as f64,
            interrupted: false,
            late: false,
        }
    }

    /// What an end means; `None` where the state is to be kept and the search goes on.
    pub fn ended(&mut self, status: Status) -> Option<Ended> {
        match status {
            Status::Interrupted if self.interrupted => Some(Ended::Interrupted),
            Status::Interrupted if self.late => Some(Ended::Time),
            Status::Interrupted => {
                self.kept = Instant::now();
                None
            }
            _ => Some(Ended::Itself(status.name())),
        }
    }
}

impl Observer for Watch<'_> {
    fn progress(&mut self, progress: &Progress) -> Control {
        let counts = &progress.counts;
        let costs = counts.of(Kind::Costs, 0.0);
        let control = self.observer.progress(&Progress {
            stage: Stage::Search,
            fraction: (costs / self.most).min(1.0),
            counts: *counts,
            best: progress.best.sqrt(),
        });
        self.interrupted = control == Control::Stop;
        self.late = self
            .time
            .is_some_and(|time| self.start.elapsed().as_secs_f64() >= time);
        let keep = self.keeps && self.kept.elapsed() >= CHECKPOINT_INTERVAL;
        if self.interrupted || self.late || keep {
            return Control::Stop;
        }
        Control::Continue
    }
}
