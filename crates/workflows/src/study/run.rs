//! The grid of a study, run in parallel, and what is kept of each run.

use super::diverged::{Fault, gains};
use super::done::Done;
use super::learnt::Learnt;
use super::metrics::{may_be_absent, metrics};
use super::outcome::StudyOutcome;
use super::rows::{promises, rows};
use super::{contour, course, doubt, kept, machine, not_promised, path, sweeps};
use rayon::prelude::*;
use stiction_files::study::result::{SCHEMA, StudyFile};
use stiction_files::study::{Job, Study};
use stiction_files::{Runs, Warning};
use stiction_friction::{ElastoPlastic, LuGre, MaxwellSlip, ParamError};
use stiction_say::{Notice, Value};
use stiction_search::{Observer, Shared};
use stiction_servo::integrator::{Integrator, Mid, Quick};
use stiction_servo::law::{AxisLaw, OfAxis};
use stiction_servo::levelled::{Depending, Levelled};
use stiction_servo::sampled::Sampled;
use stiction_servo::unmodelled::Beside;

/// Runs the whole grid on all threads. The observer is told the number of runs done and their total, also between the
/// passes of learning, and may stop the work: what is done then is kept. Results do not depend on the number of
/// threads.
pub fn simulate(study: &Study, observer: &mut dyn Observer) -> StudyOutcome {
    simulated(study, None, observer)
}

/// [`simulate`], where the runs are [kept](super::keep()) as they are done, and those that were kept before are taken: the same
/// bits.
pub fn simulate_keeping(study: &Study, runs: &Runs, observer: &mut dyn Observer) -> StudyOutcome {
    simulated(study, Some(runs), observer)
}

fn simulated(study: &Study, runs: Option<&Runs>, observer: &mut dyn Observer) -> StudyOutcome {
    let grids: Vec<Grid> = {
        let count = study.grids().count();
        study.grids().map(|grid| Grid::of(grid, count)).collect()
    };
    let jobs = grids.iter().enumerate();
    let jobs: Vec<(usize, Job)> = jobs
        .flat_map(|(i, grid)| grid.study.jobs().into_iter().map(move |job| (i, job)))
        .collect();
    let size = jobs.iter().map(|&(i, job)| grids[i].study.work(job)).sum();
    let watch = Shared::sized(observer, jobs.len(), size);
    let mut warnings = study.warnings.clone();
    let places = jobs.iter().enumerate();
    let mut taken: Vec<Option<Done>> = places
        .map(|(place, &(i, job))| {
            let done = kept::taken(grids[i].study, job, runs?.taken(place)?)?;
            watch.one_more_of(grids[i].study.work(job));
            Some(done)
        })
        .collect();
    if taken.iter().any(Option::is_some) {
        watch.go_on();
    }
    let done: Vec<Option<Result<Done, Fault>>> = jobs
        .par_iter()
        .zip(&mut taken)
        .enumerate()
        .map(|(place, (&(i, job), taken))| {
            if let Some(done) = taken.take() {
                return Some(Ok(done));
            }
            if watch.is_stopped() {
                return None;
            }
            let done = grids[i].run(job, &|| watch.go_on()).transpose()?;
            if let (Some(runs), Ok(done)) = (runs, &done) {
                kept::add(runs, place, done);
            }
            watch.one_more_of(grids[i].study.work(job));
            watch.go_on();
            Some(done)
        })
        .collect();
    let complete = done.iter().all(Option::is_some);
    let mut kept: Vec<Vec<Done>> = grids.iter().map(|_| Vec::new()).collect();
    let mut failed = Vec::new();
    for (&(i, job), result) in jobs.iter().zip(done) {
        match result {
            Some(Ok(done)) => kept[i].push(done),
            Some(Err(e)) => failed.push((i, job, e)),
            None => {}
        }
    }
    let (drawn, mut failed): (Vec<Failed>, Vec<Failed>) = failed
        .into_iter()
        .partition(|(i, job, _)| grids[*i].study.families[job.family].kind == "promised");
    warnings.extend(not_promised::warnings(study, &drawn, &failed));
    // The same fault in every member of a cell, and with every value of a sweep, is said once.
    failed.dedup_by_key(|(i, job, _)| (*i, job.cell()));
    let mut said: Vec<Job> = Vec::new();
    failed.retain(|(i, job, _)| {
        let new = *i == 0 || !said.contains(job);
        said.push(*job);
        new
    });
    let together = |a: &Failed, b: &Failed| {
        let of = |(i, job, e): &Failed| {
            let diverged = matches!(e, Fault::Diverged(_));
            diverged.then_some((*i, job.path, job.controller))
        };
        of(a).is_some() && of(a) == of(b)
    };
    for runs in failed.chunk_by(together) {
        warnings.push(not_run(study, &grids, runs));
    }
    let sweeps = sweeps::entries(study, &kept[1..]);
    let kept = kept.swap_remove(0);
    let results = rows(study, &kept);
    let promise = promises(study, &results);
    let lacking =
        (promise.is_empty() && !drawn.is_empty()).then(|| not_promised::reason(study, &drawn));
    warnings.extend(doubt::warnings(study, &results));
    let (mut traces, mut contours) = (Vec::new(), Vec::new());
    let mut courses = headers(study);
    for done in kept {
        courses[usize::from(done.job.path >= study.paths.len())].push_str(&done.course);
        traces.extend(done.trace);
        contours.extend(done.contour);
    }
    StudyOutcome {
        file: StudyFile {
            schema: SCHEMA.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            name: study.name.clone(),
            seed: study.seed,
            status: if complete { "complete" } else { "interrupted" }.into(),
            inputs: study.inputs.clone(),
            axis: machine::entry(&study.machine),
            second_axis: study.second.as_ref().map(|s| machine::entry(&s.machine)),
            paths: (study.paths.iter().map(path::entry))
                .chain(study.contours.iter().map(contour::entry))
                .collect(),
            events: study.events.iter().map(machine::event).collect(),
            exported_c: None,
            promise,
            not_promised: study.not_promised.clone().or(lacking),
            results,
            sweeps,
            warnings,
        },
        traces,
        contours,
        courses,
        exported_traces: Vec::new(),
    }
}

