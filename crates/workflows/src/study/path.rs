//! One axis along a path: one run of the grid, and what is kept of it.

use super::changing::Changing;
use super::compensation::{believing, feedforward};
use super::course;
use super::diverged::{Fault, stayed};
use super::done::Done;
use super::learnt::Learnt;
use super::machine::{largest_force, settings};
use super::metrics::of_path;
use super::trace::Trace;
use stiction_files::study::result::PathEntry;
use stiction_files::study::{Belief, Job, PathPlan, Scheme, Study};
use stiction_friction::ParamError;
use stiction_servo::axis::Axis;
use stiction_servo::integrator::Integrator;
use stiction_servo::law::OfAxis;
use stiction_servo::path::Reference;
use stiction_servo::run::{follow, follow_sampled, sample_count};
use stiction_servo::sampled::Sampled;
use stiction_servo::trajectory::Lookahead;

/// Most reference samples that are kept for all runs, of all paths together: a hundred megabytes.
pub(super) const MOST_SHARED_SAMPLES: usize = 4_000_000;

/// The reference of each path at the control rate, for all runs along it, where there are so many grids in all; `None` where
/// that would be too much to keep.
pub(super) fn sampled(study: &Study, grids: usize) -> Vec<Option<Sampled>> {
    let mut left = MOST_SHARED_SAMPLES / grids;
    let sampled = study.paths.iter().map(|path| {
        let count = sample_count(path.trajectory.duration(), study.machine.rate).ok()?;
        left = left.checked_sub(count)?;
        Sampled::new(path.trajectory.as_ref(), study.machine.rate).ok()
    });
    sampled.collect()
}

/// Along `sampled`, if it is there, which is the path's own reference; `integrator` moves the axis.
pub(super) fn on_path<L: OfAxis, I: Integrator<L>>(
    study: &Study,
    job: Job,
    sampled: Option<&Sampled>,
    before: &Learnt,
    integrator: &dyn Fn() -> Result<I, ParamError>,
    go_on: &dyn Fn() -> bool,
) -> Result<Option<Done>, Fault> {
    let path = &study.paths[job.path];
    let follow = |axis: &mut Axis<L, I>| match sampled {
        Some(sampled) => follow_sampled(axis, sampled),
        None => follow(axis, path.trajectory.as_ref()),
    };
    let family = &study.families[job.family];
    let belief = family.beliefs[job.belief];
    let controller = study.controllers[job.controller].value;
    let controller = believing(controller, &study.machine, belief);
    let scheme = &study.compensators[job.compensator].value;
    let drawn = family.axes.get(job.belief);
    let own = Belief {
        law: study.machine.law,
        mass: study.machine.mass,
    };
    let axis = drawn.map_or(own, |d| d.axis);
    let mut settings = settings::<L>(&study.machine, axis, controller, study.seed)?;
    let without = || {
        let mut axis = Axis::new(settings.clone(), integrator()?)?;
        Ok(vec![follow(&mut axis)?])
    };
    let watches = before.before(study, job, without)?;
    settings.feedforward = feedforward(scheme, &study.machine, &controller, belief, &watches[0])?;
    let changing = Changing::of(study, scheme, axis, belief, controller.mass_feedforward());
    let mut load = None;
    let mut follow = |axis: &mut Axis<L, I>| {
        let Some(changing) = &changing else {
            return follow(axis);
        };
        let preview = axis.settings().feedforward.preview;
        let (samples, course) = match sampled {
            Some(sampled) => changing.follow(axis, sampled.with_preview(preview)),
            None => changing.follow(axis, along(path, study.machine.rate, preview)?),
        }?;
        load = Some(course);
        Ok(samples)
    };
    let mut axis = Axis::new(settings.clone(), integrator()?)?;
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
                study.machine.rate,
            )?;
            settings.feedforward.learned = next;
            axis = Axis::new(settings.clone(), integrator()?)?;
            samples = follow(&mut axis)?;
        }
    }
    stayed(samples.iter().map(|s| [s]))?;
    let exact = family.kind == "exact" && study.keeps_courses;
    let from = samples.partition_point(|s| s.time < path.skip);
    let counted = &samples[from.min(samples.len())..];
    let compensator = axis.feedforward().compensator();
    Ok(Some(Done {
        job,
        metrics: of_path(
            counted,
            largest_force(&study.machine, &controller),
            load.as_ref(),
        ),
        switched_off: compensator.is_some_and(|c| c.state().watch.tripped()),
        trace: (exact || family.kind == "moved").then(|| Trace {
            load,
            ..Trace::of(study.names(job), counted)
        }),
        contour: None,
        course: match exact {
            true => course::rows(study.names(job), &samples, course::rows_of_a_run(study)),
            false => String::new(),
        },
    }))
}

/// The references of a path that is not sampled for all runs.
pub(super) fn along(
    path: &PathPlan,
    rate: f64,
    preview: f64,
) -> Result<impl ExactSizeIterator<Item = (Reference, f64)> + '_, ParamError> {
    let count = sample_count(path.trajectory.duration(), rate)?;
    let mut reference = Lookahead::new(path.trajectory.as_ref(), rate, preview);
    Ok((0..count).map(move |_| reference.sample()))
}

/// A path as it goes into `study.json`.
pub(super) fn entry(plan: &PathPlan) -> PathEntry {
    PathEntry {
        name: plan.name.clone(),
        kind: plan.kind.into(),
        duration_s: plan.trajectory.duration(),
        skip_s: plan.skip,
    }
}
