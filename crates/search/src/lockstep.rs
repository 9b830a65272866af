//! Many descents in the unit cube that go on together, so that a kernel can evaluate their trials side by
//! side.

use crate::bits;
use crate::descent::{Descent, Region, Settings};
use crate::points::Points;
use crate::problem::Derivatives;
use crate::status::Status;
use serde::{Deserialize, Serialize};

/// Longest step of one unknown, in widths of the box: the quadratic model means little further off.
const LONGEST_STEP: f64 = 0.5;

/// A descent with what it waits for, so that all of its state can be saved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Waiting {
    descent: Descent,
    /// Where the descent stands; `None` before the first answer.
    now: Option<Derivatives>,
    /// What is asked for.
    #[serde(with = "bits")]
    trial: Vec<f64>,
    most_trials: usize,
}

impl Waiting {
    /// From a point of the unit cube, with at most `most_trials` steps.
    pub fn new(start: &[f64], most_trials: usize) -> Self {
        let point: Vec<f64> = start.iter().map(|x| x.clamp(0.0, 1.0)).collect();
        Self {
            trial: point.clone(),
            descent: Descent::new(point, &settings(most_trials)),
            now: None,
            most_trials,
        }
    }

    /// How it ended; `None` while it goes on.
    pub fn status(&self) -> Option<Status> {
        self.descent.status()
    }

    /// The best so far.
    pub fn point(&self) -> &[f64] {
        self.descent.point()
    }

    pub fn cost(&self) -> f64 {
        self.now.as_ref().map_or(f64::INFINITY, |d| d.cost)
    }

    fn tell(&mut self, next: &Derivatives) {
        let settings = settings(self.most_trials);
        if self.now.is_none() {
            if !next.cost.is_finite() {
                return self.descent.end(Status::Stalled);
            }
            self.now = Some(next.clone());
        } else {
            let trial = std::mem::take(&mut self.trial);
            if self.descent.take(&settings, trial, next.cost) {
                self.now = Some(next.clone());
            }
        }
        let Some(now) = &self.now else { return };
        let n = self.descent.point().len();
        let (low, high) = (vec![0.0; n], vec![1.0; n]);
        let cube = Region {
            low: &low,
            high: &high,
        };
        if let Some(trial) = self.descent.propose(&settings, cube, now.into()) {
            self.trial = trial;
        }
    }
}

/// The rules of a descent in widths of the box. Trials for which the model predicts no gain are
/// evaluated too: a trial costs little compared with the search before it.
fn settings(most_trials: usize) -> Settings {
    Settings {
        most_trials,
        longest_step: LONGEST_STEP,
        trusted_step: 0.0,
        ..Settings::default()
    }
}

/// Descents from points of the unit cube.
pub(crate) fn descents<'a>(starts: impl Iterator<Item = &'a [f64]>, steps: usize) -> Vec<Waiting> {
    starts.map(|start| Waiting::new(start, steps)).collect()
}

/// The trials of all descents that have not ended; `None` if all have.
pub(crate) fn ask_all(descents: &[Waiting]) -> Option<Points> {
    let mut points = Points::new(descents.first()?.point().len());
    let going = descents.iter().filter(|d| d.status().is_none());
    for descent in going {
        points.push(&descent.trial);
    }
    (!points.is_empty()).then_some(points)
}

/// Gives each descent its answer.
pub(crate) fn tell_all(descents: &mut [Waiting], answers: &[Derivatives]) {
    let going = descents.iter_mut().filter(|d| d.status().is_none());
    for (descent, answer) in going.zip(answers) {
        descent.tell(answer);
    }
}

/// How the best descent ended; `None` while any goes on. A used-up number of steps is a limit of the method itself:
/// [`Status::Exhausted`], not [`Status::Budget`].
pub(crate) fn status_of(descents: &[Waiting]) -> Option<Status> {
    if descents.iter().any(|d| d.status().is_none()) {
        return None;
    }
    let best = descents.iter().min_by(|a, b| a.cost().total_cmp(&b.cost()));
    let status = best.and_then(Waiting::status);
    Some(match status.unwrap_or(Status::Stalled) {
        Status::Budget => Status::Exhausted,
        status => status,
    })
}