/// The runs of a study, or of one with a value of a sweep, and what they have in common.
pub(super) struct Grid<'a> {
    study: &'a Study,
    sampled: Vec<Option<Sampled>>,
    learnt: Learnt,
}

impl<'a> Grid<'a> {
    /// One of `count` grids.
    pub(super) fn of(study: &'a Study, count: usize) -> Self {
        Grid {
            study,
            sampled: path::sampled(study, count),
            learnt: Learnt::of(study),
        }
    }

    /// One run, whose metrics must be finite numbers; `None` where the work was stopped.
    pub(super) fn run(&self, job: Job, go_on: &dyn Fn() -> bool) -> Result<Option<Done>, Fault> {
        let study = self.study;
        let done = match study.contours.get(job.path.wrapping_sub(study.paths.len())) {
            Some(contour) => Some(contour::on_contour(study, job, contour, &self.learnt)?),
            None => {
                // Both step MID; that of LuGre is faster.
                match study.machine.law {
                    AxisLaw::LuGre(_) if study.machine.depends.is_none() => {
                        self.on_path::<LuGre<f64>, _>(job, &|| Quick::new(1), go_on)?
                    }
                    AxisLaw::LuGre(_) => self.stepped::<LuGre<f64>>(job, go_on)?,
                    AxisLaw::ElastoPlastic(_) => self.stepped::<ElastoPlastic<f64>>(job, go_on)?,
                    AxisLaw::MaxwellSlip(_) => self.stepped::<MaxwellSlip<f64>>(job, go_on)?,
                }
            }
        };
        for (&name, &value) in metrics(study, job)
            .iter()
            .zip(done.iter().flat_map(|d| &d.metrics))
        {
            let absent = may_be_absent(name) && value.is_nan();
            if !(value.is_finite() || absent) {
                let allowed =
                    "a finite number: a smaller motion, slower, with smaller gains and forces";
                return Err(ParamError::new(name, value, allowed).into());
            }
        }
        Ok(done)
    }

    /// One run along a path with the plain step, the level of friction where it depends on more than the velocity.
    fn stepped<L: OfAxis>(
        &self,
        job: Job,
        go_on: &dyn Fn() -> bool,
    ) -> Result<Option<Done>, Fault> {
        match &self.study.machine.depends {
            None => self.on_path::<L, _>(job, &|| Mid::new(1), go_on),
            Some(depends) => {
                let axis = || Ok(Depending::new(Mid::new(1)?, depends.clone()));
                self.on_path::<Levelled<L>, _>(job, &axis, go_on)
            }
        }
    }

    /// One run along a path, of the axis of the study or of one that is drawn.
    fn on_path<L: OfAxis, I: Integrator<L>>(
        &self,
        job: Job,
        integrator: &dyn Fn() -> Result<I, ParamError>,
        go_on: &dyn Fn() -> bool,
    ) -> Result<Option<Done>, Fault> {
        let study = self.study;
        let sampled = self.sampled[job.path].as_ref();
        match study.families[job.family].axes.get(job.belief) {
            None => path::on_path(study, job, sampled, &self.learnt, integrator, go_on),
            Some(drawn) => {
                let axis = || Ok(Beside::new(integrator()?, drawn.beside.clone()));
                path::on_path(study, job, sampled, &self.learnt, &axis, go_on)
            }
        }
    }
}

/// Headers of the courses on paths and on contours, where there are any.
fn headers(study: &Study) -> [String; 2] {
    let motion = study.machine.motion;
    [
        match study.paths.is_empty() {
            true => String::new(),
            false => course::header(motion),
        },
        match study.contours.is_empty() {
            true => String::new(),
            false => course::contour_header(motion),
        },
    ]
}

/// A run that gave nothing: its grid, its place in that, and why.
pub(super) type Failed = (usize, Job, Fault);

/// What is said of a run of a grid of the study that could not be made, or of those along a path under one controller that
/// diverged.
fn not_run(study: &Study, grids: &[Grid], runs: &[Failed]) -> Warning {
    let (i, job, fault) = runs[0];
    let grid = grids[i].study;
    let [path, controller, compensator] = study.names(job);
    let points = study.sweeps.iter().flat_map(|sweep| {
        let points = sweep.points.iter();
        points.map(move |point| (sweep, point))
    });
    let point = points
        .into_iter()
        .find(|(_, p)| std::ptr::eq(&p.study, grid));
    let point = point.map(|(sweep, point)| {
        let value = Value::new(point.value, &sweep.unit);
        (sweep.key.to_string(), value)
    });
    let mut schemes = match fault {
        Fault::Refused(_) => vec![compensator.to_string()],
        Fault::Diverged(_) => {
            let schemes = runs.iter().map(|(_, job, _)| study.names(*job)[2]);
            schemes.map(String::from).collect()
        }
    };
    schemes.dedup();
    let notice = Notice::NotRun {
        path: path.to_string(),
        controller: controller.to_string(),
        schemes,
        point,
        why: fault.no_run(),
        gains: Some(gains(&grid.controllers[job.controller].value)),
    };
    notice.into()
}
