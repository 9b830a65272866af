//! One method with one seed.

use super::options::{ONE_START, Shared};
use crate::entries;
use crate::spread::Spread;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;
use stiction_files::Axis;
use stiction_files::result::Evaluations;
use stiction_identify::candidates::Named;
use stiction_search::{
    Best, Control, Finish, Generation, Improvement, Limits, Method, Plan, Progress, Run, Status,
    levenberg,
};

/// What all runs have in common.
pub(super) struct Setting<'a> {
    pub problem: &'a Shared<'a>,
    pub evaluations: u64,
    /// Whether least squares can follow the search: the problem has derivatives.
    pub descends: bool,
    /// Settings of the methods.
    pub axis: &'a Axis,
}

/// A complete run.
#[derive(Serialize, Deserialize)]
pub(super) struct Trial {
    pub method: String,
    pub seed: u64,
    pub status: String,
    pub evaluations: Evaluations,
    pub own: Option<Point>,
    pub last: Option<Point>,
    /// Seconds since the start of the run, and the best cost until then.
    pub times: Vec<(f64, f64)>,
    pub seconds: f64,
    pub history: Vec<Improvement>,
    pub generations: Vec<Generation>,
}

/// The best of a run.
#[derive(Serialize, Deserialize)]
pub(super) struct Point {
    pub cost: f64,
    pub evaluations: f64,
    pub parameters: Vec<(String, f64)>,
}

impl Trial {
    /// The least cost that was found.
    pub fn cost(&self) -> Option<f64> {
        self.last.as_ref().map(|p| p.cost)
    }
}

impl Setting<'_> {
    fn plan(&self, name: &str) -> Plan {
        if name == ONE_START {
            let one = levenberg::Settings {
                scan: 0,
                starts: 1,
                ..levenberg::Settings::default()
            };
            return Plan {
                method: Method::Lm(one),
                finish: None,
            };
        }
        let method = self
            .axis
            .search_method(name)
            .expect("a name that was checked");
        let descends_itself = matches!(name, "niched-ga" | "lm");
        let finish = (self.descends && !descends_itself).then(Finish::default);
        Plan { method, finish }
    }

    /// Runs to the end; `None` if it was stopped on the way.
    pub fn run(&self, name: &str, seed: u64, stop: &AtomicBool) -> Option<Trial> {
        let problem = Spread(self.problem);
        let dimensions = self.problem.bounds().dimensions();
        let search = self
            .plan(name)
            .start(dimensions, seed)
            .expect("checked settings");
        let mut run = Run::new(search, &problem);
        let limits = Limits {
            costs: self.evaluations,
            derivatives: self.evaluations,
            ..Limits::default()
        };
        let mut times: Vec<(f64, f64)> = Vec::new();
        let clock = Instant::now();
        let mut watch = |progress: &Progress| {
            // A run has begun with its first finite cost.
            if progress.best < times.last().map_or(f64::INFINITY, |(_, least)| *least) {
                times.push((clock.elapsed().as_secs_f64(), progress.best));
            }
            match stop.load(Ordering::SeqCst) {
                true => Control::Stop,
                false => Control::Continue,
            }
        };
        // A problem without derivatives is given to methods that need none.
        let status = match run.advance(&problem, &limits, &mut watch).ok()? {
            Status::Interrupted => return None,
            status => status.name(),
        };
        let seconds = clock.elapsed().as_secs_f64();
        let share = self.problem.coarse_share();
        let point = |best: &Best| Point {
            cost: best.cost,
            evaluations: best.counts.full_records(share),
            parameters: in_words(self.problem.parameters(&best.point)),
        };
        Some(Trial {
            method: name.into(),
            seed,
            status: status.into(),
            evaluations: entries::evaluations(&run.counts(), share),
            own: run.own_best().map(point),
            last: run.best().map(point),
            times,
            seconds,
            history: run.history().improvements().to_vec(),
            generations: match seed {
                0 => run.history().generations().to_vec(),
                _ => Vec::new(),
            },
        })
    }
}

/// Parameters by their names in files.
fn in_words(found: Named) -> Vec<(String, f64)> {
    let words = found.into_iter();
    words.map(|(name, x)| (name.to_string(), x)).collect()
}
