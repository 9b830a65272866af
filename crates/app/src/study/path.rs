//! One axis along a path: one run of the grid, and what is kept of it.

use super::compensation::believing;
use super::result::PathEntry;
use super::run::{Done, Job};
use super::trace::Trace;
use super::{PathPlan, Scheme, Study, course};
use stiction_friction::ParamError;
use stiction_servo::axis::Axis;
use stiction_servo::integrator::Quick;
use stiction_servo::metrics::{Tracking, ripple_at_constant_velocity, share_at_limit};
use stiction_servo::run::{follow, follow_sampled, sample_count};
use stiction_servo::sampled::Sampled;

/// Samples of references that are kept for all runs, of all paths together: a hundred megabytes.
const MOST_SHARED: usize = 4_000_000;

/// Names of the metrics; what they measure is in `docs/study.md`.
pub(super) const METRICS: [&str; 7] = [
    "rms_error",
    "peak_error",
    "reversal_peak",
    "command_change",
    "stick_time",
    "saturation",
    "velocity_ripple",
];

impl Study {
    /// The reference of each path at the control rate, for all runs along it; `None` where that would be too much to keep.
    pub(super) fn sampled(&self) -> Vec<Option<Sampled>> {
        let mut left = MOST_SHARED;
        let sampled = self.paths.iter().map(|path| {
            let count = sample_count(path.trajectory.duration(), self.machine.rate).ok()?;
            left = left.checked_sub(count)?;
            Sampled::new(path.trajectory.as_ref(), self.machine.rate).ok()
        });
        sampled.collect()
    }

    /// Along `sampled`, if it is there, which is the path's own reference.
    pub(super) fn on_path(
        &self,
        job: Job,
        sampled: Option<&Sampled>,
        go_on: &dyn Fn() -> bool,
    ) -> Result<Option<Done>, ParamError> {
        let path = &self.paths[job.path];
        let follow = |axis: &mut Axis<_, _>| match sampled {
            Some(sampled) => follow_sampled(axis, sampled),
            None => follow(axis, path.trajectory.as_ref()),
        };
        let family = &self.families[job.family];
        let belief = family.beliefs[job.belief];
        let controller = self.controllers[job.controller].it;
        let controller = believing(controller, &self.machine, belief);
        let scheme = &self.compensators[job.compensator].it;
        let mut settings = self.machine.settings(controller, self.seed);
        settings.feedforward = scheme.feedforward(&self.machine, &controller, belief)?;
        let mut axis = Axis::new(settings.clone(), Quick::new(1)?)?;
        let mut samples = follow(&mut axis)?;
        if let Scheme::Learning(learning, passes) = scheme {
            for _ in 1..*passes {
                if !go_on() {
                    return Ok(None);
                }
                let force = &settings.feedforward.learned;
                let next = learning.learn(
                    force,
                    &samples,
                    controller.mass_feedforward(),
                    self.machine.rate,
                )?;
                settings.feedforward.learned = next;
                axis = Axis::new(settings.clone(), Quick::new(1)?)?;
                samples = follow(&mut axis)?;
            }
        }
        let exact = family.kind == "exact";
        let learnt = scheme.learnt(&samples, self.machine.rate);
        let from = samples.partition_point(|s| s.time < path.skip);
        let counted = &samples[from.min(samples.len())..];
        let tracking = Tracking::of(counted);
        let compensator = axis.feedforward().compensator();
        Ok(Some(Done {
            job,
            metrics: vec![
                tracking.rms,
                tracking.peak,
                tracking.reversal_peak,
                tracking.command_change,
                tracking.stick_time,
                share_at_limit(counted, self.machine.largest_force(&controller)),
                ripple_at_constant_velocity(counted).unwrap_or(f64::NAN),
            ],
            switched_off: compensator.is_some_and(|c| c.state().watch.tripped),
            still_learning: learnt.is_some_and(|t| t > path.skip),
            trace: exact.then(|| Trace::of(self.names(job), counted)),
            contour: None,
            course: match exact {
                true => course::rows(self.names(job), &samples, self.rows_of_a_run()),
                false => String::new(),
            },
        }))
    }
}

impl PathPlan {
    pub(super) fn entry(&self) -> PathEntry {
        PathEntry {
            name: self.name.clone(),
            kind: self.kind.into(),
            duration_s: self.trajectory.duration(),
            skip_s: self.skip,
        }
    }
}
