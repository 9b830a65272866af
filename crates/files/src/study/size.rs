//! How large a study is, before any of it runs.

use super::belief::Family;
use super::grid::Job;
use super::plan::{Scheme, Study};
use crate::error::Error;
use std::collections::HashSet;
use std::path::Path;
use stiction_number::{counted, short};
use stiction_servo::run::sample_count;

/// Most samples that a study simulates unless more are allowed: at up to three plant steps a period one core takes some ten
/// minutes for them, at a hundred, the most there are, some three hours.
pub const MOST_SAMPLES: u64 = 2_000_000_000;

/// How large a study is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Size {
    /// Runs of the grid, with those of its sweeps.
    pub runs: usize,
    /// Control periods that are simulated, of each axis: every run, each pass of learning, and the runs in which a watchdog
    /// learns.
    pub samples: u64,
    /// The most of them in one pass.
    pub longest: u64,
}

impl Study {
    /// How large it is.
    pub fn size(&self) -> Size {
        let mut size = Size::default();
        for grid in self.grids() {
            let mut learnt = HashSet::new();
            for job in grid.jobs() {
                let pass = grid.samples_of_a_pass(job.path);
                let cell = (job.path, job.controller, job.coupled);
                // Once for all runs that share it.
                let shared = grid.watched(job) && !grid.learns_alone(job) && learnt.insert(cell);
                size.runs += 1;
                size.samples += grid.work(job) + u64::from(shared) * pass;
                size.longest = size.longest.max(pass);
            }
        }
        size
    }

    /// Control periods of one pass along a path or contour, of all its axes.
    pub fn samples_of_a_pass(&self, path: usize) -> u64 {
        let (duration, axes) = match self.paths.get(path) {
            Some(path) => (path.trajectory.duration(), 1),
            None => {
                let contour = &self.contours[path - self.paths.len()];
                (contour.motion.duration(), 2)
            }
        };
        // What is too long was refused, or is when it is run.
        axes * sample_count(duration, self.machine.rate).unwrap_or(0) as u64
    }

    /// Control periods of a run that it shares with no other.
    pub fn work(&self, job: Job) -> u64 {
        let passes = match &self.compensators[job.compensator].value {
            Scheme::Learning(_, passes) => *passes,
            _ => 1 + u64::from(self.watched(job) && self.learns_alone(job)),
        };
        passes * self.samples_of_a_pass(job.path)
    }

    /// Whether a watchdog has to learn before a run.
    fn watched(&self, job: Job) -> bool {
        match &self.compensators[job.compensator].value {
            Scheme::Model(model) => model.watchdog.is_some(),
            _ => false,
        }
    }

    /// Whether a watchdog learns for a run alone: on an axis that is drawn, or where another mass is fed forward than that of
    /// the axis.
    pub fn learns_alone(&self, job: Job) -> bool {
        let of = |family: &Family, mass: f64| {
            !family.axes.is_empty() || family.beliefs[job.belief].mass != mass
        };
        let first = of(&self.families[job.family], self.machine.mass);
        let contour = job.path >= self.paths.len();
        let second = self.second.as_ref().filter(|_| contour);
        first || second.is_some_and(|s| of(&s.families[job.family], s.machine.mass))
    }

    /// Refuses a study that simulates more samples than `most`.
    ///
    /// # Errors
    /// With the numbers, and what multiplies to them.
    pub(super) fn within(&self, file: &Path, most: u64) -> Result<(), Error> {
        let size = self.size();
        if size.samples <= most {
            return Ok(());
        }
        Err(Error::TooLarge {
            what: file.display().to_string(),
            found: format!(
                "{} simulate {} samples: {}",
                counted(size.runs, "run"),
                short(size.samples as f64),
                self.factors(size)
            ),
            needed: size.samples,
            allowed: most,
        })
    }

    /// What multiplies to the runs of a study, in words.
    fn factors(&self, size: Size) -> String {
        let motions = self.paths.len() + self.contours.len();
        let mut factors = vec![
            counted(motions, "path"),
            counted(self.controllers.len(), "controller"),
            // None is one of them.
            counted(self.compensators.len(), "compensator"),
        ];
        if self.families.len() > 1 {
            let members: usize = self.families.iter().map(|f| f.beliefs.len()).sum();
            let each: Vec<String> = self.families.iter().map(told).collect();
            factors.push(format!(
                "{} ({})",
                counted(members, "variant"),
                each.join(", ")
            ));
        }
        let mut text = factors.join(" x ");
        for sweep in &self.sweeps {
            let values = sweep.points.len();
            text += &format!(", and those with {values} values of {}", sweep.key);
        }
        let longest = (0..motions).max_by_key(|path| self.samples_of_a_pass(*path));
        if let Some(path) = longest {
            let name = match self.paths.get(path) {
                Some(path) => &path.name,
                None => &self.contours[path - self.paths.len()].name,
            };
            text += &format!(
                "; the longest motion, {name:?}, has {} samples",
                short(size.longest as f64)
            );
        }
        text
    }
}

/// A family with the number of its members.
fn told(family: &Family) -> String {
    let members = family.beliefs.len();
    match family.kind {
        "promised" => format!("{members} promised"),
        "corners" => format!("{members} of {}", family.name),
        _ => family.name.clone(),
    }
}
