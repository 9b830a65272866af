//! The runs of a study: every path with every controller, every compensator and all that is believed of the axis.

use super::belief::{Belief, Family};
use super::plan::{Scheme, Study};
use serde::{Deserialize, Serialize};

/// A run of the grid, by the places in the lists of the study.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Job {
    /// Index of the path; contours are numbered after the paths.
    pub path: usize,
    /// Controller.
    pub controller: usize,
    /// Compensator.
    pub compensator: usize,
    /// Whether the contour error is controlled.
    pub coupled: bool,
    /// What is believed of the axis: the family.
    pub family: usize,
    /// And its member.
    pub belief: usize,
}

impl Job {
    /// The cell of the grid that the run belongs to.
    pub fn cell(self) -> Job {
        Job { belief: 0, ..self }
    }
}

impl Study {
    /// Every run of the grid, in the order of the result.
    pub fn jobs(&self) -> Vec<Job> {
        let mut jobs = Vec::new();
        for path in 0..self.paths.len() + self.contours.len() {
            for controller in 0..self.controllers.len() {
                for compensator in 0..self.compensators.len() {
                    for &coupled in self.couplings(path, compensator) {
                        for (family, beliefs) in self.families.iter().enumerate() {
                            if !self.matters(compensator, beliefs) {
                                continue;
                            }
                            jobs.extend((0..beliefs.beliefs.len()).map(|belief| Job {
                                path,
                                controller,
                                compensator,
                                coupled,
                                family,
                                belief,
                            }));
                        }
                    }
                }
            }
        }
        jobs
    }

    /// Whether a compensator is run along a path or contour.
    pub fn has_runs(&self, path: usize, compensator: usize) -> bool {
        !self.couplings(path, compensator).is_empty()
    }

    /// Without and with control of the contour, where there is one. Learning and the estimate of the load are of one axis.
    fn couplings(&self, path: usize, compensator: usize) -> &'static [bool] {
        let learns = match &self.compensators[compensator].value {
            Scheme::Learning(..) => true,
            Scheme::Model(model) => model.load_estimate,
            _ => false,
        };
        let coupling = self.second.as_ref().and_then(|s| s.coupling);
        match (path < self.paths.len(), coupling) {
            (true, _) => &[false],
            (false, _) if learns => &[],
            (false, None) => &[false],
            (false, Some(_)) => &[false, true],
        }
    }

    /// Whether wrong parameters change anything: those of the law where there is a model, the mass everywhere, as it is
    /// fed forward.
    fn matters(&self, compensator: usize, family: &Family) -> bool {
        let model = matches!(self.compensators[compensator].value, Scheme::Model(_));
        let mass = |b: &Belief| b.mass != self.machine.mass;
        let always = ["exact", "promised"].contains(&family.kind);
        always || model || family.beliefs.iter().any(mass)
    }

    /// The name of the path or contour of a run.
    pub fn path_name(&self, job: Job) -> &str {
        match self.paths.get(job.path) {
            Some(path) => &path.name,
            None => &self.contours[job.path - self.paths.len()].name,
        }
    }

    /// What tells a run apart: path, controller, compensator.
    pub fn names(&self, job: Job) -> [&str; 3] {
        [
            self.path_name(job),
            &self.controllers[job.controller].name,
            &self.compensators[job.compensator].name,
        ]
    }
}
