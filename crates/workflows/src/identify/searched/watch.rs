//! What stops a search: its own end, its limits, the clock, the user.

use std::time::{Duration, Instant};
use stiction_identify as engine;
use stiction_search::{Control, Kind, Limits, Observer, Progress, Stop};

/// How often the state is kept.
const EVERY: Duration = Duration::from_secs(5);

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
    observer: &'o mut dyn engine::Observer,
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
        observer: &'o mut dyn engine::Observer,
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

    /// What a stop means; `None` where the state is to be kept and the search goes on.
    pub fn ended(&mut self, stop: Stop) -> Option<Ended> {
        match stop {
            Stop::Ended(status) => Some(Ended::Itself(status.name())),
            Stop::Target => Some(Ended::Itself("target")),
            Stop::Budget => Some(Ended::Itself("budget")),
            Stop::Interrupted if self.interrupted => Some(Ended::Interrupted),
            Stop::Interrupted if self.late => Some(Ended::Time),
            Stop::Interrupted => {
                self.kept = Instant::now();
                None
            }
        }
    }
}

impl Observer for Watch<'_> {
    fn progress(&mut self, progress: &Progress) -> Control {
        let counts = &progress.counts;
        let costs = counts.of(Kind::Costs, 0.0);
        let control = self.observer.progress(&engine::Progress {
            stage: engine::Stage::Search,
            fraction: (costs / self.most).min(1.0),
            counts: engine::Counts {
                cost: (counts.costs + counts.coarse_costs) as usize,
                sensitivities: (counts.derivatives + counts.coarse_derivatives) as usize,
                thinned: (counts.coarse_costs + counts.coarse_derivatives) as usize,
            },
            best: progress.best.sqrt(),
        });
        self.interrupted = control == engine::Control::Stop;
        self.late = self
            .time
            .is_some_and(|time| self.start.elapsed().as_secs_f64() >= time);
        let keep = self.keeps && self.kept.elapsed() >= EVERY;
        if self.interrupted || self.late || keep {
            return Control::Stop;
        }
        Control::Continue
    }
}
